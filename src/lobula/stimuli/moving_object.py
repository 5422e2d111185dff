"""The object itself: its size, its greys, and how it is drawn before the wall."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..params import param
from .view import Luminance, View, ViewSettings, strip_means

_OBJECT_SEED = 1
_CLOSEST_CM = 1e-3  # an object at the lens fills the view; nearer than this the projection would divide by zero
_DISC_LINES = 16


@dataclass(frozen=True, kw_only=True)
class MovingObject(View):
    """A flat object that faces the camera, and how long it stands still before and after it moves."""

    object_cm: float = param(4.0, "cm", "full width", low=0.01, high=1000, source="Colias: 4 cm")
    height_cm: float = param(3.2, "cm", "full height", low=0.01, high=1000, source="chosen")
    shape: str = param("box", "", "outline", choices=("box", "disc"), source="chosen")
    object_grey: float = param(45.0, "grey", "mean luminance", low=0, high=255, source="chosen")
    object_contrast_grey: float = param(
        0.0, "grey", "its stripes stay within the mean +- this", low=0, high=255, source="chosen"
    )
    object_stripes: int = param(
        8, "", "stripes across the object; they grow with it", low=1, high=1000, source="chosen"
    )
    eye_cm: float = param(
        2.2, "cm", "height of the camera above the floor, where there is one", low=0, high=1000, source="chosen"
    )
    lead_s: float = param(0.5, "s", "stillness before the motion", low=0, high=600, source="chosen")
    hold_s: float = param(0.3, "s", "stillness after the motion", low=0, high=600, source="chosen")

    @property
    def elevation_cm(self) -> float:
        """Height of the object's centre above the optical axis."""
        return self.height_cm / 2 - self.eye_cm if self.floor else 0.0


class ObjectSettings(ViewSettings, total=False):
    """The keywords every moving object takes; ``MovingObject`` says what each means."""

    object_cm: float
    height_cm: float
    shape: Literal["box", "disc"]
    object_grey: float
    object_contrast_grey: float
    object_stripes: int
    eye_cm: float
    lead_s: float
    hold_s: float


def draw(thing: MovingObject, behind: Luminance, x_cm: float, z_cm: float) -> Luminance:
    """Return the scene with the object at (``x_cm``, ``z_cm``): every pixel holds the mean light of its area.

    Boxes are exact; discs are exact along a row and take the mean of 16 lines down each pixel.
    """
    scale = thing.focal_px / max(z_cm, _CLOSEST_CM)
    middle = thing.width / 2 + scale * x_cm
    half_width, half_height = scale * thing.object_cm / 2, scale * thing.height_cm / 2
    top = thing.height / 2 - scale * thing.elevation_cm - half_height
    edges = middle + half_width * np.linspace(-1, 1, thing.object_stripes + 1)
    grey = np.clip(thing.object_grey + _stripes(thing), 0, 255)
    first, last = (int(np.clip(y, 0, thing.height)) for y in (np.floor(top), np.ceil(top + 2 * half_height)))
    columns = np.arange(thing.width + 1.0)
    covered: Luminance
    light: Luminance
    if thing.shape == "box":
        rows = np.diff(np.clip(np.arange(first, last + 1.0), top, top + 2 * half_height))[:, None]
        covered = rows * np.diff(np.clip(columns, edges[0], edges[-1]))
        light = rows * strip_means(edges, grey, columns)
    else:
        lines = first + (np.arange((last - first) * _DISC_LINES) + 0.5) / _DISC_LINES
        chord = half_width * np.sqrt(np.clip(1 - ((lines - top) / half_height - 1) ** 2, 0, None))[:, None]
        spans = np.clip(columns, middle - chord, middle + chord)
        pixels = (last - first, _DISC_LINES, thing.width)
        covered = np.diff(spans, axis=-1).reshape(pixels).mean(axis=1)
        light = strip_means(edges, grey, spans).reshape(pixels).mean(axis=1)
    image = behind.copy()
    image[first:last] += light - covered * behind[first:last]
    return image


def _stripes(thing: MovingObject) -> NDArray[np.float64]:
    draws: NDArray[np.float64] = np.random.default_rng([thing.seed, _OBJECT_SEED]).uniform(-1, 1, thing.object_stripes)
    return thing.object_contrast_grey * draws
