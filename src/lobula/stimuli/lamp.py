"""How the light of a whole scene changes: the course of a flicker and of a flash, and both laid over a movie."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..params import Params, param, to_dict
from .movie import Movie, as_images
from .view import require_between

Course = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Flicker(Params):
    """A lamp whose light goes as ``1 + amplitude * sin(2 pi hz (t - start_s) + phase)`` from ``start_s`` on."""

    hz: float = param(10.0, "Hz", "frequency of the lamp", low=0, high=1000, source="chosen")
    amplitude: float = param(0.1, "", "share of the light that comes and goes", low=0, high=1, source="chosen")
    phase_deg: float = param(0.0, "deg", "phase at start_s", low=-360, high=360, source="chosen")
    start_s: float = param(0.0, "s", "steady light before this", low=0, high=3600, source="chosen")

    def light(self, times_s: Course) -> tuple[Course, Course]:
        """Return the factor and the added grey at ``times_s``, each of its shape."""
        t = times_s - self.start_s
        wave = np.sin(2 * math.pi * self.hz * t + math.radians(self.phase_deg))
        return np.where(t >= 0, 1 + self.amplitude * wave, 1.0), np.zeros_like(t)


@dataclass(frozen=True, kw_only=True)
class Flash(Params):
    """A sudden change of light: every pixel times ``gain``, plus ``offset_grey``.

    The change stays (a step), goes at once after ``lasts_s`` (a pulse), or fades with time constant ``decay_s``, as
    when a camera sets its exposure again. A gain below 1 or an offset below 0 makes it a dark flash.
    """

    at_s: float = param(1.5, "s", "when it happens", low=0, high=3600, source="chosen")
    gain: float = param(1.0, "", "factor on every pixel", low=0, high=100, source="chosen")
    offset_grey: float = param(0.0, "grey", "added to every pixel", low=-255, high=255, source="chosen")
    lasts_s: float = param(0.0, "s", "length of a pulse; 0: a step that stays", low=0, high=3600, source="chosen")
    decay_s: float = param(0.0, "s", "time constant of the return; 0: none", low=0, high=3600, source="chosen")

    def light(self, times_s: Course) -> tuple[Course, Course]:
        """Return the factor and the added grey at ``times_s``, each of its shape."""
        t = times_s - self.at_s + 1e-9  # a picture taken at the very instant already shows the change
        lit = (t >= 0) & (t < self.lasts_s) if self.lasts_s else t >= 0
        strength = np.where(lit, np.exp(-np.maximum(t, 0.0) / self.decay_s) if self.decay_s else 1.0, 0.0)
        return 1 + (self.gain - 1) * strength, self.offset_grey * strength


def with_flicker(
    movie: Movie, *, hz: float = 10.0, amplitude: float = 0.1, phase_deg: float = 0.0, start_s: float = 0.0
) -> Movie:
    """Return ``movie`` under a flickering lamp; ``Flicker`` says what each number means.

    Each picture samples the lamp at its own instant, so 50, 60 and 100 Hz lamps alias as they do before a camera.

    Raises
    ------
    ParameterError : a number out of range
    """
    return _relit(movie, Flicker(hz=hz, amplitude=amplitude, phase_deg=phase_deg, start_s=start_s), "flicker")


def with_flash(
    movie: Movie,
    *,
    at_s: float = 1.5,
    gain: float = 1.0,
    offset_grey: float = 0.0,
    lasts_s: float = 0.0,
    decay_s: float = 0.0,
) -> Movie:
    """Return ``movie`` with one sudden change of light; ``Flash`` says what each number means.

    Raises
    ------
    ParameterError : a number out of range
    """
    change = Flash(at_s=at_s, gain=gain, offset_grey=offset_grey, lasts_s=lasts_s, decay_s=decay_s)
    return _relit(movie, change, "flash")


def with_repeats(movie: Movie, *, every: int = 3) -> Movie:
    """Return ``movie`` with each ``every``-th picture held: a 10 Hz camera in a 30 Hz file is ``every=3``.

    Raises
    ------
    ParameterError : ``every`` is below 1
    """
    require_between("stimuli.with_repeats: every", every, 1, math.inf, "pictures")
    held = np.arange(len(movie)) // every * every
    return replace(movie, images=movie.images[held], settings=dict(movie.settings) | {"repeats": every})


def _relit(movie: Movie, change: Flicker | Flash, name: str) -> Movie:
    images = np.empty_like(movie.images)
    for k, (gain, offset) in enumerate(zip(*change.light(movie.times_s), strict=True)):
        images[k] = as_images(movie.images[k] * gain + offset, movie.images.dtype)
    own: dict[str, Any] = {f"{name}_{key}": value for key, value in to_dict(change).items()}
    return replace(movie, images=images, settings=dict(movie.settings) | own)
