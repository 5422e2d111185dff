"""Coarse ON and OFF cells: does a whole patch of the picture brighten or darken?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...params import Params, param
from ...types import Image


@dataclass(frozen=True, kw_only=True)
class CoarseParams(Params):
    """Square patches side by side; each hears the mean change of its pixels."""

    patch_px: int = param(9, "px", "side of a patch", low=2, high=256, source="chosen")
    floor_grey: float = param(1.0, "grey", "mean change that a patch takes for noise", low=0, high=255, source="chosen")


class Coarse(NamedTuple):
    """What all patches together say: brightening and darkening, luminance units times pixels."""

    on: float
    off: float


def coarse(change: Image, p: CoarseParams) -> Coarse:
    """Return the brightening and the darkening of the patches of ``change`` (H, W).

        m = mean of a patch,   on = sum of [m - floor]+,   off = sum of [-m - floor]+,   each times the patch's pixels

    Fine texture that moves cancels within a patch; a body that is darker or brighter than what is behind it does not.
    Patches start at the upper left corner; columns and rows left over at the right and below are not heard.
    """
    side = p.patch_px
    rows, columns = change.shape[0] // side, change.shape[1] // side
    patches = change[: rows * side, : columns * side].reshape(rows, side, columns, side)
    mean = patches.sum(axis=(1, 3), dtype=np.float64) / side**2
    on, off = (float(np.maximum(sign * mean - p.floor_grey, 0.0).sum()) * side**2 for sign in (1, -1))
    return Coarse(on, off)
