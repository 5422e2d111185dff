"""Grouping: expanding edges stand together and survive, isolated pixels fade."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...params import Params, param
from ...types import Image
from .lateral_inhibition import ring_sum


@dataclass(frozen=True, kw_only=True)
class GroupingParams(Params):
    """Each cell is weighed by its 3 x 3 neighbourhood, relative to the strongest one."""

    enabled: bool = param(
        True, "", "off: every cell counts as it is (ablation)", source="published code: LGMD2-open-source"
    )
    threshold_grey: float = param(
        30.0,
        "grey",
        "grouped cells under this are dropped",
        low=0,
        high=255,
        source="published code: LGMD2-open-source",
    )
    floor_grey: float = param(
        0.01, "grey", "keeps the normaliser off zero", low=1e-6, high=10, source="published code: LGMD2-open-source"
    )
    divisor: float = param(
        4.0, "", "share of the strongest neighbourhood in the normaliser", low=0.1, high=100,
        source="published code: LGMD2-open-source",
    )  # fmt: skip


class Grouped(NamedTuple):
    """The grouped map (H, W), and its sum in float64."""

    image: Image
    total: float


def group(summation: Image, p: GroupingParams, spacing_px: int) -> Grouped:
    """Return G and its sum k from the summation cells S (H, W), luminance units, >= 0.

        Ce = 3 x 3 mean of S,   omega = floor + max(Ce) / divisor,   G = S Ce / omega, zero where G < threshold

    Source: published code (docs/sources.md); not printed in the paper.
    """
    if not p.enabled:
        return Grouped(summation, float(summation.sum(dtype=np.float64)))
    ninth = 1.0 / 9.0
    mean = ring_sum(summation, (ninth, ninth, ninth), spacing_px)
    omega = p.floor_grey + float(mean.max()) / p.divisor
    grouped = summation * mean
    kept: Image = np.where(grouped >= np.float32(p.threshold_grey * omega), grouped, np.float32(0))
    return Grouped(kept / np.float32(omega), float(kept.sum(dtype=np.float64)) / omega)
