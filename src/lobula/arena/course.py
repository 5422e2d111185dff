"""A run under way: it ticks, keeps snapshots of itself, goes on from one, and tells what came of it."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from numpy.typing import NDArray

from ..errors import OutputError, ParameterError
from ..params import Params, settings_hash, to_dict
from .controller import Controller, keeps_state, settings_of
from .each_robot import EachRobot
from .record import Record, Recorder
from .scorer import Scorer
from .scoring import Score
from .simulation import Simulation
from .snapshot import save_snapshot
from .world import World
from .world_file import parse_world, world_toml

KIND = "lobula arena run 1"
"""What a checkpoint says it is."""

SNAPSHOT_MINUTES = 5.0
"""Simulated time between two snapshots: what has to be done again after a failure in the middle of a tick."""

Progress = Callable[[float, float], None]
"""Called once a simulated second with the minutes done and the minutes asked for."""


@dataclass(frozen=True, eq=False)
class Run:
    """What came of a run.

    world, seed, controller : what it was made from; the controller in words
    minutes : simulated so far
    finished : whether that is all that was asked for
    score, events : what happened; events are EVENT_DTYPE
    record : every frame, where it was asked for
    seconds : time spent on eye, network, physics and scoring
    snapshot : for ``run(resume=...)``; None where the controller does not keep its state
    """

    world: World
    seed: int
    controller: str
    minutes: float
    finished: bool
    score: Score
    events: NDArray[Any]
    record: Record | None
    seconds: Mapping[str, float]
    snapshot: Mapping[str, Any] | None = field(repr=False)

    @property
    def robot_frames(self) -> int:
        """Pictures seen, of all robots together."""
        return round(self.minutes * 60 * self.world.camera.rate_hz) * self.world.robots.count


class Course:
    """A run under way: the simulation, who watches it, and the last snapshot of them all.

    It begins with ``keep`` or ``resume``; a checkpoint that is refused stays as it is.
    """

    def __init__(
        self, simulation: Simulation, minutes: float, *, record: bool, checkpoint: str | os.PathLike[str] | None
    ) -> None:
        self.simulation, self.minutes, self.checkpoint = simulation, minutes, checkpoint
        rate_hz = simulation.world.camera.rate_hz
        self.ticks = max(1, round(minutes * 60 * rate_hz))
        self.scorer = Scorer(simulation)
        self.recorder = Recorder(simulation) if record else None
        self.controller = _in_words(simulation.controller)
        self.snapshot: dict[str, Any] | None = None
        self._second, self._stretch = max(1, round(rate_hz)), max(1, round(SNAPSHOT_MINUTES * 60 * rate_hz))
        self._before: dict[str, float] = {}

    def tick(self, progress: Progress | None) -> None:
        """Go through one tick."""
        tick = self.simulation.tick()
        if self.recorder:
            self.recorder.tick(tick)
        self.scorer.tick(tick)
        done = self.simulation.tick_count
        if done % self._stretch == 0:
            self.keep()
        if progress and done % self._second == 0:
            progress(self.simulation.time_s / 60, self.minutes)

    def keep(self) -> None:
        """Take a snapshot, and write it to the checkpoint; a disk that is full does not end the run."""
        if not keeps_state(self.simulation.controller) and not self.checkpoint:
            return
        self.snapshot = {
            "kind": KIND,
            "world": world_toml(self.simulation.world),
            "seed": int(self.simulation.seed),
            "minutes": self.minutes,
            "controller": self.controller,
            "settings": settings_of(self.simulation.controller),
            "simulation": self.simulation.snapshot(),
            "scorer": self.scorer.state(),
            "record": self.recorder.state() if self.recorder else None,
            "seconds": self.seconds,
        }
        if self.checkpoint:
            try:
                save_snapshot(self.checkpoint, self.snapshot)
            except OutputError as error:
                warnings.warn(f"checkpoint: {error}; the run goes on", RuntimeWarning, stacklevel=2)

    def resume(self, kept: Mapping[str, Any]) -> None:
        """Go on from a snapshot.

        Raises
        ------
        ParameterError : it is of another world, seed or controller, or without the record that is asked for
        """
        if kept["controller"] != self.controller:
            differing = _first_difference(kept.get("settings") or {}, settings_of(self.simulation.controller) or {})
            raise ParameterError(
                f"checkpoint of {kept['controller']}: must be resumed with that, not {self.controller}{differing}"
            )
        before, now = parse_world(kept["world"], "checkpoint"), self.simulation.world
        if before != now:
            differing = _first_difference(to_dict(before), to_dict(now))
            raise ParameterError(f"checkpoint of another world: must be resumed in that{differing}")
        if self.recorder and kept["record"] is None:
            raise ParameterError("checkpoint without a record: must be resumed without one")
        self.simulation.resume(kept["simulation"])
        self.scorer.set_state(kept["scorer"])
        if self.recorder:
            self.recorder.set_state(kept["record"])
        self._before = dict(kept["seconds"])
        self.keep()

    @property
    def seconds(self) -> dict[str, float]:
        """Time spent so far on each part."""
        now = {**self.simulation.seconds, "scoring": self.scorer.seconds}
        return {part: spent + self._before.get(part, 0.0) for part, spent in now.items()}

    def result(self) -> Run:
        """Return what was done so far."""
        simulation, events = self.simulation, self.scorer.events
        finished = simulation.tick_count >= self.ticks
        return Run(
            world=simulation.world,
            seed=simulation.seed,
            controller=self.controller,
            minutes=simulation.time_s / 60,
            finished=finished,
            score=self.scorer.score(),
            events=events,
            record=self.recorder.record(events, self.controller) if self.recorder else None,
            seconds=self.seconds,
            snapshot=None if finished else self.snapshot,
        )


def _in_words(controller: Controller) -> str:
    """Return the controller's kind, the hash of its settings where it has some, and how it stores if not as floats."""
    params, storage = getattr(controller, "params", None), getattr(controller, "storage", "float")
    name = controller.name if isinstance(controller, EachRobot) else type(controller).__name__
    name += f" {settings_hash(params)}" if isinstance(params, Params) else ""
    return name if storage == "float" else f"{name} {storage}"


def _first_difference(kept: Mapping[str, Any], own: Mapping[str, Any], where: str = "") -> str:
    """Return the end of a message: the first setting of both that differs; nothing where there is none."""
    for name in (name for name in kept if name in own):
        before, now = kept[name], own[name]
        if isinstance(before, Mapping) and isinstance(now, Mapping):
            if found := _first_difference(before, now, f"{where}{name}."):
                return found
        elif before != now:
            return f": {where}{name} was {before!r}, is {now!r}"
    return ""
