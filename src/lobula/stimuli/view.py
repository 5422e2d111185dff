"""The camera and the still scene behind everything: optics, timing, sensor noise, background."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypedDict, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..checks import MIN_HEIGHT, MIN_WIDTH
from ..errors import ParameterError
from ..params import Params, param, to_dict, with_settings
from .movie import Movie, as_images

Luminance = NDArray[np.float64]
"""(H, W) light per pixel before noise and rounding, 0..255."""

LONGEST_S = 3600.0
_BACKGROUND_SEED, _NOISE_SEED = 0, 2


@dataclass(frozen=True, kw_only=True)
class View(Params):
    """A pinhole camera with square pixels that looks straight ahead at a still wall."""

    width: int = param(99, "px", "columns", low=MIN_WIDTH, high=4096, source="paper Sec. III: 99 x 72")
    height: int = param(72, "px", "rows", low=MIN_HEIGHT, high=4096, source="paper Sec. III: 99 x 72")
    view_deg: float = param(70.0, "deg", "horizontal field of view", low=10, high=150, source="Colias camera")
    rate_hz: float = param(30.0, "Hz", "pictures per second", low=1, high=1000, source="Colias camera")
    background: str = param("plain", "", "pattern of the wall", choices=("plain", "stripes", "blobs"), source="chosen")
    background_grey: float = param(175.0, "grey", "mean of the wall", low=0, high=255, source="chosen")
    background_contrast_grey: float = param(
        12.0, "grey", "the pattern stays within the mean +- this", low=0, high=255, source="chosen"
    )
    background_deg: float = param(2.0, "deg", "width of a stripe, or of a blob", low=0.1, high=30, source="chosen")
    floor: bool = param(False, "", "a dark floor below the horizon; the object stands on it", source="chosen")
    floor_grey: float = param(95.0, "grey", "luminance of the floor", low=0, high=255, source="chosen")
    noise_sigma: float = param(0.0, "grey", "sensor noise, standard deviation", low=0, high=100, source="chosen")
    seed: int = param(0, "", "draws the patterns and the noise", low=0, source="chosen")
    quantised: bool = param(True, "", "round to 8 bit, as a camera does", source="chosen")

    @property
    def focal_px(self) -> float:
        """Pixels per unit of tangent: something w wide at distance d spans ``focal_px * w / d`` columns."""
        return self.width / 2 / math.tan(math.radians(self.view_deg) / 2)


AnyView = TypeVar("AnyView", bound=View)


class ViewSettings(TypedDict, total=False):
    """The keywords every movie takes; ``View`` says what each means, its unit, default and range."""

    scene: Literal["plain", "arena"]
    width: int
    height: int
    view_deg: float
    rate_hz: float
    background: Literal["plain", "stripes", "blobs"]
    background_grey: float
    background_contrast_grey: float
    background_deg: float
    floor: bool
    floor_grey: float
    noise_sigma: float
    seed: int
    quantised: bool


SCENES: dict[str, dict[str, Any]] = {
    "plain": {},
    "arena": {"background": "stripes", "floor": True, "noise_sigma": 1.5},
}
"""What ``scene=`` sets before the other keywords: ``arena`` is a striped wall, a dark floor and a noisy camera."""


def given(defaults: AnyView, settings: Mapping[str, Any]) -> AnyView:
    """Return ``defaults`` with ``scene`` applied, then the other keywords of ``settings``, which win over it.

    Raises
    ------
    ParameterError : no such scene or keyword, or a value out of range
    """
    own = dict(settings)
    name = own.pop("scene", "plain")
    if name not in SCENES:
        raise ParameterError(f"stimuli: scene {name!r}: must be one of {', '.join(SCENES)}")
    view: AnyView = with_settings(defaults, SCENES[name] | own, "given", "stimuli: ")
    return view


def require_between(where: str, value: float, low: float, high: float, unit: str) -> float:
    """Return ``value`` as a float if it lies in [low, high].

    Raises
    ------
    ParameterError : it does not
    """
    if not low <= value <= high:  # NaN is never inside
        raise ParameterError(f"{where} = {value!r}: must be in [{low:g}, {high:g}] {unit}".rstrip())
    return float(value)


def strip_means(
    edges: NDArray[np.float64], values: NDArray[np.float64], samples: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Integrate a row of flat strips exactly between neighbouring ``samples``.

    ``edges`` (n + 1,) rising, ``values`` (n,) one for each strip; outside the strips there is nothing. ``samples``
    (..., m + 1) in the same unit as ``edges``; returns (..., m), value times length.
    """
    total = np.concatenate(([0.0], np.cumsum(values * np.diff(edges))))
    return np.diff(np.interp(samples, edges, total), axis=-1)


