"""The record of a run: where every robot was in every frame, what it did and what its neurons said; and all events.

With the world and the seed in it, every picture that a robot saw can be drawn again, bit for bit.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from .chance import Chance
from .controller import settings_of
from .eye import Eye
from .scene import build_scene
from .simulation import Simulation, Tick
from .snapshot import load_snapshot, save_snapshot
from .world import World
from .world_file import parse_world, world_toml

COLUMNS = ("poses", "phases", "alarms", "light", "potentials")
PLAIN = ("seed", "controller", "settings", "speeds_cm_s", "events")


@dataclass(frozen=True, eq=False)
class Record:
    """T frames of R robots.

    world, seed : what the run was made from
    controller : what drove the robots, in words, with the hash of its settings
    settings : those settings, nested as ``params.to_dict`` gives them; None where the controller told of none
    poses : (T, R, 3) x, y in cm and heading in rad at each frame
    phases : (T, R) int8, FORWARD, STOP or TURN of ``motion``
    alarms : (T, R) bool, avoidances that began with this frame
    light : (T, R), gain on all luminance
    potentials : (T, R, 4) float32 in the order of ``NEURONS``; None where the controller has none
    speeds_cm_s : (R,)
    events : EVENT_DTYPE
    """

    world: World
    seed: int
    controller: str
    settings: Mapping[str, Any] | None
    poses: NDArray[np.float64]
    phases: NDArray[np.int8]
    alarms: NDArray[np.bool_]
    light: NDArray[np.float64]
    potentials: NDArray[np.float32] | None
    speeds_cm_s: NDArray[np.float64]
    events: NDArray[Any]

    @property
    def times_s(self) -> NDArray[np.float64]:
        """(T,), times of the frames."""
        return np.arange(len(self.poses)) / self.world.camera.rate_hz

    def views(self, robot: int, first: int = 0, last: int | None = None, *, engine: str = "auto") -> NDArray[np.uint8]:
        """Return what ``robot`` saw in frames ``first`` to ``last`` (not included), (N, H, W), drawn again.

        Raises
        ------
        ParameterError : no such robot
        """
        if not 0 <= robot < self.poses.shape[1]:
            raise ParameterError(f"robot {robot}: must be one of 0..{self.poses.shape[1] - 1}")
        poses = self.poses[first:last]
        chance = Chance(self.seed, poses.shape[1])
        ticks = np.arange(len(self.poses))[first:last]
        eye = Eye(build_scene(self.world, chance.texture), self.world.camera, engine=engine)
        return eye.views(
            poses[:, robot], poses, own=np.full(len(poses), robot), keys=chance.keys_of(ticks)[:, robot],
            light=self.light[first:last, robot],
        )  # fmt: skip

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the record to ``path``, an npz; ``load_record`` reads it.

        Raises
        ------
        OutputError : it cannot be written
        """
        tree = {name: getattr(self, name) for name in (*COLUMNS, *PLAIN)}
        save_snapshot(path, {**tree, "world": world_toml(self.world)}, compressed=True)


def load_record(path: str | os.PathLike[str]) -> Record:
    """Return the record that was saved to ``path``.

    Raises
    ------
    ParameterError : no such file, or no record
    """
    tree = load_snapshot(path)
    if set(tree) != set(Record.__dataclass_fields__):
        raise ParameterError(f"{os.fspath(path)}: is no record of an arena run")
    return Record(**{**tree, "world": parse_world(tree["world"], os.fspath(path))})


class Recorder:
    """Writes down a simulation: call ``tick`` with what each of its ticks returned."""

    def __init__(self, simulation: Simulation) -> None:
        self.simulation = simulation
        self._rows = 0
        robots = len(simulation.pose)
        self._columns: dict[str, NDArray[Any]] = {
            "poses": np.empty((0, robots, 3)),
            "phases": np.empty((0, robots), np.int8),
            "alarms": np.empty((0, robots), np.bool_),
            "light": np.empty((0, robots)),
            "potentials": np.empty((0, robots, 4), np.float32),
        }

    def tick(self, tick: Tick) -> None:
        """Take in the tick that the simulation has just gone through."""
        row, columns = self._rows, self._columns
        if row == len(columns["poses"]):
            for name, column in columns.items():
                columns[name] = np.concatenate([column, np.empty_like(column, shape=(row + 1024, *column.shape[1:]))])
        poses, phases, light, potentials = self.simulation.history.last()
        columns["poses"][row], columns["phases"][row], columns["light"][row] = poses, phases, light
        columns["alarms"][row], columns["potentials"][row] = tick.avoiding, potentials
        self._rows = row + 1

    def record(self, events: NDArray[Any], controller: str) -> Record:
        """Return the record so far, with the run's ``events``."""
        simulation, columns = self.simulation, self.state()
        if np.isnan(columns["potentials"]).all():
            columns["potentials"] = None
        return Record(
            world=simulation.world, seed=simulation.seed, controller=controller,
            settings=settings_of(simulation.controller), events=events,
            speeds_cm_s=np.array(simulation.motion.speeds_cm_s), **columns,
        )  # fmt: skip

    def state(self) -> dict[str, Any]:
        """Return a copy of what was written down so far."""
        return {name: column[: self._rows].copy() for name, column in self._columns.items()}

    def set_state(self, state: Mapping[str, Any]) -> None:
        """Go on from ``state``, which ``state()`` gave."""
        self._columns = {name: np.array(state[name]) for name in COLUMNS}
        self._rows = len(state["poses"])
