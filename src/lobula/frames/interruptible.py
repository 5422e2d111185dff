"""Work that FFmpeg does without hearing signals, such as waiting for an address, done so that they are heard."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")

_WAKE_S = 0.1


def interruptible(work: Callable[[], T], let_go: Callable[[T], None]) -> T:
    """Return what ``work`` returns, or raise what it raises, from a thread of its own.

    An exception that comes meanwhile, such as that of Ctrl-C, leaves the work to itself: ``let_go`` is given what comes
    of it.
    """
    outcome: list[T] = []
    failure: list[BaseException] = []
    lock, done = threading.Lock(), threading.Event()
    left = False

    def run() -> None:
        try:
            result = work()
        except BaseException as error:
            failure.append(error)
        else:
            with lock:
                outcome.append(result)
                unwanted = left
            if unwanted:
                let_go(result)
        done.set()

    threading.Thread(target=run, name="lobula opening", daemon=True).start()
    try:
        while not done.wait(_WAKE_S):
            pass
    except BaseException:
        with lock:
            left = True
            there = list(outcome)
        for result in there:
            let_go(result)
        raise
    if failure:
        raise failure[0]
    return outcome[0]
