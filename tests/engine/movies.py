"""Movies for the parity of the engines: what cameras see, and what only a test would think of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lobula import stimuli

Movie = NDArray[Any]


def _grid(shape: tuple[int, int]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    y, x = np.mgrid[: shape[0], : shape[1]]
    return y.astype(float), x.astype(float)


def noise(shape: tuple[int, int], frames: int) -> Movie:
    """Every pixel any grey, every frame anew."""
    return np.random.default_rng(1).integers(0, 256, (frames, *shape)).astype(np.uint8)


def faint_noise(shape: tuple[int, int], frames: int) -> Movie:
    """A camera's noise on grey, as floats."""
    return (128 + np.random.default_rng(2).normal(0, 3, (frames, *shape))).astype(np.float32)


def growing(shape: tuple[int, int], frames: int) -> Movie:
    """A dark box grows on a textured wall."""
    y, x = _grid(shape)
    wall = 150 + 30 * np.sin(x / 3.1) * np.cos(y / 4.3)
    half = [3 + 0.02 * t**2.2 for t in range(frames)]
    inside = [(abs(x - shape[1] / 2.2) < h) & (abs(y - shape[0] / 1.9) < h) for h in half]
    return np.array([np.where(box, 30.0, wall) for box in inside]).astype(np.uint8)


def shrinking(shape: tuple[int, int], frames: int) -> Movie:
    """The same backwards."""
    return growing(shape, frames)[::-1]


def sliding(shape: tuple[int, int], frames: int) -> Movie:
    """A textured wall slides right by 1.7 px a frame, as floats."""
    y, x = _grid(shape)
    frames_x = [x - 1.7 * t for t in range(frames)]
    return np.array([128 + 50 * np.sin(fx / 3.7) + 20 * np.sin(y / 3 + fx / 9) for fx in frames_x]).astype(np.float32)


def constant(shape: tuple[int, int], frames: int) -> Movie:
    """Nothing ever happens."""
    return np.full((frames, *shape), 77, np.uint8)


def one_pixel(shape: tuple[int, int], frames: int) -> Movie:
    """One white pixel jumps along the border and through the corners of a black picture."""
    movie = np.zeros((frames, *shape), np.uint8)
    spots = [(0, 0), (0, -1), (-1, 0), (-1, -1), (shape[0] // 2, 0), (0, shape[1] // 2), (5, 7)]
    for t in range(frames):
        movie[(t, *spots[t % len(spots)])] = 255
    return movie


def black_and_white(shape: tuple[int, int], frames: int) -> Movie:
    """Checks of 0 and 255 that swap in every frame."""
    y, x = _grid(shape)
    return np.array([255 * ((x // 5 + y // 3 + t) % 2) for t in range(frames)]).astype(np.uint8)


def lamps(shape: tuple[int, int], frames: int) -> Movie:
    """A noisy scene under a lamp that is switched every sixth frame."""
    y, x = _grid(shape)
    rng = np.random.default_rng(3)
    scene = 100 + 40 * np.sin(x / 5) * np.cos(y / 7)
    light = [1.0 + 0.5 * (t // 6 % 2) for t in range(frames)]
    return np.clip([scene * g + rng.normal(0, 1.5, shape) for g in light], 0, 255).astype(np.uint8)


def each_thrice(shape: tuple[int, int], frames: int) -> Movie:
    """A 10 Hz camera in a 30 Hz file."""
    return np.repeat(growing(shape, frames)[::3], 3, axis=0)[:frames]


MOVIES: dict[str, Callable[[tuple[int, int], int], Movie]] = {
    f.__name__: f
    for f in (noise, faint_noise, growing, shrinking, sliding, constant, one_pixel, black_and_white, lamps, each_thrice)
}


def stimulus(kind: str, rate_hz: float) -> stimuli.Movie:
    """One movie of the synthetic battery's kind, short."""
    make = {
        "looming": lambda: stimuli.looming(speed_cm_s=12, start_cm=14, lead_s=0.3, hold_s=0.1, rate_hz=rate_hz),
        "receding": lambda: stimuli.receding(speed_cm_s=12, stop_cm=14, lead_s=0.3, hold_s=0.1, rate_hz=rate_hz),
        "translating": lambda: stimuli.translating(speed_cm_s=12, lead_s=0.3, hold_s=0.1, rate_hz=rate_hz),
    }
    return make[kind]()
