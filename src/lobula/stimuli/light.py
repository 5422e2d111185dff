"""Scenes in which nothing moves: stillness, sensor noise, a flickering lamp, a flash."""

from __future__ import annotations

from dataclasses import replace
from typing import Unpack

import numpy as np

from ..errors import ParameterError
from ..params import to_dict
from .lamp import Flash, Flicker
from .movie import Movie
from .view import Luminance, View, ViewSettings, film, given, wall


def still(*, duration_s: float = 3.0, **settings: Unpack[ViewSettings]) -> Movie:
    """Return the still background for ``duration_s``. ``settings``: see ``View``."""
    view = given(View(), settings)
    behind = wall(view)
    return film(view, duration_s, lambda _: behind, kind="still", settings={"duration_s": duration_s})


def noise(*, sigma: float = 4.0, duration_s: float = 3.0, **settings: Unpack[ViewSettings]) -> Movie:
    """Return the still background through a noisy camera: Gaussian, ``sigma`` grey levels, fresh in every pixel.

    ``sigma`` takes the place of the setting ``noise_sigma``. ``settings``: see ``View``.

    Raises
    ------
    ParameterError : ``noise_sigma`` given as well
    """
    if "noise_sigma" in settings:
        raise ParameterError("stimuli.noise: noise_sigma: must be given as sigma")
    settings["noise_sigma"] = sigma
    return replace(still(duration_s=duration_s, **settings), kind="noise")


def flicker(
    *,
    hz: float = 10.0,
    amplitude: float = 0.1,
    phase_deg: float = 0.0,
    start_s: float = 0.0,
    duration_s: float = 3.0,
    **settings: Unpack[ViewSettings],
) -> Movie:
    """Return the still background under a lamp that flickers as a sinusoid.

    Each picture samples the lamp at its own instant, so 50, 60 and 100 Hz lamps alias as they do before a camera.
    ``Flicker`` says what each number means; ``settings``: see ``View``.

    Raises
    ------
    ParameterError : a number out of range
    """
    lamp = Flicker(hz=hz, amplitude=amplitude, phase_deg=phase_deg, start_s=start_s)
    return _lit(lamp, "flicker", duration_s, settings)


def flash(
    *,
    at_s: float = 1.5,
    gain: float = 1.0,
    offset_grey: float = 60.0,
    lasts_s: float = 0.0,
    decay_s: float = 0.0,
    duration_s: float = 3.0,
    **settings: Unpack[ViewSettings],
) -> Movie:
    """Return the still background with one sudden change of light: a step, a pulse, or one that fades.

    ``Flash`` says what each number means; ``settings``: see ``View``.

    Raises
    ------
    ParameterError : a number out of range
    """
    change = Flash(at_s=at_s, gain=gain, offset_grey=offset_grey, lasts_s=lasts_s, decay_s=decay_s)
    return _lit(change, "flash", duration_s, settings)


def _lit(change: Flicker | Flash, kind: str, duration_s: float, settings: ViewSettings) -> Movie:
    view = given(View(), settings)
    behind = wall(view)

    def light(time_s: float) -> Luminance:
        gain, offset = change.light(np.asarray(time_s))
        return behind * gain + offset

    return film(view, duration_s, light, kind=kind, settings=to_dict(change) | {"duration_s": duration_s})
