"""A controller that knows the true places and velocities, and runs of robots that it drives."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...arena.controller import Bools
from ...arena.geometry import Floats, closest_approach, pupils, wall_ahead_cm, wrap_rad
from ...arena.running import MOST_MINUTES
from ...arena.scorer import Scorer
from ...arena.scoring import Score, Tally
from ...arena.simulation import Simulation
from ...arena.world import RoomParams, World
from ...errors import ParameterError

Sight = Literal["edge", "centre", "around"]


@dataclass(frozen=True, kw_only=True)
class Rule:
    """When a robot turns: for which robots and how early, and how near to the wall.

    horizon_s : a robot that is to come within the scoring margin later than this does not matter yet
    sight : of which robots it knows
    wall_cm : the way left to drive until it touches the wall
    """

    horizon_s: float
    sight: Sight = "edge"
    wall_cm: float = 5.0


def robot_comes(poses: Floats, velocities_cm_s: Floats, world: World, rule: Rule) -> Bools:
    """Return which robots (R,) must turn because of another one.

    That one is in view, comes nearer, and will be within the scoring margin of touching in ``rule.horizon_s`` if both
    keep their velocities. ``poses`` (R, 3), ``velocities_cm_s`` (R, 2).
    """
    places = poses[:, :2]
    offsets, closing = places - places[:, None], velocities_cm_s - velocities_cm_s[:, None]  # [i, j]: j as i has it
    distances, _ = closest_approach(offsets, closing, rule.horizon_s)
    nearer = (offsets * closing).sum(axis=-1) < 0  # of nobody to itself
    meets = distances < 2 * world.body.radius_cm + world.scoring.margin_cm
    return np.asarray((nearer & meets & in_view(poses, world, rule.sight)).any(axis=1))


def in_view(poses: Floats, world: World, sight: Sight) -> Bools:
    """Return (R, R), [i, j]: whether robot i has robot j in view; what stands between hides nothing."""
    if sight == "around":
        return np.ones((len(poses), len(poses)), np.bool_)
    way = poses[:, :2] - pupils(poses, world.camera.ahead_cm)[:, None]
    bearings = wrap_rad(np.arctan2(way[..., 1], way[..., 0]) - poses[:, 2, None])
    limit = np.full(bearings.shape, np.radians(world.camera.fov_deg) / 2)
    if sight == "edge":
        limit += np.arcsin(np.minimum(world.body.radius_cm / np.hypot(way[..., 0], way[..., 1]), 1.0))
    return np.asarray(np.abs(bearings) < limit)


def wall_comes(poses: Floats, world: World, wall_cm: float) -> Bools:
    """Return which robots (R,) would touch the wall if they drove ``wall_cm`` straight on; ``poses`` (R, 3)."""
    radius = world.body.radius_cm
    reach = _reach_of_centres(world.room, radius)
    left = [wall_ahead_cm(reach, (x - radius, y - radius), heading) for x, y, heading in poses.tolist()]
    return np.array(left) < wall_cm


@lru_cache(maxsize=1)
def _reach_of_centres(room: RoomParams, radius_cm: float) -> RoomParams:
    """Return what is left of ``room`` to the middle of a body; its lower left corner is ``radius_cm`` in from that."""
    return replace(
        room,
        width_cm=room.width_cm - 2 * radius_cm,
        depth_cm=room.depth_cm - 2 * radius_cm,
        radius_cm=room.radius_cm - radius_cm,
    )


class Informed:
    """A controller that decides by ``rule`` and by the true state of ``simulation``, to be set before the first tick.

    It does not look at pictures, nor can it be asked what it would have said to others.

    Attributes
    ----------
    for_robot : (R,) who had to turn because of a robot, at the last step
    """

    simulation: Simulation

    def __init__(self, rule: Rule) -> None:
        self.rule = rule

    def start(self, robots: int, rng: np.random.Generator) -> None:
        """Begin with nobody having to turn."""
        self.for_robot = np.zeros(robots, np.bool_)

    def step(self, images: NDArray[np.uint8], time_s: float, turning: Bools) -> Bools:
        """Return who has to turn, because of a robot or the wall."""
        poses, world = self.simulation.pose, self.simulation.world
        speeds = np.where(turning, 0.0, self.simulation.motion.speeds_cm_s)
        velocities = speeds[:, None] * np.column_stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])])
        self.for_robot = robot_comes(poses, velocities, world, self.rule)
        return self.for_robot | wall_comes(poses, world, self.rule.wall_cm)


class ShutEye:
    """Gives pictures of one black pixel: nobody looks at them."""

    def views(self, cameras: ArrayLike, bodies: ArrayLike, **about: Any) -> NDArray[np.uint8]:
        """Return one black pixel for each of ``cameras`` (N, 3)."""
        return np.zeros((len(np.asarray(cameras)), 1, 1), np.uint8)


class Outcome(NamedTuple):
    """What came of a run: the score by place alone, and the tally by what the controller turned for."""

    score: Score
    reasons: Tally


def drive(world: World, rule: Rule, seed: int, minutes: float, poses: Floats | None = None) -> Outcome:
    """Let robots drive by ``rule`` for simulated ``minutes``, from ``poses`` (R, 3) if given, and count.

    By its reasons, a turn because of a robot is AA, since that robot approaches as the scoring has it; every other
    turn is AP.

    Raises
    ------
    ParameterError : minutes out of range; a world with no room for its robots
    """
    if not 0 < minutes <= MOST_MINUTES:
        raise ParameterError(f"minutes = {minutes!r}: must be above 0 and at most {MOST_MINUTES:g}")
    controller = Informed(rule)
    simulation = Simulation(world, controller, seed, poses=poses, eye=ShutEye())
    controller.simulation = simulation
    scorer = Scorer(simulation)
    for_robots = turns = 0
    for _ in range(max(1, round(minutes * 60 * world.camera.rate_hz))):
        tick = simulation.tick()
        scorer.tick(tick)
        turns += int(tick.avoiding.sum())
        for_robots += int((tick.avoiding & controller.for_robot).sum())
    score = scorer.score()
    return Outcome(score, Tally(cr=score.cr, cp=score.cp, aa=for_robots, ap=turns - for_robots))
