"""A run in the arena, tick by tick: see, decide, move, touch.

Tick k begins with the frame at time k / rate. What the controllers say to it acts in that very tick, at whose end the
robots have moved on and touches are known. The same seed gives the same run, bit for bit.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping
from itertools import product
from time import perf_counter
from typing import Any, NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import ParameterError
from ..params import settings_hash
from .chance import Chance
from .contact import Contact, Episodes, Surroundings
from .controller import Bools, Controller, ControllerError, KeepsState, decide, keeps_state, require_controller
from .exposure import Exposure
from .eye import Eye
from .history import History, Past
from .motion import FORWARD, Motion
from .placement import random_poses
from .scene import build_scene
from .world import World

SAVE_EVERY_S = 0.25
"""The controllers' states are saved this often, so that the last second can be judged again from one of them."""

ROBOT_DTYPE = np.dtype(
    [("x_cm", np.float64), ("y_cm", np.float64), ("heading_rad", np.float64), ("speed_cm_s", np.float64),
     ("phase", np.int8), ("distance_cm", np.float64)]
)  # fmt: skip
"""Columns of ``Simulation.robots``; ``phase`` is FORWARD, STOP or TURN of ``motion``."""


class Tick(NamedTuple):
    """What happened in a tick: whose decision (R,) acts in it, and which contacts began."""

    avoiding: Bools
    contacts: tuple[Contact, ...]


class Views(Protocol):
    """What renders the pictures; ``eye.Eye`` is one."""

    def views(
        self, cameras: ArrayLike, bodies: ArrayLike, *, own: ArrayLike | None = None, keys: ArrayLike | None = None,
        light: ArrayLike | None = None, shown: ArrayLike | None = None, obstacles: ArrayLike | None = None,
        walls: ArrayLike | None = None,
    ) -> NDArray[np.uint8]:  # fmt: skip
        """Return what each of ``cameras`` (N, 3) sees of ``bodies``, as (N, H, W); all else as ``Eye.views`` has it."""


