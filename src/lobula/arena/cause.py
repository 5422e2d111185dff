"""Why a robot turned: what the alarm needed, found by rendering the last second again without it.

An object is the cause of an alarm if the alarm is not raised without it. So the pictures since a saved state of the
controller are drawn again with one object left out, and the controller is asked again. The wall cannot be left out of
a room: it is painted plain, its mean grey. Its lower and upper edges stay, and grow as the robot comes nearer; to the
network they are nothing, so long as the wall is lighter than the floor.

An object that vanishes at the first of these pictures is a sudden change, which a controller may well answer. That
answer is over before it is looked at: the state is at least ``scoring.back_s`` old, one second, and the network's
potentials forget such a change in four frames, its decision in 0.3 s.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .contact import WALL
from .controller import Bools, ControllerError, Replays
from .events import NOTHING, obstacle_number
from .geometry import closest_approach
from .history import Past
from .sight import Object, ahead_cm
from .simulation import Views
from .world import World

TOLERANCE_TICKS = 2
"""The alarm persists if it is raised at its own tick, or so many before or after it.

A removal that merely moves the alarm by a frame or two has not removed it: near the threshold every pixel does that.
The frames after the alarm show what would have come, had all kept their velocities.
"""


class Cause(NamedTuple):
    """What made a robot turn: its index or code, one of ``events.RULES``, and how far it was from the pupil."""

    other: int
    rule: str
    distance_cm: float


def counterfactual_cause(
    past: Past, robot: int, about: Sequence[Object], world: World, eye: Views, controller: Replays
) -> Cause:
    """Return the object whose removal removes the alarm that ``robot`` raised at the last frame of ``past``.

    Candidates are what was in view in the last ``scoring.back_s``, of the objects ``about`` it (nearest first, from
    ``sight.objects``). The nearest is tried first, and the search ends with the first one found. If none alone does
    it, all objects nearer than ``scoring.near_cm`` are removed together: where the alarm persists there is no cause,
    else it is the nearest candidate.

    Raises
    ------
    ControllerError : the controller raised, or did not answer with one truth value for each picture
    """
    candidates = [one for one in about if one.in_view]
    replay = Replay(past, robot, world, eye, controller)
    for one in candidates:
        if not replay.persists({one.other}):
            return Cause(one.other, "alone", one.distance_cm)
    near = {one.other for one in about if one.distance_cm < world.scoring.near_cm}
    # one alone has been tried, and what no picture shows changes none
    if len(near) < 2 or replay.persists(near):
        return Cause(NOTHING, "none", np.nan)
    return Cause(candidates[0].other, "together", candidates[0].distance_cm)


class Replay:
    """The pictures of one robot's last second and a bit, ready to be drawn with something left out."""

    def __init__(self, past: Past, robot: int, world: World, eye: Views, controller: Replays) -> None:
        more = TOLERANCE_TICKS
        later_s = past.times_s[-1] + world.tick_s * np.arange(1, more + 1)
        self._state, self._robot, self._eye, self._controller = past.state, robot, eye, controller
        self._times_s = np.concatenate([past.times_s, later_s])
        self._poses = np.concatenate([past.poses, driven_on(past, robot, world, more)])
        self._turning = np.concatenate([past.turning[:, robot], np.zeros(more, np.bool_)])
        # keys of frames that never were: any will do, so long as they are the same each time
        self._keys = np.concatenate([past.keys, ~past.keys[-1] ^ np.arange(1, more + 1, dtype=np.uint64)])
        now, later = np.split(world.light.gain(np.append(past.times_s[-1], later_s)), [1])
        camera = past.light[-1] / now[0] if now[0] else 1.0  # the camera's own gain stays as it is
        self._light = np.concatenate([past.light, camera * later])
        self._obstacles = len(world.obstacles)

    def alarms(self, without: Collection[int] = ()) -> Bools:
        """Return what the controller says (T + TOLERANCE_TICKS,) to the pictures without these objects."""
        frames, robots = self._poses.shape[:2]
        shown = np.ones((frames, robots), np.bool_)
        shown[:, [other for other in without if other >= 0]] = False
        obstacles = np.ones((frames, self._obstacles), np.bool_)
        obstacles[:, [obstacle_number(other) for other in without if other < WALL]] = False
        images = self._eye.views(
            self._poses[:, self._robot],
            self._poses,
            own=np.full(frames, self._robot),
            keys=self._keys,
            light=self._light,
            shown=shown,
            walls=np.full(frames, WALL not in without),
            obstacles=obstacles,
        )
        alarm_s = self._times_s[-1 - TOLERANCE_TICKS]
        where = f"controller {type(self._controller).__name__}, replay of the alarm at {alarm_s:.3f} s"
        try:
            said = self._controller.replay(self._state, images, self._times_s, self._turning)
        except Exception as error:
            raise ControllerError(f"{where}: raised {type(error).__name__}: {error}") from error
        said = np.asarray(said)
        if said.shape != (frames,) or said.dtype != np.bool_:
            raise ControllerError(f"{where}: returned {said.dtype} {said.shape}: must be bool ({frames},)")
        return said

    def persists(self, without: Collection[int]) -> bool:
        """Return whether the alarm is raised without these objects too, within ``TOLERANCE_TICKS`` of its tick."""
        return bool(self.alarms(without)[-1 - 2 * TOLERANCE_TICKS :].any())


