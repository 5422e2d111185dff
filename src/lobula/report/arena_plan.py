"""The plan of an arena as a picture: floor, wall with its stripes, obstacles; and where a place lies on it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .arena_pen import disc, ring
from .canvas import Canvas, Colour, mix, rgb
from .palette import DARK

_GROUND, _FLOOR, _OBSTACLE = rgb(DARK.ground), rgb("#1d222a"), rgb("#6b7585")
_RIM_CM = 1.2
_DULL = 0.6  # of the wall's own greys: the robots are what is to be seen


@dataclass(frozen=True, kw_only=True, eq=False)
class ArenaPlan:
    """What stays the same during a run, as plain numbers.

    circle : a round room; else a box
    size_cm : extent along x and y; (0, 0) is the lower left corner
    wall_grey : (n,) its luminance counter-clockwise, from the lower left corner, in a circle from the right
    obstacles_cm : (n, 3) x, y and radius
    body_cm : radius of the robots
    pupil_cm, fov_deg, sight_cm : their cameras: how far ahead of the centre, how wide, and how far to draw the view
    """

    circle: bool
    size_cm: tuple[float, float]
    wall_grey: NDArray[np.float64]
    obstacles_cm: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 3)))
    body_cm: float = 2.0
    pupil_cm: float = 1.33
    fov_deg: float = 70.0
    sight_cm: float = 15.0


class Ground:
    """The plan drawn as large as fits into a height and width in px.

    Attributes
    ----------
    scale : px per cm
    picture : (height, width, 3), the empty room; do not draw on it
    floor : (height, width) bool, where the floor is
    """

    def __init__(self, plan: ArenaPlan, height: int, width: int) -> None:
        wide_cm, deep_cm = plan.size_cm
        self.scale = min(width / (wide_cm + 2 * _RIM_CM), height / (deep_cm + 2 * _RIM_CM))
        self._left = (width - self.scale * wide_cm) / 2 - 0.5
        self._foot = (height + self.scale * deep_cm) / 2 - 0.5
        rows, columns = np.mgrid[:height, :width]
        x, y = (columns - self._left) / self.scale, (self._foot - rows) / self.scale
        outside_cm, along = _around_room(plan, x, y)
        self.floor: NDArray[np.bool_] = outside_cm <= 0
        self.picture = self._drawn(plan, outside_cm, along)

    def px(self, x_cm: NDArray[np.float64], y_cm: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
        """Return rows and columns of places."""
        return self._foot - self.scale * y_cm, self._left + self.scale * x_cm

    def _drawn(self, plan: ArenaPlan, outside_cm: NDArray[np.float64], along: NDArray[np.float64]) -> Canvas:
        canvas = np.empty((*outside_cm.shape, 3), np.uint8)
        canvas[...] = _GROUND
        grey = plan.wall_grey[np.minimum((along * len(plan.wall_grey)).astype(np.intp), len(plan.wall_grey) - 1)]
        wall = (outside_cm > 0) & (outside_cm <= _RIM_CM)
        canvas[wall] = (_DULL * grey[wall])[:, None].astype(np.uint8)
        canvas[self.floor] = _FLOOR
        for x, y, radius in plan.obstacles_cm:
            row, column = self.px(x, y)
            disc(canvas, float(row), float(column), radius * self.scale, _OBSTACLE)
            ring(canvas, float(row), float(column), radius * self.scale, 2, _lighter(_OBSTACLE))
        return canvas


def _lighter(colour: Colour) -> Colour:
    return mix(colour, (255, 255, 255), 0.3)


def _around_room(
    plan: ArenaPlan, x: NDArray[np.float64], y: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distance from the floor's edge, positive outside, and the place on the wall beside it as a share of its way."""
    wide, deep = plan.size_cm
    if plan.circle:
        from_middle = np.hypot(x - wide / 2, y - wide / 2)
        return from_middle - wide / 2, np.arctan2(y - wide / 2, x - wide / 2) / (2 * math.pi) % 1.0
    outside = np.maximum(np.maximum(-x, x - wide), np.maximum(-y, y - deep))
    u, v = np.clip(x, 0, wide), np.clip(y, 0, deep)
    sides = [(-y, u), (x - wide, wide + v), (y - deep, 2 * wide + deep - u), (-x, 2 * (wide + deep) - v)]
    beyond = np.stack([side[0] for side in sides])
    along = np.choose(beyond.argmax(axis=0), [side[1] for side in sides])
    return outside, along / (2 * (wide + deep)) % 1.0
