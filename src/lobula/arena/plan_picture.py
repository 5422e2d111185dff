"""The room from above as a plain picture: floor, wall, obstacles, robots and where they look."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .world import World

_FLOOR, _WALL, _POST = (29, 34, 42), (150, 150, 150), (107, 117, 133)
_ROBOT, _TURNING, _NOSE = (139, 166, 201), (85, 191, 211), (236, 239, 243)
_MARGIN_CM = 1.0


def plan_picture(
    world: World, poses: NDArray[np.float64], turning: NDArray[np.bool_], *, px_per_cm: float = 8.0
) -> NDArray[np.uint8]:
    """Return robots at ``poses`` (R, 3) in their room, (H, W, 3) RGB uint8; those ``turning`` (R,) are brighter.

    x grows rightwards, y upwards; a wall of 1 cm is drawn around the floor.
    """
    wide, deep = world.room.size_cm
    columns, rows = round((wide + 2 * _MARGIN_CM) * px_per_cm), round((deep + 2 * _MARGIN_CM) * px_per_cm)
    x = ((np.arange(columns) + 0.5) / px_per_cm - _MARGIN_CM)[None, :]
    y = (deep + _MARGIN_CM - (np.arange(rows) + 0.5) / px_per_cm)[:, None]
    picture = np.empty((rows, columns, 3))
    picture[...] = _WALL
    if world.room.shape == "circle":
        inside = wide / 2 - np.hypot(x - wide / 2, y - wide / 2)
    else:
        inside = np.minimum(np.minimum(x, wide - x), np.minimum(y, deep - y))
    _lay(picture, inside * px_per_cm, _FLOOR)
    for post in world.obstacles:
        _lay(picture, (post.radius_cm - np.hypot(x - post.x_cm, y - post.y_cm)) * px_per_cm, _POST)
    radius, half = world.body.radius_cm, math.radians(world.camera.fov_deg / 2)
    for (at_x, at_y, heading), turns in zip(poses.tolist(), turning.tolist(), strict=True):
        part = _near(x[0], at_x, radius), _near(y[:, 0], at_y, radius)
        right, up = x[:, part[0]] - at_x, y[part[1]] - at_y
        from_centre = np.hypot(right, up)
        body = picture[part[1], part[0]]
        _lay(body, (radius - from_centre) * px_per_cm, _TURNING if turns else _ROBOT)
        # a slice of the disc, as wide as the field of view
        aside = np.abs(np.remainder(np.arctan2(up, right) - heading + np.pi, 2 * np.pi) - np.pi)
        _lay(body, np.minimum(radius - from_centre, from_centre * (half - aside)) * px_per_cm, _NOSE)
    return np.rint(picture).astype(np.uint8)


def _near(places_cm: NDArray[np.floating[Any]], middle_cm: float, reach_cm: float) -> slice:
    """Return which pixels a disc can touch."""
    near = np.flatnonzero(np.abs(places_cm - middle_cm) < 1.1 * reach_cm)
    return slice(int(near[0]), int(near[-1]) + 1) if near.size else slice(0, 0)


def _lay(picture: NDArray[np.float64], inside_px: NDArray[np.float64], colour: tuple[int, int, int]) -> None:
    """Paint where ``inside_px``, the distance within an edge, is positive; half a pixel on either side blends."""
    share = np.clip(inside_px + 0.5, 0, 1)[..., None]
    picture += share * (np.array(colour) - picture)