def driven_on(past: Past, robot: int, world: World, ticks: int) -> NDArray[np.float64]:
    """Return the poses (ticks, R, 3) that follow, velocities held, until ``robot`` would touch something."""
    last, step = past.poses[-1], past.velocities_cm_s * world.tick_s
    radius = world.body.radius_cm
    reach = np.array([2 * radius] * len(last) + [radius + o.radius_cm for o in world.obstacles])
    fixed = np.array([(o.x_cm, o.y_cm) for o in world.obstacles]).reshape(-1, 2)
    poses = [last]
    for _ in range(ticks):
        after = poses[-1].copy()
        after[:, :2] += step
        x, y = after[robot, :2].tolist()
        gaps = np.linalg.norm(np.concatenate([after[:, :2], fixed]) - (x, y), axis=1) - reach
        gaps[robot] = world.wall_gap_cm(x, y) - radius
        poses.append(after if gaps.min() >= 0 else poses[-1])
    return np.stack(poses[1:])


def geometric_cause(past: Past, robot: int, about: Sequence[Object], world: World) -> Cause:
    """Return the cause by place alone: the nearest robot in view within ``scoring.near_cm``, else the periphery.

    The periphery is an obstacle in view, or the wall straight ahead, whichever is nearer, if it is as near as that;
    else there is no cause.
    """
    now = [one for one in about if one.in_view_now and one.other != WALL]
    robots = [(one.distance_cm, one.other) for one in now if one.other >= 0]
    periphery = [(one.distance_cm, one.other) for one in now if one.other < 0]
    periphery.append((ahead_cm(past, robot, world), WALL))
    for distance_cm, other in [*robots[:1], min(periphery)]:
        if distance_cm < world.scoring.near_cm:
            return Cause(other, "geometric", distance_cm)
    return Cause(NOTHING, "geometric", np.nan)


def approach(past: Past, robot: int, other: int, world: World) -> tuple[bool, float]:
    """Return whether ``other`` approaches ``robot`` at the last frame of ``past``, and by how much they would miss.

    It does if the two come nearer and, velocities held, will be within ``scoring.margin_cm`` of touching in
    ``scoring.horizon_s``. The miss is the least gap between them in that time, cm, below 0 where they would overlap.
    """
    offset = past.poses[-1, other, :2] - past.poses[-1, robot, :2]
    velocity = past.velocities_cm_s[other] - past.velocities_cm_s[robot]
    distance, _ = closest_approach(offset, velocity, world.scoring.horizon_s)
    miss_cm = float(distance) - 2 * world.body.radius_cm
    return bool(offset @ velocity < 0 and miss_cm < world.scoring.margin_cm), miss_cm


def kind_of(cause: Cause, past: Past, robot: int, world: World) -> str:
    """Return what an avoidance with this cause is: AA or AT of a robot, AP of the periphery, else spurious."""
    if cause.other == NOTHING:
        return "spurious"
    if cause.other < 0:
        return "AP"
    return "AA" if approach(past, robot, cause.other, world)[0] else "AT"