def wall(view: View) -> Luminance:
    """Return the still background, (H, W): a pure function of the settings."""
    rng = np.random.default_rng([view.seed, _BACKGROUND_SEED])
    size_px = view.focal_px * math.tan(math.radians(view.background_deg))
    image = np.full((view.height, view.width), view.background_grey, dtype=np.float64)
    if view.background == "stripes":
        count = math.ceil(view.width / size_px)
        edges = np.arange(count + 1.0) * size_px
        image += strip_means(
            edges, view.background_contrast_grey * rng.uniform(-1, 1, count), np.arange(view.width + 1.0)
        )
    elif view.background == "blobs":
        image += view.background_contrast_grey * _blobs(rng, view.height, view.width, size_px)
    if view.floor:
        above = np.clip(view.height / 2 - np.arange(view.height), 0, 1)[:, None]
        image = above * image + (1 - above) * view.floor_grey
    return np.clip(image, 0.0, 255.0)


def _blobs(rng: np.random.Generator, height: int, width: int, size_px: float) -> Luminance:
    """Random values on a grid of ``size_px``, joined smoothly; within -1..1."""
    rows, columns = (np.arange(n) / size_px for n in (height, width))
    grid = rng.uniform(-1, 1, (int(rows[-1]) + 2, int(columns[-1]) + 2))

    def weights(at: NDArray[np.float64], count: int) -> NDArray[np.float64]:
        near: NDArray[np.float64] = np.clip(1 - np.abs(at[:, None] - np.arange(count)), 0, 1)
        return near * near * (3 - 2 * near)  # two neighbours still sum to 1, and the slope is 0 at the grid points

    joined: Luminance = weights(rows, grid.shape[0]) @ grid @ weights(columns, grid.shape[1]).T
    return joined


def stamps(view: View, duration_s: float) -> NDArray[np.float64]:
    """Return the times of the pictures, (T,) s, from 0 to ``duration_s``, both ends included where they fall."""
    require_between("stimuli: duration_s", duration_s, 0.0, LONGEST_S, "s")
    return np.arange(math.floor(duration_s * view.rate_hz + 1e-9) + 1) / view.rate_hz


def film(
    view: View,
    duration_s: float,
    light: Callable[[float], Luminance],
    *,
    kind: str,
    contact_s: float | None = None,
    settings: Mapping[str, Any],
) -> Movie:
    """Take pictures of ``light(time_s)`` for ``duration_s``, add the sensor's noise, round, and wrap it all up.

    ``light`` may hand back the very same array while nothing moves; it is not written to.
    """
    times_s = stamps(view, duration_s)
    dtype = np.dtype(np.uint8 if view.quantised else np.float32)
    images = np.empty((len(times_s), view.height, view.width), dtype=dtype)
    rng = np.random.default_rng([view.seed, _NOISE_SEED])
    for image, time_s in zip(images, times_s, strict=True):
        luminance = light(float(time_s))
        if view.noise_sigma:
            luminance = luminance + view.noise_sigma * rng.standard_normal(luminance.shape, dtype=np.float32)
        image[:] = as_images(luminance, dtype)
    return Movie(images, times_s, contact_s, kind, view.rate_hz, to_dict(view) | dict(settings))