class Simulation:
    """Robots in a world, each driven by what the controller says to what it sees.

    Parameters
    ----------
    world : the arena
    controller : pictures in, decisions out; it is started here
    seed : of all chance in the run
    poses : (R, 3) x, y in cm and heading in rad, to start elsewhere than at random
    engine : of the eye: ``core``, ``reference`` or ``auto``
    eye : renders the pictures, instead of the world's own

    Attributes
    ----------
    tick_count : ticks gone through
    pose : (R, 3), x, y in cm and heading in rad now; copy what you want to keep
    images : (R, H, W), what the robots saw last; None before the first frame
    seconds : time spent so far on each part: eye, network (the controller) and physics

    Raises
    ------
    ParameterError : a world with no room for its robots, poses outside the room, a seed that is none
    ControllerError : the controller is none, or does not start
    """

    def __init__(
        self,
        world: World,
        controller: Controller,
        seed: int = 0,
        *,
        poses: NDArray[np.float64] | None = None,
        engine: str = "auto",
        eye: Views | None = None,
    ) -> None:
        require_controller(controller)
        self.world, self.controller, self.seed = world, controller, seed
        count = world.robots.count
        self.chance = Chance(seed, count)
        poses = random_poses(world, self.chance.placement) if poses is None else _checked(poses, count)
        self.pose = np.array(poses, np.float64)
        self._around = Surroundings(world, count)
        self.motion = Motion(world, poses, self.chance.robots, self.chance.motors)
        self.episodes = Episodes(world, self._around)
        self._require_room()
        self.eye: Views = eye or Eye(build_scene(world, self.chance.texture), world.camera, engine=engine)
        self._own = np.arange(count, dtype=np.int32)
        self._save_ticks = max(1, round(SAVE_EVERY_S * world.camera.rate_hz))
        self.history = History(math.ceil(world.scoring.back_s * world.camera.rate_hz) + self._save_ticks + 2, count)
        self._keeper = controller if keeps_state(controller) else None
        self.tick_count = 0
        self._exposure = Exposure(world, count)
        self.images: NDArray[np.uint8] | None = None
        self.seconds = {"eye": 0.0, "network": 0.0, "physics": 0.0}
        try:
            controller.start(count, self.chance.controller)
        except Exception as error:
            raise ControllerError(
                f"controller {type(controller).__name__}, at the start: raised {type(error).__name__}: {error}"
            ) from error

    @property
    def time_s(self) -> float:
        """Time of the coming frame."""
        return self.tick_count / self.world.camera.rate_hz

    @property
    def robots(self) -> NDArray[Any]:
        """Where the robots are and what they do now, (R,) ROBOT_DTYPE."""
        table = np.empty(len(self.pose), ROBOT_DTYPE)
        table["x_cm"], table["y_cm"], table["heading_rad"] = self.pose.T
        table["speed_cm_s"], table["phase"] = self.motion.speeds_cm_s, self.motion.phases
        table["distance_cm"] = self.motion.distances_cm
        return table

    def tick(self) -> Tick:
        """Go through one tick and say what happened.

        Raises
        ------
        ControllerError : the controller raised or returned nonsense; the robots have not moved then
        """
        start = perf_counter()
        self._save_states()
        saved = perf_counter()
        images, turning = self.see(), self.motion.turning
        seen = perf_counter()
        said = decide(self.controller, images, self.time_s, turning, self.tick_count)
        decided = perf_counter()
        avoiding = said & ~turning
        contacts = self.move(avoiding)
        self.seconds["eye"] += seen - saved
        self.seconds["network"] += decided - seen + saved - start
        self.seconds["physics"] += perf_counter() - decided
        return Tick(avoiding, contacts)

    def see(self) -> NDArray[np.uint8]:
        """Return what the robots see now (R, H, W), without going on."""
        self._save_states()
        keys, light = self.chance.keys(self.tick_count), self._exposure.at(self.time_s)
        self.images = self.eye.views(self.pose, self.pose, own=self._own, keys=keys, light=light)
        return self.images

    def move(self, avoiding: Bools) -> tuple[Contact, ...]:
        """Go through one tick in which the robots ``avoiding`` (R,) begin to stop and turn; return the new contacts."""
        motion, around = self.motion, self._around
        potentials = getattr(self.controller, "potentials", None)
        self.history.add(self.tick_count, self.pose, motion.codes, self._exposure.now, potentials)
        if self.images is not None:
            self._exposure.follow(self.images)
        if avoiding.any():
            motion.avoid(np.flatnonzero(avoiding).tolist())
        chords = motion.chords()
        near = around.near(motion.places_cm, chords)
        if not near:
            motion.advance()
            self._arrive()
            return ()
        shares, touches = around.hold_up(near, motion.places_cm, chords)
        motion.advance(shares)
        contacts = []
        for robot, column, share, direction_rad in touches:
            if self.episodes.begin(robot, column):
                time_s = (self.tick_count + share) * self.world.tick_s
                contacts.append(Contact(robot, around.code(column), time_s, direction_rad, motion.headings_rad[robot]))
        for robot, column, _, _ in touches:
            motion.avoid([robot, column] if column < around.robots else [robot])
        self._arrive()
        return tuple(contacts)

    def past(self, robot: int, since_s: float | None = None) -> Past:
        """Return what ``robot`` saw from ``since_s`` or more before its last frame up to that frame.

        ``since_s`` is at most, and by default, ``world.scoring.back_s``. Near the start of the run it is what there is.
        """
        rate = self.world.camera.rate_hz
        back_s = self.world.scoring.back_s if since_s is None else since_s
        last = self.history.last_tick
        first, states = self.history.start_of(last - math.ceil(back_s * rate - 1e-6))
        poses, phases, light, potentials = self.history.since(first)
        turning = phases != FORWARD
        ticks = np.arange(first, last + 1)
        times_s = ticks / rate
        speeds, headings = np.where(turning[-1], 0.0, self.motion.speeds_cm_s), poses[-1, :, 2]
        return Past(
            state=None if states is None else states[robot],
            times_s=times_s,
            poses=poses,
            turning=turning,
            keys=self.chance.keys_of(ticks)[:, robot],
            light=light[:, robot],
            velocities_cm_s=speeds[:, None] * np.column_stack([np.cos(headings), np.sin(headings)]),
            potentials=None if np.isnan(potentials).all() else potentials,
            first_tick=first,
        )

    def snapshot(self) -> dict[str, Any]:
        """Return everything the rest of the run depends on, for ``resume`` and for ``snapshot.save_snapshot``.

        Raises
        ------
        ControllerError : the controller does not keep its state
        """
        keeper = self._require_keeper()
        return {
            "world": settings_hash(self.world),
            "seed": int(self.seed),
            "tick": self.tick_count,
            "motion": copy.deepcopy(self.motion.state()),
            "episodes": self.episodes.state(),
            "history": self.history.state(),
            "gains": self._exposure.gains.copy(),
            "controller": [copy.deepcopy(keeper.state(robot)) for robot in range(len(self.pose))],
        }

    def resume(self, snapshot: Mapping[str, Any]) -> Self:
        """Continue from a ``snapshot`` of the same world and seed, and return this simulation.

        Raises
        ------
        ParameterError : it belongs to another world or seed
        ControllerError : the controller does not keep its state
        """
        keeper = self._require_keeper()
        for name, own in (("world", settings_hash(self.world)), ("seed", int(self.seed))):
            if snapshot[name] != own:
                raise ParameterError(f"snapshot of {name} {snapshot[name]}: must be of {own}, that of this simulation")
        self.tick_count = int(snapshot["tick"])
        self.motion.set_state(snapshot["motion"])
        self.episodes.set_state(snapshot["episodes"])
        self.history.set_state(snapshot["history"])
        self._exposure.gains = np.array(snapshot["gains"])
        for robot, state in enumerate(snapshot["controller"]):
            keeper.set_state(robot, state)
        self._take_poses()
        return self

    def _save_states(self) -> None:
        tick = self.tick_count
        if self._keeper and tick % self._save_ticks == 0 and not self.history.has_saved(tick):
            self.history.save(tick, [self._keeper.state(robot) for robot in range(len(self.pose))])

    def _arrive(self) -> None:
        """End the tick."""
        self._take_poses()
        self.episodes.step(self.motion.places_cm)
        self.tick_count += 1

    def _take_poses(self) -> None:
        for r, (place, heading) in enumerate(zip(self.motion.places_cm, self.motion.headings_rad, strict=True)):
            self.pose[r, 0], self.pose[r, 1], self.pose[r, 2] = place.real, place.imag, heading

    def _require_room(self) -> None:
        for robot, column in product(range(self._around.robots), range(self._around.wall + 1)):
            if robot != column and self._around.gap_cm(self.motion.places_cm, robot, column) < 0:
                raise ParameterError(
                    f"poses[{robot}] = {self.pose[robot].tolist()}: must lie inside the room, {self.world.room_text}, "
                    f"clear of the other robots and of obstacles"
                )

    def _require_keeper(self) -> KeepsState:
        if self._keeper is None:
            raise ControllerError(
                f"controller {type(self.controller).__name__}: has no state() and set_state(): both are needed to save "
                "or resume a run"
            )
        return self._keeper


def _checked(poses: Any, robots: int) -> NDArray[np.float64]:
    a = np.asarray(poses, np.float64)
    if a.shape != (robots, 3) or not np.isfinite(a).all():
        raise ParameterError(f"poses: shape {a.shape}: must be ({robots}, 3) finite numbers, x, y and heading of each")
    return a
