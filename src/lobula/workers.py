"""Processes that share the work on this machine: how many there may be, how they are started, and when they end."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import parent_process
from multiprocessing.connection import wait
from multiprocessing.resource_tracker import ensure_running

from .errors import ParameterError

MOST_WORKERS = 256

ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
"""The processes are what is parallel: threads in each of them would only stand in each other's way."""

STOPPING = (signal.SIGINT, signal.SIGTERM)
"""A terminal sends these to all processes: the one that started the workers decides what comes of them."""


def cores() -> int:
    """Return how many cores this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # macOS
        return os.cpu_count() or 1


def check_workers(workers: int) -> None:
    """Check how many workers are asked for.

    Raises
    ------
    ParameterError : too few or too many
    """
    if not 1 <= workers <= MOST_WORKERS:
        raise ParameterError(f"workers = {workers}: must be 1 to {MOST_WORKERS}")


@contextmanager
def starting_workers() -> Iterator[None]:
    """Make the surroundings for processes that are started meanwhile: one thread each, ``STOPPING`` blocked.

    So no signal meets a worker before ``begin_worker``.
    """
    ensure_running()  # starting it unblocks them
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, STOPPING)
    try:
        os.environ.update(dict.fromkeys(ONE_THREAD, "1"))  # here, for libraries read it when they are loaded
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})
        signal.pthread_sigmask(signal.SIG_SETMASK, blocked)


def begin_worker() -> None:
    """In a worker: let ``STOPPING`` pass it by, and have it end at once when its parent has, in whatever way."""
    for number in STOPPING:
        signal.signal(number, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, STOPPING)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)
