"""One synthetic movie: the pictures, their times, and the numbers that made them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..types import Frame

Images = NDArray[np.uint8] | NDArray[np.float32]
"""(T, H, W) luminance 0..255."""

_MIRROR_KIND = {"translating_right": "translating_left", "translating_left": "translating_right"}
_MIRROR_DIRECTION = {"right": "left", "left": "right"}
_MIRROR_SIGN = ("angle_deg", "offset_cm")


@dataclass(frozen=True, eq=False)
class Movie:
    """A movie with a known answer.

    Attributes
    ----------
    images : (T, H, W) uint8 luminance 0..255 as an 8 bit camera gives it, or float32 where ``quantised`` was false
    times_s : (T,) stamp of each picture, s, the first at 0
    contact_s : when the object touches the lens, s; may lie after the last picture; None where nothing is coming
    kind : looming, receding, translating_right, translating_left, angular, grating, flicker, flash, still or noise
    rate_hz : pictures per second
    settings : every number that made it, by name
    """

    images: Images
    times_s: NDArray[np.float64]
    contact_s: float | None
    kind: str
    rate_hz: float
    settings: Mapping[str, Any]

    def __len__(self) -> int:
        return len(self.images)

    def frames(self) -> Iterator[Frame]:
        """Yield the pictures one by one, as a camera would."""
        for index, (image, time_s) in enumerate(zip(self.images, self.times_s, strict=True)):
            yield Frame(image, float(time_s), index)


def mirrored(movie: Movie) -> Movie:
    """Return the movie seen in a mirror: left and right swapped, in the pictures, the kind and the settings."""
    backwards: Any = movie.images[:, :, ::-1]
    settings = dict(movie.settings)
    if "direction" in settings:
        settings["direction"] = _MIRROR_DIRECTION.get(settings["direction"], settings["direction"])
    for name in _MIRROR_SIGN:
        if name in settings:
            settings[name] = -settings[name]
    settings["mirrored"] = not settings.get("mirrored", False)
    return replace(
        movie, images=np.ascontiguousarray(backwards), settings=settings, kind=_MIRROR_KIND.get(movie.kind, movie.kind)
    )


def as_images(luminance: NDArray[Any], like: np.dtype[Any]) -> NDArray[Any]:
    """Return luminance clipped to 0..255 and, for uint8, rounded to the nearest grey level."""
    clipped: NDArray[Any] = np.clip(luminance, 0.0, 255.0)
    return (np.rint(clipped) if like == np.uint8 else clipped).astype(like)
