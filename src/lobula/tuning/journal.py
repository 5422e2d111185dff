"""The journal of a search: every trial on the disk as it is asked for and as it is told; needs the extra ``tune``."""

from __future__ import annotations

import fcntl
import importlib
import json
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..errors import MissingExtraError, ParameterError, pip_install
from ..landing import writing
from .space import Axis, Value
from .tally import Objective

JOURNAL = "journal.log"

ROUND = 16
"""Trials that are asked for together, before any of them is measured: none of them knows of the others, so the results
are the same for any number of workers, interrupted or not. The first round is drawn at random."""


class Trial(NamedTuple):
    """Settings that were tried: their values by path, and, once they are measured, the objectives and the tally.

    ``problem`` says why they could not be measured.
    """

    number: int
    values: Mapping[str, Value]
    objectives: tuple[float, ...] | None = None
    about: Mapping[str, Any] | None = None
    merit: float = 0.0
    problem: str = ""


def load_optuna() -> Any:
    """Return the module ``optuna``, which then says nothing but warnings.

    Raises
    ------
    MissingExtraError : it is not installed
    """
    try:
        optuna = importlib.import_module("optuna")
        importlib.import_module("optuna.storages.journal")
    except ImportError as error:
        raise MissingExtraError(f"tuning needs optuna: {pip_install('tune')}") from error
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    warnings.filterwarnings("ignore", category=optuna.exceptions.ExperimentalWarning)
    return optuna


class Journal(NamedTuple):
    """An open journal; ``writing`` names it in errors."""

    path: Path
    storage: Any


@contextmanager
def opened(folder: Path) -> Iterator[Journal]:
    """Give the journal in ``folder``, for one process at a time.

    A line that was torn when the last one ended is taken off, and so is its lock.

    Raises
    ------
    ParameterError : another process works there, or the journal is none
    OutputError : the folder cannot be written to
    """
    optuna = load_optuna()
    path = folder / JOURNAL
    with ExitStack() as stack:
        with writing(path):
            file = stack.enter_context(path.open("ab+"))
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError as error:
                raise ParameterError(f"{folder}: another search is at work there: must be another folder") from error
            Path(f"{path}.lock").unlink(missing_ok=True)
            journal = optuna.storages.journal
            try:
                _mend(file)
                storage = optuna.storages.JournalStorage(journal.JournalFileBackend(str(path)))
            except (ValueError, KeyError, TypeError) as error:  # a line that is no JSON is a ValueError
                raise ParameterError(f"{path}: is no journal of a search: must be another folder") from error
        yield Journal(path, storage)


def _mend(file: Any) -> None:
    """Take off a torn last line.

    Raises
    ------
    ValueError : the last whole line is no JSON: this is something else
    """
    file.seek(0)
    *whole, torn = bytes(file.read()).split(b"\n")
    if whole:
        json.loads(whole[-1])
    if torn:
        file.truncate(file.tell() - len(torn))


