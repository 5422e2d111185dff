"""Calls made in a thread of their own, in order: one that waits for a slow reader holds nobody else up."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable

MOST_WAITING = 4096
"""Calls that wait, more than an hour of events; then the oldest go, and count as lost."""

PATIENCE_S = 2.0
"""How long ``close`` waits for what is left."""


class Courier:
    """Takes calls and makes them elsewhere. ``lost`` counts those that never were made.

    The first call that fails is the last one: ``error`` is what it raised.
    """

    def __init__(self, name: str, most: int = MOST_WAITING) -> None:
        self._name = name
        self._most = most
        self._changed = threading.Condition()
        self._waiting: deque[Callable[[], object]] = deque()
        self._thread: threading.Thread | None = None
        self._closing = False
        self.lost = 0
        self.error: Exception | None = None

    def send(self, call: Callable[[], object]) -> None:
        """Have ``call`` made when its turn comes; returns at once."""
        with self._changed:
            if self._closing or self.error is not None:
                return
            self._waiting.append(call)
            if len(self._waiting) > self._most:
                self._waiting.popleft()
                self.lost += 1
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name=f"lobula {self._name}", daemon=True)
                self._thread.start()
            self._changed.notify_all()

    def close(self, patience_s: float = PATIENCE_S) -> None:
        """Wait for what is left; what takes longer than ``patience_s`` is given up and counts as lost."""
        with self._changed:
            self._closing = True
            self._changed.notify_all()
        if self._thread is None:
            return
        self._thread.join(patience_s)
        with self._changed:
            if self._thread.is_alive():
                self.lost += 1 + len(self._waiting)  # the one that is being made, and those behind it
            self._waiting.clear()

    def _work(self) -> None:
        """Run in the thread: make calls until there are no more."""
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting or self._closing)
                if not self._waiting:
                    return
                call = self._waiting.popleft()
            try:
                call()
            except Exception as error:  # travels to whoever sends: this thread has nobody to tell
                with self._changed:
                    self.error = error
                    self._waiting.clear()
                return
