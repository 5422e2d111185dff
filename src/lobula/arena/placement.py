"""Where robots start: at random, apart from each other, from obstacles and from the wall."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from .world import World

CLEARANCES_CM = (5.0, 2.0, 0.5)
"""Room around each robot at the start: the first of these with which all find a place."""

TRIES, LAYOUTS = 500, 5
"""Random places looked at for each robot, and layouts begun anew for each clearance."""


def random_poses(world: World, rng: np.random.Generator) -> NDArray[np.float64]:
    """Return places and headings (R, 3), x, y in cm and rad, for ``world.robots.count`` robots.

    Raises
    ------
    ParameterError : they do not fit into the room
    """
    most = 0
    for clearance_cm in CLEARANCES_CM:
        for _ in range(LAYOUTS):
            places = _layout(world, clearance_cm, rng)
            if len(places) == world.robots.count:
                headings = rng.uniform(-math.pi, math.pi, len(places))
                return np.column_stack([places, headings])
            most = max(most, len(places))
    raise ParameterError(
        f"robots.count = {world.robots.count}: no room for so many robots of radius {world.body.radius_cm:g} cm in "
        f"{world.room_text} with {len(world.obstacles)} obstacles; at most {most} found a place"
    )


def _layout(world: World, clearance_cm: float, rng: np.random.Generator) -> NDArray[np.float64]:
    """Place one robot after the other until all are in or one finds no place; return those that are, (N, 2)."""
    radius = world.body.radius_cm
    size = np.array(world.room.size_cm)
    edge = radius + clearance_cm
    if (size <= 2 * edge).any():
        return np.empty((0, 2))
    taken = np.array([(o.x_cm, o.y_cm, o.radius_cm + edge) for o in world.obstacles]).reshape(-1, 3)
    fixed = len(taken)
    for _ in range(world.robots.count):
        tries = rng.uniform(edge, size - edge, (TRIES, 2))
        x, y, apart = taken.T
        free = (np.hypot(tries[:, :1] - x, tries[:, 1:] - y) >= apart).all(axis=1)
        if world.room.shape == "circle":
            free &= np.hypot(*(tries - size / 2).T) <= size[0] / 2 - edge
        if not free.any():
            break
        taken = np.vstack([taken, (*tries[free.argmax()], 2 * radius + clearance_cm)])
    return taken[fixed:, :2]
