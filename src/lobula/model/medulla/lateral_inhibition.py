"""Lateral inhibition and the competition with excitation: Eqs. (1) and (2) of the paper."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...params import Params, param
from ...types import Image
from ..borders import replicate
from ..filters import low_pass_share


@dataclass(frozen=True, kw_only=True)
class InhibitionParams(Params):
    """Kernel W of Eq. (1) as three rings, each with a weight and a delay, and the bias w of Eq. (2)."""

    centre_weight: float = param(1.0, "", "W at the cell itself", low=0, high=8, source="published code: NewLGMDs")
    nearest_weight: float = param(
        0.25, "", "W at each of the 4 nearest cells", low=0, high=4, source="published code: NewLGMDs"
    )
    diagonal_weight: float = param(
        0.125, "", "W at each of the 4 diagonal cells", low=0, high=4, source="published code: NewLGMDs"
    )
    centre_ms: float = param(60.0, "ms", "delay of the centre", low=1, high=1000, source="published code: NewLGMDs")
    nearest_ms: float = param(
        120.0, "ms", "delay of the nearest cells", low=1, high=1000, source="published code: NewLGMDs"
    )
    diagonal_ms: float = param(
        180.0, "ms", "delay of the diagonal cells", low=1, high=1000, source="published code: NewLGMDs"
    )
    bias: float = param(0.5, "", "w at rest", low=0, high=8, source="published code: NewLGMDs")


def ring_sum(channel: Image, weights: tuple[float, float, float], spacing_px: int) -> Image:
    """Return the weighted 3 x 3 neighbourhood of ``channel`` (H, W): centre, nearest, diagonal; replicate border."""
    centre, nearest, diagonal = (np.float32(w) for w in weights)
    height, width = channel.shape
    s = spacing_px
    padded = replicate(channel, s)
    up, mid, down = (padded[i * s : i * s + height] for i in range(3))
    left, middle, right = (slice(i * s, i * s + width) for i in range(3))
    beside = mid[:, left] + mid[:, right] + up[:, middle] + down[:, middle]
    corner = up[:, left] + up[:, right] + down[:, left] + down[:, right]
    total: Image = centre * mid[:, middle] + nearest * beside + diagonal * corner
    return total


def lateral_inhibition(
    excitation: Image, previous: Image, p: InhibitionParams, spacing_px: int, dt_ms: float
) -> Image:  # fmt: skip
    """Return I of Eq. (1): each ring spreads the excitation E sideways, low-passed by its own delay.

        I = sum over rings k of W_k (a_k E(t) + (1 - a_k) E(t-1)),   a_k = dt / (dt + tau_k)

    Parameters
    ----------
    excitation, previous : (H, W) one channel now and one step ago, luminance units, >= 0
    spacing_px : distance of the neighbours

    Source: paper Eq. (1); rings and delays from published code (docs/sources.md).
    """
    weights = (p.centre_weight, p.nearest_weight, p.diagonal_weight)
    shares = tuple(low_pass_share(dt_ms, tau) for tau in (p.centre_ms, p.nearest_ms, p.diagonal_ms))
    now = (weights[0] * shares[0], weights[1] * shares[1], weights[2] * shares[2])
    then = (weights[0] - now[0], weights[1] - now[1], weights[2] - now[2])
    return ring_sum(excitation, now, spacing_px) + ring_sum(previous, then, spacing_px)


def compete(excitation: Image, inhibition: Image, bias: float) -> Image:
    """Return S of Eq. (2), rectified: [E - w I]+, (H, W).

    Source: paper Eq. (2); rectification from published code.
    """
    summation: Image = np.maximum(excitation - np.float32(bias) * inhibition, np.float32(0))
    return summation
