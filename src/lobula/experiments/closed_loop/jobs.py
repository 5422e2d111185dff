"""A job: one model in one world with one seed. Its result is a file of its own, so nothing finished is done twice."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from ...arena.controller import Controller
from ...arena.controls import AlwaysTurn, NeverTurn, RandomTurn
from ...arena.network_controller import NetworkController
from ...arena.running import run
from ...arena.scoring import Score, counts
from ...arena.snapshot import load_snapshot, save_snapshot
from ...arena.world import World
from ...errors import ParameterError
from ...model.network import NetworkParams
from ...params import settings_hash

KIND = "lobula arena job 1"
"""What a job's file says it is."""


@dataclass(frozen=True)
class Control:
    """A controller that does not look; ``rate_per_min`` is for the kind "random"."""

    kind: str
    rate_per_min: float = 0.0

    def controller(self) -> Controller:
        """Return the controller itself."""
        if self.kind == "random":
            return RandomTurn(self.rate_per_min)
        return {"always": AlwaysTurn, "never": NeverTurn}[self.kind]()


@dataclass(frozen=True, kw_only=True)
class Job:
    """What is to be run.

    name : of its file, different from that of every other job in the folder
    model : what drives the robots, in words that several jobs share
    driver : the settings of the network, or a control
    """

    name: str
    model: str
    world: World
    seed: int
    minutes: float
    driver: NetworkParams | Control

    @property
    def robots(self) -> int:
        """Robots in the room."""
        return self.world.robots.count

    @property
    def driver_hash(self) -> str:
        """What the driver was, for tables and for the check of what was run before."""
        if isinstance(self.driver, Control):
            return f"{self.driver.kind} {self.driver.rate_per_min:.6g}"
        return settings_hash(self.driver)

    def identity(self, code: str) -> dict[str, Any]:
        """Return everything the result depends on; ``code`` is the hash of the code."""
        return {
            "world": settings_hash(self.world),
            "driver": self.driver_hash,
            "seed": self.seed,
            "minutes": self.minutes,
            "code": code,
        }

    def controller(self) -> Controller:
        """Return a new controller."""
        return self.driver.controller() if isinstance(self.driver, Control) else NetworkController(self.driver)


@dataclass(frozen=True, kw_only=True, eq=False)
class Done:
    """A finished job: its score, its events (EVENT_DTYPE) and the seconds spent on each part."""

    job: Job
    score: Score
    events: NDArray[Any]
    seconds: Mapping[str, float]


def result_path(job: Job, folder: Path) -> Path:
    """Return where the result of ``job`` lies."""
    return folder / f"{job.name}.npz"


def work(job: Job, folder: Path, code: str, tick: Callable[[], None] | None = None) -> None:
    """Run ``job`` and write its result into ``folder``; ``tick`` is called once a simulated second.

    Interrupted, it leaves a checkpoint from which the next call goes on to the same result.

    Raises
    ------
    RunInterrupted : a signal came
    OutputError : the result cannot be written
    """
    checkpoint = folder / f"{job.name}.{code}.checkpoint"
    done = run(
        job.world,
        job.controller(),
        minutes=job.minutes,
        seed=job.seed,
        checkpoint=checkpoint,
        resume=checkpoint if checkpoint.exists() else None,
        progress=None if tick is None else lambda minutes, whole: tick(),
    )
    save_snapshot(
        result_path(job, folder),
        {
            "kind": KIND,
            "identity": job.identity(code),
            "events": done.events,
            "robot_minutes": done.score.robot_minutes,
            "distance_cm": done.score.distance_cm,
            "rule": done.score.rule,
            "seconds": dict(done.seconds),
        },
        compressed=True,
    )
    checkpoint.unlink(missing_ok=True)


def finished(job: Job, folder: Path, code: str) -> Done | None:
    """Return the result of ``job`` that lies in ``folder``; None: there is none.

    Raises
    ------
    ParameterError : it was made with other settings, or by other code
    """
    path = result_path(job, folder)
    if not path.exists():
        return None
    kept, own = load_snapshot(path), job.identity(code)
    if kept.get("kind") != KIND:
        raise ParameterError(f"{path}: is no result of an arena job")
    for name, value in own.items():
        if kept["identity"][name] != value:
            raise ParameterError(
                f"{path}: was made with {name} {kept['identity'][name]}, not {value}: must go on as it began, "
                "or into another folder"
            )
    score = counts(
        kept["events"], robot_minutes=kept["robot_minutes"], distance_cm=kept["distance_cm"], rule=kept["rule"]
    )
    return Done(job=job, score=score, events=kept["events"], seconds=kept["seconds"])
