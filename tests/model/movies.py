"""Short movies for the whole network, and how they are run."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from lobula.model.network import NetworkParams, ReferenceNetwork
from lobula.stimuli import Movie, looming
from lobula.types import Reading

RATE_HZ = 30.0


def approach(**settings: object) -> Movie:
    """A dark box that comes from 18 cm at 16 cm/s until it fills the view, after a quarter of a second of rest."""
    own: dict[str, object] = {
        "speed_cm_s": 16.0, "start_cm": 18.0, "stop_cm": 1.0, "lead_s": 0.25, "hold_s": 0.0, "width": 64, "height": 48,
    }  # fmt: skip
    return looming(**(own | settings))


def growing(count: int, per_frame_px: float, drift_px: float = 0.0) -> np.ndarray:
    """A dark square that grows, and may drift to the right, before a wall of random greys: (count, 24, 32) uint8."""
    rng = np.random.default_rng(7)
    wall = rng.integers(150, 200, (24, 32))
    rows, columns = np.mgrid[:24, :32] + 0.5
    movie = np.empty((count, 24, 32), np.uint8)
    for k in range(count):
        half, middle = 2 + per_frame_px * k, 16 + drift_px * (k - count / 2)
        inside = (np.abs(rows - 12) < half) & (np.abs(columns - middle) < half)
        movie[k] = np.where(inside, 40 + rng.integers(0, 5, inside.shape), wall)
    return movie


def noisy(count: int, shape: tuple[int, int] = (24, 32), seed: int = 0, low: int = 100, high: int = 150) -> np.ndarray:
    """Pictures that have nothing to do with each other: (count, H, W) uint8."""
    return np.random.default_rng(seed).integers(low, high, (count, *shape), np.uint8)


def stamps(count: int, rate_hz: float = RATE_HZ) -> list[float]:
    """Times of ``count`` pictures, s, from 0."""
    return [k / rate_hz for k in range(count)]


def run(
    p: NetworkParams | ReferenceNetwork,
    images: np.ndarray,
    times_s: Iterable[float],
    turning: Sequence[bool] | None = None,
) -> list[Reading]:
    """Readings of every picture; by a fresh network where settings are given."""
    net = p if isinstance(p, ReferenceNetwork) else ReferenceNetwork(p, images.shape[1:])
    turns = turning or [False] * len(images)
    return [net.step(image, float(t), turning=turn) for image, t, turn in zip(images, times_s, turns, strict=True)]


def collisions(readings: Iterable[Reading]) -> list[int]:
    """Numbers of the pictures with a collision."""
    return [k for k, reading in enumerate(readings) if reading.collision]


def states(readings: Iterable[Reading]) -> list[str]:
    """The state of every picture."""
    return [reading.state for reading in readings]
