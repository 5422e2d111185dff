"""Films to run both engines on: what happens before a camera, and what never should."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from lobula import stimuli
from lobula.stimuli import Movie


class Film(NamedTuple):
    """Pictures (T, H, W), their times (T,), and when the camera turns (T,), or None."""

    images: np.ndarray
    times_s: np.ndarray
    turning: np.ndarray | None = None


SMALL: dict[str, Any] = {"width": 64, "height": 48, "lead_s": 0.3, "hold_s": 0.1}


def filmed(movie: Movie) -> Film:
    return Film(movie.images, movie.times_s)


def looming(**settings: Any) -> Movie:
    return stimuli.looming(**({"speed_cm_s": 20.0, "start_cm": 24.0} | SMALL | settings))


def receding(**settings: Any) -> Movie:
    return stimuli.receding(**({"speed_cm_s": 20.0, "stop_cm": 20.0} | SMALL | settings))


def translating(**settings: Any) -> Movie:
    return stimuli.translating(**({"speed_cm_s": 20.0, "span_cm": 7.0} | SMALL | settings))


def at_hz(hz: float, frames: int) -> np.ndarray:
    return np.arange(frames) / hz


def noise(height: int, width: int, *, seed: int = 0, frames: int = 16, dtype: Any = np.uint8) -> Film:
    """Uniform noise, fresh in every pixel."""
    rng = np.random.default_rng(seed)
    images = rng.uniform(0, 255, (frames, height, width)).astype(dtype)
    return Film(images, at_hz(30, frames))


def drifting(height: int, width: int, *, seed: int = 0, frames: int = 16) -> Film:
    """A random texture, smooth over a few pixels, that drifts two columns and one row a frame."""
    rng = np.random.default_rng(seed)
    wall = np.kron(rng.uniform(0, 255, (height, width)), np.ones((3, 3)))
    images = [wall[t : t + height, 2 * t : 2 * t + width] for t in range(frames)]
    return Film(np.array(images, np.float32), at_hz(30, frames))


def growing(height: int = 36, width: int = 52, *, frames: int = 30) -> Film:
    """A dark box grows on a textured wall, from the first frame on: all four neurons have something to say."""
    y, x = np.mgrid[:height, :width].astype(float)
    wall = 150 + 30 * np.sin(x / 3.1) * np.cos(y / 4.3)
    half = [3 + 0.02 * t**2.2 for t in range(frames)]
    inside = [(abs(x - width / 2.2) < h) & (abs(y - height / 1.9) < h) for h in half]
    return Film(np.array([np.where(box, 30.0, wall) for box in inside]).astype(np.uint8), at_hz(30, frames))


def faint_noise(height: int = 36, width: int = 52, *, frames: int = 30) -> Film:
    """A camera's noise on grey, as floats."""
    rng = np.random.default_rng(2)
    return Film((128 + rng.normal(0, 3, (frames, height, width))).astype(np.float32), at_hz(30, frames))


