"""A process that does clips for as long as there are any; it starts once and ends with the process that started it."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing import parent_process
from multiprocessing.connection import Connection, wait
from multiprocessing.resource_tracker import ensure_running

from ..errors import LobulaError
from ..runtime.interrupts import Interrupted
from .work import Desk

ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
"""The processes are what is parallel: threads in each of them would only stand in each other's way."""

STOPPING = (signal.SIGINT, signal.SIGTERM)
"""A terminal sends these to all processes: the one that started the workers decides what comes of them."""

READY = "ready"


@contextmanager
def starting_workers() -> Iterator[None]:
    """Make the surroundings for processes that are started meanwhile: one thread each, ``STOPPING`` blocked."""
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


def serve(line: Connection) -> None:
    """Take a request from ``line``, then clips, and answer each; an error that ends the batch is an answer as well.

    The process is started within ``starting_workers``, so that no signal meets it unprepared.
    """
    for number in STOPPING:
        signal.signal(number, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, STOPPING)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with suppress(EOFError, ConnectionError, Interrupted):  # nobody waits for an answer
        try:
            _work(line)
        except LobulaError as error:
            line.send(error)


def _work(line: Connection) -> None:
    desk = Desk(line.recv())
    line.send(READY)
    while True:
        line.send(desk.do(line.recv()))


def _end_with_parent() -> None:
    """End this process at once when its parent has: nobody is left to take an answer."""
    parent = parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)
