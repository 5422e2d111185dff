"""Retina: photoreceptors report the change of luminance between two successive pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..params import Params, param
from ..types import Image


@dataclass(frozen=True, kw_only=True)
class FlashParams(Params):
    """When a change of the whole picture is taken for a change of light, and taken out."""

    enabled: bool = param(True, "", "recognise global changes of light", source="chosen")
    min_change_grey: float = param(
        1.0, "grey", "smallest mean change of the picture", low=0.1, high=255, source="chosen"
    )
    min_coverage: float = param(
        0.8, "", "share of the pixels that brighten, or darken, together", low=0.5, high=1, source="chosen"
    )
    trim: float = param(
        3.0, "", "pixels that change more than this many mean changes are left out of the fit", low=1, high=100,
        source="chosen",
    )  # fmt: skip
    min_explained: float = param(
        0.7, "", "share of the new picture's variance that the old one explains, noise aside", low=0, high=1,
        source="chosen",
    )  # fmt: skip
    min_gain: float = param(0.2, "", "smallest gain a lamp or exposure step has", low=0.01, high=1, source="chosen")
    max_gain: float = param(5.0, "", "largest gain", low=1, high=100, source="chosen")


@dataclass(frozen=True, kw_only=True)
class SaturationParams(Params):
    """Strong changes count no more than middling ones, so that a near body and a near wall weigh alike."""

    enabled: bool = param(False, "", "limit the change that goes on to the lamina and the LGMDs", source="chosen")
    limit_grey: float = param(50.0, "grey", "largest change that goes on", low=1, high=255, source="chosen")


NOISE_GREY2 = 4.5
"""Variance that sensor noise of 1.5 grey in each of two pictures leaves between them, whatever the light."""


class ChangeStatistics(NamedTuple):
    """What one look at the change of the whole picture tells, luminance units."""

    mean: float
    mean_abs: float
    max_abs: float
    brighter: float
    """Share of the pixels that brighten by more than half a grey level."""
    darker: float


class Light(NamedTuple):
    """The previous picture in today's light is ``gain * previous + offset``."""

    gain: float = 1.0
    offset: float = 0.0


SAME_LIGHT = Light()


def change_statistics(image: NDArray[Any], previous: Image) -> ChangeStatistics:
    """Summarise ``image - previous``, both (H, W), before any filtering."""
    change = image.astype(np.float32, copy=False) - previous
    size = change.size
    return ChangeStatistics(
        mean=float(change.sum(dtype=np.float64)) / size,
        mean_abs=float(np.abs(change).sum(dtype=np.float64)) / size,
        max_abs=float(np.abs(change).max()),
        brighter=int(np.count_nonzero(change > 0.5)) / size,
        darker=int(np.count_nonzero(change < -0.5)) / size,
    )


def find_flash(image: NDArray[Any], previous: Image, about: ChangeStatistics, p: FlashParams) -> Light | None:
    """Return the change of light that explains the change of the picture, or None.

    A lamp, a shutter or an exposure step multiplies and shifts every pixel alike: image = gain * previous + offset.
    A near object that spreads over the view does not, since what it covers no longer depends on what was there: the
    old picture does not explain the new one, and the alarm stands. One picture is fitted by least squares, and only
    when most of it changed in one direction. The fit must explain the new picture's variance and not merely the
    change, most of which is a shift of the mean in either case.

    Source: chosen; gain and offset are the two parameters of exposure control.
    """
    together = max(about.brighter, about.darker) >= p.min_coverage
    if not (p.enabled and together and abs(about.mean) >= p.min_change_grey):
        return None
    new, old = image.astype(np.float64), previous.astype(np.float64)
    # What moves in front of the lit scene changes most; leave it out of the fit.
    lit = np.abs(new - old) <= p.trim * about.mean_abs
    if not lit.any():  # a trim of 1 and an even change: rounding leaves nothing
        return None
    new, old = new[lit], old[lit]
    new_mean, old_mean = new.mean(), old.mean()
    variance = float((old * old).mean() - old_mean * old_mean)
    covariance = float((new * old).mean() - new_mean * old_mean)
    # A blank picture has no texture to tell gain from offset: call it an offset.
    gain = covariance / variance if variance > NOISE_GREY2 else 1.0
    offset = float(new_mean - gain * old_mean)
    new_variance = float((new * new).mean() - new_mean * new_mean)
    rest = float(((new - gain * old - offset) ** 2).mean())
    if not p.min_gain <= gain <= p.max_gain or rest > (1.0 - p.min_explained) * new_variance + NOISE_GREY2:
        return None
    return Light(gain, offset)


def frame_difference(image: NDArray[Any], previous: Image, scale: float, light: Light = SAME_LIGHT) -> Image:
    """Return the signed luminance change P, (H, W) float32.

        P = scale * (L(t) - (gain * L(t-1) + offset))

    ``scale`` is below 1 for steps longer than the clock, which gather more change.

    Source: paper, Computational Retina Layer; no persistence, as in the published code.
    """
    now = image.astype(np.float32, copy=False)
    if light is SAME_LIGHT:
        return (now - previous) * np.float32(scale)
    return (now - (np.float32(light.gain) * previous + np.float32(light.offset))) * np.float32(scale)


def saturate(change: Image, p: SaturationParams) -> Image:
    """Return ``change`` (H, W) kept within +- ``limit_grey``.

    Source: photoreceptors and lamina cells compress contrast; the hard limit is the plainest form of it.
    """
    if not p.enabled:
        return change
    limit = np.float32(p.limit_grey)
    return np.clip(change, -limit, limit)
