"""The arena with one robot that stands still and looks, and one that drives a course before it."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arena.eye import Eye
from ...arena.scene import build_scene
from ...arena.world import World
from ...errors import ParameterError
from ...params import settings_hash
from .courses import Course, CourseParams

STANDS_AHEAD_OF_WALL_CM = 15.0
"""The looking robot's centre from the left wall; it looks to the right, along the middle of the arena."""


@dataclass(frozen=True)
class Film:
    """What the standing robot's camera saw: ``images`` (T, H, W) uint8, ``times_s`` (T,)."""

    images: NDArray[np.uint8]
    times_s: NDArray[np.float64]
    tick_s: float
    scene_hash: str


class Stage:
    """Films courses in ``world``; the seed of a film draws the wall, the sensor's noise and a small misplacement."""

    def __init__(self, world: World) -> None:
        self.world = world
        self._eyes: dict[int, Eye] = {}

    def film(self, course: Course, p: CourseParams, seed: int) -> Film:
        """Return the film of ``course``.

        All courses of one seed have the same wall and the same misplacement, so they can be compared in pairs.

        Raises
        ------
        ParameterError : the robot would drive through the wall
        """
        placing, noise = (np.random.default_rng([seed, use]) for use in (0, 1))
        ahead_cm, right_cm = placing.uniform(-p.misplaced_cm, p.misplaced_cm, 2)
        times_s = course.times_s(p, self.world.camera.rate_hz)
        places = course.shifted(ahead_cm, right_cm).places(times_s, p)
        bodies = self._poses(places)
        images = self._eye(seed).views(
            np.broadcast_to(self._standing(), (len(times_s), 3)),
            bodies[:, None],
            keys=noise.integers(2**64, size=len(times_s), dtype=np.uint64),
        )
        return Film(images, times_s, self.world.tick_s, scene_hash(self.world, p))

    def _standing(self) -> NDArray[np.float64]:
        return np.array([STANDS_AHEAD_OF_WALL_CM, self.world.room.size_cm[1] / 2, 0.0])

    def _poses(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Poses (T, 3) in the room of what is seen at ``places`` (T, 2); it faces the way it drives."""
        x_cm, y_cm, _ = self._standing()
        x = x_cm + self.world.camera.ahead_cm + places[:, 0]
        y = y_cm - places[:, 1]
        radius_cm = self.world.body.radius_cm
        gap_cm = min(self.world.wall_gap_cm(float(x[i]), float(y[i])) for i in (0, -1))
        if gap_cm < radius_cm:
            raise ParameterError(
                f"course from ({x[0]:.1f}, {y[0]:.1f}) to ({x[-1]:.1f}, {y[-1]:.1f}) cm: must stay {radius_cm:g} cm "
                f"from the walls of {self.world.room_text}"
            )
        heading = np.arctan2(y[-1] - y[0], x[-1] - x[0])
        return np.column_stack([x, y, np.full(len(x), heading)])

    def _eye(self, seed: int) -> Eye:
        if seed not in self._eyes:
            self._eyes[seed] = Eye(build_scene(self.world, seed), self.world.camera)
        return self._eyes[seed]


def scene_hash(world: World, p: CourseParams) -> str:
    """Return twelve hexadecimal digits that change with any setting of the arena or of the courses."""
    return hashlib.sha256(f"{settings_hash(world)} {settings_hash(p)}".encode()).hexdigest()[:12]
