"""A process that does clips for as long as there are any; it starts once and ends with the process that started it.

Nothing heavy is imported here at the top: libraries read their number of threads when they are loaded.
"""

from __future__ import annotations

import os
import signal
import threading
from multiprocessing import parent_process
from multiprocessing.connection import Connection, wait

from ..errors import LobulaError
from ..runtime.interrupts import Interrupted

ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
"""The processes are what is parallel: threads in each of them would only stand in each other's way."""

READY = "ready"


def serve(line: Connection) -> None:
    """Take a request from ``line``, then clips, and answer each; an error that ends the batch is an answer as well."""
    for number in (signal.SIGINT, signal.SIGTERM):  # the terminal sends them to all: the one process decides
        signal.signal(number, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))
    try:
        request = line.recv()
        from .work import Desk

        desk = Desk(request)
        line.send(READY)
        while True:
            line.send(desk.do(line.recv()))
    except LobulaError as error:
        line.send(error)
    except (EOFError, BrokenPipeError, Interrupted):  # nobody waits for an answer
        return


def _end_with_parent() -> None:
    """End this process at once when its parent has: nobody is left to take an answer."""
    parent = parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)
