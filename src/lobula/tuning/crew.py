"""Measuring in several processes: each has the task, is handed settings, and hands back what they achieved."""

from __future__ import annotations

import os
import time
import traceback
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from types import TracebackType
from typing import Any, NamedTuple, Self

from ..arena.running import RunInterrupted
from ..errors import LobulaError, OutputError
from ..model.network import NetworkParams
from ..runtime.interrupts import Interrupted
from ..workers import begin_worker, starting_workers
from .tally import Tally
from .task import Task


class Job(NamedTuple):
    """Settings to be measured on the things ``names``; ``key`` says whose they are."""

    key: Any
    params: NetworkParams
    names: Sequence[str]


class Measured(NamedTuple):
    """What came of a job: its tally, or in ``problem`` why there is none; and the processor time it took, s."""

    job: Job
    tally: Tally | None
    problem: str
    seconds: float


class Crew:
    """A context in which jobs are measured, in this process or in ``workers`` others.

    The others are ended with the context, whatever they are at; they hold nothing that could be lost.
    """

    def __init__(self, task: Task, workers: int) -> None:
        self._task, self._workers = task, workers
        self._context = get_context("spawn")
        self._idle: list[Connection] = []
        self._processes: list[Any] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for process in self._processes:
            process.kill()
        for process in self._processes:
            process.join()

    def measure(self, jobs: Iterable[Job]) -> Iterator[Measured]:
        """Yield what comes of each job, as they are done; the next job is taken when somebody is free for it.

        Raises
        ------
        OutputError : a worker was killed
        """
        if self._workers == 1:
            for job in jobs:
                yield _measured(self._task, job)
            return
        left = iter(jobs)
        busy: dict[Connection, Job] = {}
        while self._hand_out(left, busy) or busy:
            for ready in wait(list(busy)):
                assert isinstance(ready, Connection)
                job = busy.pop(ready)
                try:
                    tally, problem, seconds, fault = ready.recv()
                except EOFError as error:
                    raise OutputError("a worker was killed; what was finished by then is kept") from error
                if fault:
                    raise RuntimeError(f"a worker failed:\n{fault}")
                self._idle.append(ready)
                yield Measured(job, tally, problem, seconds)

    def _hand_out(self, left: Iterator[Job], busy: dict[Connection, Job]) -> bool:
        """Give jobs to those who are free; return whether any was given."""
        given = False
        while len(busy) < self._workers:
            job = next(left, None)
            if job is None:
                break
            connection = self._idle.pop() if self._idle else self._new()
            with suppress(BrokenPipeError):  # a dead one is found when its answer is waited for
                connection.send((job.params, job.names))
            busy[connection] = job
            given = True
        return given

    def _new(self) -> Connection:
        here, there = self._context.Pipe()
        process = self._context.Process(target=_work, args=(there, self._task), daemon=True)
        with starting_workers():
            process.start()
        there.close()
        self._processes.append(process)
        return here


def _measured(task: Task, job: Job) -> Measured:
    begun = time.process_time()
    try:
        tally, problem = task.measure(job.params, job.names), ""
    except RunInterrupted as stop:
        raise Interrupted(stop.number) from None
    except LobulaError as error:
        return Measured(job, None, str(error), time.process_time() - begun)
    return Measured(job, tally, problem, time.process_time() - begun)


def _work(connection: Connection, task: Task) -> None:
    """Measure what comes until nobody is at the other end."""
    os.setsid()  # Ctrl-C of the terminal goes to the one who asks, who ends this process
    begin_worker()
    warnings.simplefilter("ignore")  # said once, by the one who asks
    with suppress(EOFError, BrokenPipeError, Interrupted):
        while True:
            params, names = connection.recv()
            try:
                _, tally, problem, seconds = _measured(task, Job(None, params, names))
            except Exception:
                connection.send((None, "", 0.0, traceback.format_exc()))
            else:
                connection.send((tally, problem, seconds, ""))
