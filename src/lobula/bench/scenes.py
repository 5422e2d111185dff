"""What is measured on: a robot's view of approach, passing and its own drift, and pure noise; never quite the same."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..stimuli import grating, looming, noise, translating

RATE_HZ = 30.0
TRAVEL_CM = 8.0

Images = NDArray[np.uint8]
"""(T, H, W)."""


def scenes(width: int, height: int, frames: int) -> dict[str, Images]:
    """Return movies of ``frames`` pictures each, an even number: a striped wall, a floor, camera noise of 1.5 grey.

    Every picture changes all over, so that no engine gains by skipping what stands still. The second half runs the
    first one backwards: shown again and again, a movie has no jump.
    """
    there = frames // 2 + 1
    seconds = (there - 1) / RATE_HZ
    size: Any = {"width": width, "height": height, "scene": "arena", "rate_hz": RATE_HZ}
    moving = size | {"lead_s": 0.0, "hold_s": 0.0, "object_contrast_grey": 30.0}
    movies = {
        "approach": looming(start_cm=TRAVEL_CM + 4.0, stop_cm=4.0, speed_cm_s=TRAVEL_CM / seconds, seed=1, **moving),
        "passing": translating(span_cm=TRAVEL_CM / 2, speed_cm_s=TRAVEL_CM / seconds, seed=2, **moving),
        "drift": grating(lead_s=0.0, duration_s=seconds, temporal_hz=2.0, seed=3, **size),
    }
    return {name: to_and_fro(np.asarray(movie.images[:there], np.uint8)) for name, movie in movies.items()}


def to_and_fro(images: Images) -> Images:
    """Return the movie and then its way back, without showing either end twice."""
    return np.concatenate([images, images[-2:0:-1]])


def pure_noise(width: int, height: int, frames: int) -> Images:
    """Return pictures of nothing but strong camera noise: what keeps the core busiest."""
    movie = noise(width=width, height=height, sigma=16.0, duration_s=(frames - 1) / RATE_HZ, rate_hz=RATE_HZ)
    return np.asarray(movie.images, np.uint8)


class Loop:
    """A movie shown again and again under a clock that runs on."""

    def __init__(self, images: Images) -> None:
        self.images = images
        self.taken = 0

    def __len__(self) -> int:
        return len(self.images)

    def take(self, count: int) -> Iterator[tuple[Images, float]]:
        """Yield the next ``count`` pictures, (H, W), and their stamps in seconds."""
        for _ in range(count):
            yield self.images[self.taken % len(self.images)], self.taken / RATE_HZ
            self.taken += 1

    def times_s(self) -> list[float]:
        """Return the stamps of the next time through, seconds."""
        first = self.taken
        self.taken += len(self)
        return [i / RATE_HZ for i in range(first, self.taken)]
