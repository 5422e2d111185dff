"""What a search is asked for, and what came of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ..errors import ParameterError
from ..model.network import NetworkParams
from ..workers import check_workers
from .journal import Trial
from .space import Axis, settings_at
from .task import Task

TRIALS = 100
MOST_TRIALS = 100_000
MOST_MINUTES = 100_000.0


@dataclass(frozen=True, kw_only=True)
class Budget:
    """How long a search goes on, and with what.

    trials, minutes : until each search has so many trials, those of earlier calls included; until this call has taken
        so long. ``TRIALS`` where neither is given
    workers : processes
    seed : of the search's own chance; the outcome hangs on it and on nothing else here but ``trials`` and ``minutes``
    """

    trials: int | None = None
    minutes: float | None = None
    workers: int = 1
    seed: int = 0

    def __post_init__(self) -> None:
        if self.trials is not None and not 1 <= self.trials <= MOST_TRIALS:
            raise ParameterError(f"{self.trials} trials: must be 1 to {MOST_TRIALS}")
        if self.minutes is not None and not 0 < self.minutes <= MOST_MINUTES:
            raise ParameterError(f"{self.minutes:g} minutes: must be above 0 and at most {MOST_MINUTES:g}")
        check_workers(self.workers)
        if self.seed < 0:
            raise ParameterError(f"seed {self.seed}: must be 0 or more")

    @property
    def most(self) -> int:
        """Trials of each search."""
        return self.trials or (TRIALS if self.minutes is None else MOST_TRIALS)


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What is asked for.

    base : the settings that the search begins with, from which all come that are not searched; ``preset`` names them
    """

    task: Task
    base: NetworkParams
    preset: str
    axes: tuple[Axis, ...]
    budget: Budget

    def settings(self, trial: Trial) -> NetworkParams:
        """Return the settings of ``trial``."""
        return settings_at(self.base, trial.values, f"lobula tune on {self.task.about['on']}, trial {trial.number}")


@dataclass
class Speed:
    """What the measuring of this call took: ``seconds`` by the clock, ``processor_s`` in all workers together."""

    trials: int = 0
    seconds: float = 0.0
    processor_s: float = 0.0
    footage_s: float = 0.0

    @property
    def trials_per_s(self) -> float | None:
        """Trials a second, all workers together; None where nothing was measured."""
        return self.trials / self.seconds if self.seconds else None

    @property
    def times_real_time(self) -> float | None:
        """Footage that one core looks at in a second, s."""
        return self.footage_s / self.processor_s if self.processor_s else None


class Scored(NamedTuple):
    """Settings on one part: the objectives and the tally."""

    values: tuple[float, ...]
    about: Mapping[str, Any]


@dataclass(frozen=True, kw_only=True)
class Found:
    """What came of a plan.

    Attributes
    ----------
    trials : by search, all that were measured or given up
    front : of the first search, those that no other one beats in every objective
    best : of the front, the one with the most merit
    held_out : of each trial of the front, by number, where the search holds something out; else empty
    cross_validated : of the settings that each of the other searches chose, where there are any
    preset : the settings the search began with, on what was searched on and on what was held out
    """

    plan: Plan
    identity: Mapping[str, Any]
    trials: Mapping[str, Sequence[Trial]]
    front: Sequence[Trial]
    best: Trial
    held_out: Mapping[int, Scored]
    cross_validated: Scored | None
    preset: Scored
    preset_held_out: Scored | None
    chosen: Mapping[str, Trial]
    speed: Speed = field(default_factory=Speed)
