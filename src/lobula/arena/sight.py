"""What a robot had before its eyes: the objects around it, how far they were, and which it could have seen coming."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .contact import WALL, obstacle_code
from .events import obstacle_number
from .geometry import (
    discs_in_view,
    incidence_deg,
    nearest_wall_in_view_cm,
    normal_ahead,
    points_in_view,
    pupils,
    wall_ahead_cm,
)
from .history import Past
from .world import World


class Object(NamedTuple):
    """Something around a robot at its last frame.

    ``other`` is a robot's index or a code of ``contact``; ``distance_cm`` is that from the pupil to the surface, for
    the wall to its nearest point in the field of view. ``in_view`` says whether it appeared in a picture of the last
    ``scoring.back_s``, ``in_view_now`` whether in the last one. The wall is everywhere: both are true.
    ``incidence_deg`` lies between the heading and the way from the pupil to its middle; for the wall, the normal of the
    wall straight ahead.
    """

    other: int
    distance_cm: float
    incidence_deg: float
    in_view: bool
    in_view_now: bool


def objects(past: Past, robot: int, world: World) -> list[Object]:
    """Return all other robots, the obstacles and the wall, the nearest first."""
    seen = seen_lately(past, robot, world)
    pupil, heading = pupil_now(past, robot, world)
    fixed = [(o.x_cm, o.y_cm) for o in world.obstacles]
    places = [*past.poses[-1, :, :2].tolist(), *fixed]
    robots = past.poses.shape[1]
    radii = [world.body.radius_cm] * robots + [o.radius_cm for o in world.obstacles]
    codes = [*range(robots), *(obstacle_code(k) for k in range(len(fixed)))]
    wall = nearest_wall_in_view_cm(world.room, pupil, heading, world.camera.fov_deg)
    found = [Object(WALL, wall, incidence_deg(heading, normal_ahead(world.room, pupil, heading)), True, True)]
    found += [
        Object(
            other=code,
            distance_cm=max(math.dist(pupil, place) - radius, 0.0),
            incidence_deg=incidence_deg(heading, math.atan2(place[1] - pupil[1], place[0] - pupil[0])),
            in_view=bool(views.any()),
            in_view_now=bool(views[-1]),
        )
        for code, place, radius, views in zip(codes, places, radii, seen.T, strict=True)
        if code != robot
    ]
    return sorted(found, key=lambda one: one.distance_cm)


def seen_lately(past: Past, robot: int, world: World) -> NDArray[np.bool_]:
    """Return what the pictures of the last ``scoring.back_s`` show: (T, R + K), robots, then obstacles."""
    poses = past.poses[recent(past, world.scoring.back_s)]
    moments, robots = poses.shape[:2]
    fixed = np.array([(o.x_cm, o.y_cm) for o in world.obstacles]).reshape(-1, 2)
    centres = np.concatenate([poses[..., :2], np.broadcast_to(fixed, (moments, *fixed.shape))], axis=1)
    radii = np.array([world.body.radius_cm] * robots + [o.radius_cm for o in world.obstacles])
    heights = np.array([world.body.height_cm] * robots + [o.height_cm for o in world.obstacles])
    others = np.arange(len(radii)) != robot
    own = poses[:, robot]
    pupil = pupils(own, world.camera.ahead_cm)
    seen = np.zeros((moments, len(radii)), np.bool_)
    seen[:, others] = discs_in_view(pupil, own[:, 2], centres[:, others], radii[others], heights[others], world.camera)
    return seen


def could_see(past: Past, robot: int, other: int, touched: Sequence[float], world: World) -> bool:
    """Return whether ``robot`` could have seen coming what it is about to touch.

    It could if it was not turning when they touched, and ``other`` was in a picture of the last ``scoring.back_s`` that
    was taken while it was not turning. Of the wall, that is the place that is touched: ``touched`` (x, y).
    """
    lately = recent(past, world.scoring.back_s)
    free = ~past.turning[lately, robot]
    if not free[-1]:
        return False
    if other == WALL:
        own = past.poses[lately, robot]
        seen = points_in_view(pupils(own, world.camera.ahead_cm), own[:, 2], touched, world.camera.fov_deg)
    else:
        column = other if other >= 0 else past.poses.shape[1] + obstacle_number(other)
        seen = seen_lately(past, robot, world)[:, column]
    return bool((seen & free).any())


def recent(past: Past, back_s: float) -> slice:
    """Return the frames that are no older than ``back_s`` at the last one."""
    return slice(int(np.searchsorted(past.times_s, past.times_s[-1] - back_s - 1e-9)), None)


def pupil_now(past: Past, robot: int, world: World) -> tuple[tuple[float, float], float]:
    """Return where the camera of ``robot`` is at the last frame, and its heading."""
    x, y = pupils(past.poses[-1, robot], world.camera.ahead_cm).tolist()
    return (x, y), float(past.poses[-1, robot, 2])


def ahead_cm(past: Past, robot: int, world: World) -> float:
    """Return the distance from the pupil to the wall straight ahead, at the last frame."""
    return wall_ahead_cm(world.room, *pupil_now(past, robot, world))