def lamps(height: int = 36, width: int = 52, *, frames: int = 30) -> Film:
    """A noisy scene under a lamp that is switched every sixth frame."""
    y, x = np.mgrid[:height, :width].astype(float)
    rng = np.random.default_rng(3)
    scene = 100 + 40 * np.sin(x / 5) * np.cos(y / 7)
    light = [1.0 + 0.5 * (t // 6 % 2) for t in range(frames)]
    images = np.array([scene * gain + rng.normal(0, 1.5, (height, width)) for gain in light])
    return Film(np.clip(images, 0, 255).astype(np.uint8), at_hz(30, frames))


def checks(height: int = 36, width: int = 52, *, frames: int = 30) -> Film:
    """Checks of 0 and 255 that swap in every frame."""
    y, x = np.mgrid[:height, :width]
    images = np.array([255 * ((x // 5 + y // 3 + t) % 2) for t in range(frames)])
    return Film(images.astype(np.uint8), at_hz(30, frames))


def one_pixel() -> Film:
    images = np.zeros((12, 24, 32), np.uint8)
    for t, (row, column) in enumerate([(0, 0), (23, 31), (12, 16), (12, 17), (12, 18), (0, 31), (23, 0), (5, 5)]):
        images[t + 2, row, column] = 255
    return Film(images, at_hz(30, len(images)))


def extremes() -> Film:
    """Black and white fields, halves and checkers, each for a frame."""
    rows, columns = np.mgrid[:33, :41]
    kinds = [rows * 0, rows * 0 + 1, rows > 15, columns > 20, (rows + columns) % 2, (rows + columns) % 2 == 0]
    images = np.array([np.where(kinds[k], 255, 0) for k in (0, 1, 0, 2, 3, 4, 5, 4, 1, 1, 0)], np.uint8)
    return Film(images, at_hz(30, len(images)))


def jittered(film: Film, *, seed: int = 0, gap_s: float = 0.0) -> Film:
    """Stamps of a poor clock; in the middle a pause."""
    rng = np.random.default_rng(seed)
    times = film.times_s + rng.uniform(-0.012, 0.012, len(film.times_s))
    times[len(times) // 2 :] += gap_s
    return film._replace(times_s=times)


def turned(film: Film) -> Film:
    turning = np.zeros(len(film.images), np.bool_)
    turning[[6, 7, 20, len(turning) // 2]] = True
    return film._replace(turning=turning)


NASTY: dict[str, Callable[[], Film]] = {
    "looming": lambda: filmed(looming()),
    "looming-bright": lambda: filmed(looming(object_grey=230.0, background_grey=90.0)),
    "looming-arena": lambda: filmed(looming(scene="arena", width=101, height=77)),
    "looming-unrounded": lambda: filmed(looming(quantised=False)),
    "receding": lambda: filmed(receding()),
    "translating-right": lambda: filmed(translating()),
    "translating-left": lambda: filmed(translating(direction="left", background="stripes")),
    "15-hz": lambda: filmed(looming(rate_hz=15.0)),
    "60-hz": lambda: filmed(looming(rate_hz=60.0)),
    "120-hz": lambda: filmed(translating(rate_hz=120.0)),
    "7-hz": lambda: filmed(translating(rate_hz=7.0, lead_s=1.0, hold_s=1.0, speed_cm_s=8.0)),
    "jitter": lambda: jittered(filmed(looming(scene="arena"))),
    "short-gap": lambda: jittered(filmed(looming()), gap_s=0.3),
    "long-gap": lambda: jittered(filmed(looming(scene="arena")), gap_s=0.8),
    "repeats": lambda: filmed(stimuli.with_repeats(looming(), every=3)),
    "flash": lambda: filmed(stimuli.with_flash(looming(scene="arena"), at_s=0.6, offset_grey=50.0)),
    "flash-pulse": lambda: filmed(stimuli.with_flash(translating(scene="arena"), at_s=0.6, gain=1.5, lasts_s=0.2)),
    "flicker": lambda: filmed(stimuli.with_flicker(looming(scene="arena"), hz=10.0, amplitude=0.2)),
    "turning": lambda: turned(filmed(looming())),
    "noise": lambda: noise(48, 64),
    "noise-least": lambda: noise(24, 32, seed=1),
    "noise-odd": lambda: noise(25, 33, seed=2, dtype=np.float32),
    "noise-tall": lambda: noise(120, 32, seed=3),
    "faint-noise": faint_noise,
    "growing": growing,
    "shrinking": lambda: growing()._replace(images=growing().images[::-1]),
    "lamps": lamps,
    "checks": checks,
    "drifting": lambda: drifting(77, 101),
    "constant": lambda: Film(np.full((12, 24, 32), 127, np.uint8), at_hz(30, 12)),
    "one-pixel": one_pixel,
    "extremes": extremes,
}
"""By name; each is made anew when it is called."""