class Search:
    """One search: its trials so far, what to try next, and what was found."""

    def __init__(
        self, journal: Journal, name: str, place: int, axes: Sequence[Axis], objectives: Sequence[Objective], seed: int
    ) -> None:
        self._optuna = load_optuna()
        self.name, self._place, self._axes, self._seed = name, place, tuple(axes), seed
        self._writing = partial(writing, journal.path)
        self._distributions = {axis.path: self._distribution(axis) for axis in axes}
        with self._writing():
            self._study = self._optuna.create_study(
                storage=journal.storage, study_name=name, load_if_exists=True, sampler=self._sampler(0),
                directions=[objective.direction for objective in objectives],
            )  # fmt: skip
        for trial in self._running():
            if trial.params.keys() != self._distributions.keys():  # killed while it was being asked for
                self._end(trial.number, state=self._optuna.trial.TrialState.FAIL)

    @property
    def kept(self) -> dict[str, Any]:
        """What was kept with the search, see ``keep``."""
        return dict(self._study.user_attrs)

    def keep(self, name: str, value: Any) -> None:
        """Keep ``value``, of plain numbers, texts, lists and dictionaries, with the search."""
        with self._writing():
            self._study.set_user_attr(name, value)

    def next_round(self, most: int) -> list[Trial]:
        """Return trials that are to be measured, of those numbered below ``most``; none: the search has got there.

        A new round is asked for when the last one has been measured in full.
        """
        asked = len([t for t in self._study.get_trials(deepcopy=False) if t.state.name != "WAITING"])
        if asked % ROUND or (not self._running() and asked < most):
            self._ask(asked, ROUND - asked % ROUND)
        return [Trial(t.number, self._values(t.params)) for t in self._running() if t.number < most]

    def tell(self, number: int, objectives: Sequence[float], about: Mapping[str, Any], merit: float) -> None:
        """Write down what trial ``number`` achieved."""
        self.keep(_key(number), {"tally": about, "merit": merit})  # first: a trial told twice is refused
        self._end(number, values=list(objectives))

    def give_up(self, number: int, problem: str) -> None:
        """Write down why trial ``number`` could not be measured."""
        self.keep(_key(number), {"problem": problem})
        self._end(number, state=self._optuna.trial.TrialState.FAIL)

    def trials(self) -> list[Trial]:
        """Return all that were measured or given up, in their order."""
        kept, found = self.kept, []
        for t in self._study.get_trials(deepcopy=False):
            about = kept.get(_key(t.number), {})
            if t.state.name == "COMPLETE":
                found.append(Trial(t.number, self._values(t.params), tuple(t.values), about["tally"], about["merit"]))
            elif t.state.name == "FAIL" and "problem" in about:
                found.append(Trial(t.number, self._values(t.params), problem=about["problem"]))
        return found

    def front(self) -> list[Trial]:
        """Return those trials that no other one beats in every objective; of equal ones the first."""
        best = {t.number for t in self._study.best_trials}
        of_front = [trial for trial in self.trials() if trial.number in best]
        return list({trial.objectives: trial for trial in reversed(of_front)}.values())[::-1]

    def gains(self, trial: Trial) -> tuple[float, ...]:
        """Return the objectives of ``trial`` so that more is better."""
        signs = (1 if direction.name == "MAXIMIZE" else -1 for direction in self._study.directions)
        return tuple(sign * value for sign, value in zip(signs, trial.objectives or (), strict=True))

    def _end(self, number: int, **how: Any) -> None:
        with self._writing():
            self._study.tell(number, **how)

    def _running(self) -> list[Any]:
        return [t for t in self._study.get_trials(deepcopy=False) if t.state.name == "RUNNING"]

    def _values(self, params: Mapping[str, Value]) -> dict[str, Value]:
        return {axis.path: axis.clipped(params[axis.path]) for axis in self._axes}

    def _ask(self, first: int, count: int) -> None:
        with self._writing():
            if first == 0 and not self._study.get_trials(deepcopy=False):
                self._study.enqueue_trial({axis.path: axis.clipped(axis.start) for axis in self._axes})
            for number in range(first, first + count):
                self._study.sampler = self._sampler(number)
                self._study.ask(self._distributions)

    def _sampler(self, number: int) -> Any:
        """Return the sampler of a trial; its chance hangs on the trial's number, so a resumed search draws the same."""
        seed = int(np.random.SeedSequence([self._seed, self._place, number]).generate_state(1)[0])
        return self._optuna.samplers.TPESampler(
            seed=seed, n_startup_trials=ROUND, multivariate=True, constant_liar=True
        )

    def _distribution(self, axis: Axis) -> Any:
        kinds = self._optuna.distributions
        if axis.kind == "choice":
            return kinds.CategoricalDistribution(axis.choices)
        if axis.kind == "int":
            return kinds.IntDistribution(int(axis.low), int(axis.high), log=axis.log)
        return kinds.FloatDistribution(axis.low, axis.high, log=axis.log)


def _key(number: int) -> str:
    return f"trial {number}"
