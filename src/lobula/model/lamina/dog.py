"""Difference of Gaussians: edges out of the change, polarity kept."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...params import Params, param
from ...types import Image
from ..borders import replicate


@dataclass(frozen=True, kw_only=True)
class DogParams(Params):
    """The inner field excites, the outer one, twice its size, inhibits."""

    enabled: bool = param(True, "", "off: the change goes on unfiltered (ablation)", source="paper Sec. II-B")
    radius_px: int = param(
        2, "px", "half width of the inner kernel, 5 x 5", low=1, high=32, source="published code: LGMDs.cs"
    )
    sigma_px: float = param(2.0, "px", "sigma of the inner field", low=0.3, high=32, source="published code: LGMDs.cs")
    surround: int = param(2, "", "size of the outer field, in inner ones", low=2, high=4, source="paper Sec. II-B")
    dead_zone_grey: float = param(
        1e-4, "grey", "inner responses below this are zero", low=0, high=1, source="chosen: rounding noise has no sign"
    )


def gaussian_kernel(radius_px: int, sigma_px: float) -> NDArray[np.float32]:
    """Return the 2 * radius + 1 weights of a truncated Gaussian, normalised to sum 1."""
    weights = [math.exp(-0.5 * (i / sigma_px) ** 2) for i in range(-radius_px, radius_px + 1)]
    total = math.fsum(weights)
    return np.array([w / total for w in weights], dtype=np.float32)


def gaussian_blur(image: Image, radius_px: int, sigma_px: float) -> Image:
    """Blur (H, W) by a square truncated Gaussian, as a direct sum (never an FFT), replicate border.

    Direct sums leave exact zeros where nothing changed; the sign rule below needs them.
    """
    kernel = gaussian_kernel(radius_px, sigma_px)
    height, width = image.shape
    padded = replicate(image, radius_px)
    rows = sum(k * padded[:, i : i + width] for i, k in enumerate(kernel))
    blurred: Image = sum(k * rows[i : i + height] for i, k in enumerate(kernel))
    return blurred


def difference_of_gaussians(change: Image, p: DogParams) -> Image:
    """Return LA: with e and i the inner and outer blur of ``change`` (H, W),

        LA = +|e - i|  where e >= 0 and i >= 0,   -|e - i|  where e < 0 and i < 0,   0  where the signs differ

    and 0 where |e| < ``dead_zone_grey``.

    Source: paper Sec. II-B; rule and sizes from published code (docs/sources.md).
    """
    if not p.enabled:
        return change
    e = gaussian_blur(change, p.radius_px, p.sigma_px)
    i = gaussian_blur(change, p.radius_px * p.surround, p.sigma_px * p.surround)
    silent = ((e >= 0) != (i >= 0)) | (np.abs(e) < np.float32(p.dead_zone_grey))
    return np.where(silent, np.float32(0), np.copysign(np.abs(e - i), e))
