"""ON and OFF channels: brightening and darkening part ways here."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...params import Params, param
from ...types import Image


@dataclass(frozen=True, kw_only=True)
class OnOffParams(Params):
    """Half-wave rectification with a trace of the previous frame."""

    residual: float = param(
        0.1, "", "share of the channel's previous value kept per clock tick", low=0, high=0.9,
        source="published code: LGMD2-open-source",
    )  # fmt: skip


def split_on_off(signal: Image, on: Image, off: Image, residual: float) -> tuple[Image, Image]:
    """Return the two channels, both >= 0, from a signed map and their previous values, all (H, W).

        ON = [x]+ + residual * ON(t-1),   OFF = [-x]+ + residual * OFF(t-1)

    Source: paper Sec. II-B; residual from published code (docs/sources.md).
    """
    r, zero = np.float32(residual), np.float32(0)
    return np.maximum(signal, zero) + r * on, np.maximum(-signal, zero) + r * off
