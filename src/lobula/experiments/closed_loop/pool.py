"""Jobs in several processes. The results are the same for any number of them; what is finished stays finished."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from ...arena.running import RunInterrupted
from ...errors import OutputError
from ...landing import writing
from ...runtime.interrupts import Interrupted
from ...workers import check_workers
from .code_hash import code_hash
from .jobs import Done, Job, finished, work

_stop: list[Any] = []
"""In a worker: the event that tells it to stop."""


def run_jobs(
    jobs: Sequence[Job], folder: Path, *, workers: int = 1, advance: Callable[[], None] | None = None
) -> list[Done]:
    """Run those of ``jobs`` whose results are not yet in ``folder``, and return the results of all, in their order.

    ``advance`` is called for each job that is there or gets finished.

    Raises
    ------
    ParameterError : a result in the folder was made with other settings or by other code; workers out of range
    Interrupted : a signal came; every run under way has left a checkpoint
    OutputError : a result cannot be written
    """
    check_workers(workers)
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    code, step = code_hash(), advance or (lambda: None)
    found = {job.name: finished(job, folder, code) for job in jobs}
    left = [job for job in jobs if found[job.name] is None]
    for _ in range(len(jobs) - len(left)):
        step()
    if workers == 1 or len(left) <= 1:
        _one_by_one(left, folder, code, step)
    else:
        _side_by_side(left, folder, code, min(workers, len(left)), step)
    results = [found[job.name] or finished(job, folder, code) for job in jobs]
    return [result for result in results if result is not None]


def _one_by_one(jobs: Sequence[Job], folder: Path, code: str, step: Callable[[], None]) -> None:
    for job in jobs:
        try:
            work(job, folder, code)
        except RunInterrupted as stop:
            raise Interrupted(stop.number) from None
        step()


def _side_by_side(jobs: Sequence[Job], folder: Path, code: str, workers: int, step: Callable[[], None]) -> None:
    context = get_context("spawn")
    stop = context.Event()
    with ProcessPoolExecutor(workers, context, _begin, (stop,)) as pool:
        try:
            longest_first = sorted(jobs, key=lambda job: -job.robots * job.minutes)  # so that all end together
            for future in as_completed([pool.submit(_work, job, folder, code) for job in longest_first]):
                if not future.result():
                    raise Interrupted(signal.SIGINT)
                step()
        except BrokenProcessPool as error:
            raise OutputError(f"{folder}: a worker was killed; what was finished by then is there") from error
        except BaseException:
            stop.set()  # those under way write a checkpoint; the pool waits for them
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _begin(stop: Any) -> None:
    """Make a worker ready: Ctrl-C reaches it from the terminal too, but a run must end between two ticks."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _stop.append(stop)


def _work(job: Job, folder: Path, code: str) -> bool:
    """Run a job in a worker; return whether it was finished."""
    (stop,) = _stop
    if stop.is_set():
        return False
    try:
        work(job, folder, code, partial(_end_if_told, stop))
    except RunInterrupted:
        return False
    return True


def _end_if_told(stop: Any) -> None:
    """Signal this process once, as a user would: the run then ends between two ticks, with a checkpoint."""
    if stop.is_set() and signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL:
        os.kill(os.getpid(), signal.SIGTERM)
