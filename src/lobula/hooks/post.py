"""Carries messages to one hook in a thread of its own: whatever the hook does, the run neither waits nor fails."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np

from ..runtime.events import Record
from ..runtime.sinks import Picture
from ..types import Reading
from .hook import Hook, RefusedError
from .mailbox import Mailbox
from .message import Message, reading_told, told
from .pace import Pace

RETRY_S, LONGEST_RETRY_S = 0.5, 30.0
"""First and longest wait before a lost peer is tried again; each wait is twice the one before."""

LAST_TRIES = 2
"""Failures in a row after which a hook is given up once the run is over: a link that broke unseen is made anew."""

TOO_SLOW = "does not keep up: the oldest records are left out"
TOO_LATE = "not delivered before the end"


class Post:
    """Queue, thread, counts and news of one hook.

    The thread starts with the first frame or event, so a request that is refused reaches nobody. ``news`` holds what
    is to be told: a record when trouble starts, one when it is over; in between failures are only counted.
    """

    def __init__(self, hook: Hook, readings_hz: float | None = None, retry_s: float = RETRY_S) -> None:
        self.hook = hook
        self._readings = Pace(hook.readings_hz if readings_hz is None else readings_hz)
        self._pictures = Pace(hook.pictures_hz)
        self._carries_readings = "reading" in hook.kinds
        self._mailbox = Mailbox(hook.events_kept, hook.readings_kept)
        self._first_retry_s = self._retry_s = retry_s
        self._header: Record = {}
        self._thread: threading.Thread | None = None
        self._connected = False
        self._lock = threading.Lock()  # both threads write the counts and the news; taken before the mailbox's own
        self._news: list[Record] = []
        self._sent = self._failures = self._given_up = 0
        self._in_hand = False
        self._problem: str | None = None  # what is being told, until it is over
        self._last_problem: str | None = None
        self._before = (0, 0)  # failures and drops when the trouble started

    def open(self, header: Mapping[str, Any]) -> None:
        """Take note of the header and let the hook say now what can never work."""
        self._header = dict(header)
        self.hook.check()

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Queue a reading, if one is due."""
        self._begin()
        if not self._carries_readings or not self._readings.due(reading.time_s):
            return
        wanted = picture is not None and self._pictures.due(reading.time_s)
        shown = np.array(picture()) if wanted and picture is not None else None  # a copy: it is valid in this call only
        self._put(reading_told(index, reading, shown))

    def event(self, record: Mapping[str, Any]) -> None:
        """Queue an event."""
        self._begin()
        self._put(told("event", record))

    def finish(self, summary: Mapping[str, Any]) -> None:
        """Queue the summary and say that nothing more will come."""
        if self._thread is not None:
            self._put(told("summary", summary))
        self._mailbox.close()

    def wait(self, duration_s: float) -> None:
        """Wait up to ``duration_s`` for what is queued to be delivered; what is left then is given up and counted."""
        if self._thread is None:
            return
        self._thread.join(duration_s)
        with self._lock:
            lost = self._mailbox.empty()
            if self._in_hand:
                self._in_hand = False
                self._given_up += 1
                lost += 1
            if lost:
                self._tell(TOO_LATE)
        if self._thread.is_alive():
            with suppress(Exception):
                self.hook.abort()

    def news(self) -> list[Record]:
        """Return what has happened since the last call, oldest first."""
        with self._lock:
            news, self._news = self._news, []
        return news

    def tally(self) -> Record:
        """Return what became of the messages: ``hook, sent, dropped, failures``, and the last ``problem`` if any."""
        with self._lock:
            problem = {} if self._last_problem is None else {"problem": self._last_problem}
            return {
                "hook": self.hook.name, "sent": self._sent, "dropped": self._dropped(), "failures": self._failures,
            } | problem  # fmt: skip

    def _begin(self) -> None:
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, name=f"lobula hook {self.hook.name}", daemon=True)
            self._thread.start()

    def _put(self, message: Message) -> None:
        if self.hook.wants(message) and self._mailbox.put(message):
            with self._lock:
                self._tell(TOO_SLOW)

    def _work(self) -> None:
        """Run in the thread: deliver until the mailbox is closed and empty, or closed and the peer away."""
        while not self._connect() and not self._mailbox.closing:
            self._back_off()
        tries = LAST_TRIES
        while tries and (parcel := self._mailbox.take()) is not None:
            self._in_hand = True
            if self._deliver(parcel.message):
                tries = LAST_TRIES
                continue
            with self._lock:
                self._mailbox.put_back(parcel)
                self._in_hand = False
            if self._mailbox.closing:
                tries -= 1
            else:
                self._back_off()
        self._disconnect()

    def _back_off(self) -> None:
        self._mailbox.pause(self._retry_s)
        self._retry_s = min(2 * self._retry_s, LONGEST_RETRY_S)

    def _connect(self) -> bool:
        if self._connected:
            return True
        try:
            self.hook.connect(self._header)
        except Exception as error:
            self._disconnect()
            self._failed(error)
            return False
        self._connected = True
        return True

    def _disconnect(self) -> None:
        self._connected = False
        with suppress(Exception):
            self.hook.disconnect()

    def _deliver(self, message: Message) -> bool:
        """Try to hand over ``message`` and return whether it is done with, for good or for bad."""
        if not self._connect():
            return False
        try:
            self.hook.send(message)
        except RefusedError as error:
            self._give_up(error)
        except OSError as error:
            self._disconnect()
            self._failed(error)
            return False
        except Exception as error:  # a fault of the hook or its library: what it chokes on is not tried again
            self._disconnect()
            self._give_up(error)
        else:
            self._succeeded()
        return True

    def _succeeded(self) -> None:
        self._retry_s = self._first_retry_s
        caught_up = not len(self._mailbox)
        with self._lock:
            self._sent += self._in_hand  # else time was up, and it counts as dropped
            self._in_hand = False
            if self._problem is not None and caught_up:
                self._problem = None
                failures, dropped = self._before
                self._news.append(
                    {"type": "hook", "hook": self.hook.name, "phase": "end",
                     "failures": self._failures - failures, "dropped": self._dropped() - dropped}
                )  # fmt: skip

    def _failed(self, error: Exception) -> None:
        with self._lock:
            self._tell(_reason(error))
            self._failures += 1

    def _give_up(self, error: Exception) -> None:
        self._failed(error)
        with self._lock:
            self._given_up += self._in_hand
            self._in_hand = False

    def _tell(self, problem: str) -> None:
        """Take note of trouble, and of its start if there was none; the lock is held."""
        if self._problem is None or problem not in (TOO_SLOW, TOO_LATE):  # what follows from a cause does not hide it
            self._last_problem = problem
        if self._problem is None:
            self._problem = problem
            self._before = (self._failures, self._dropped())
            self._news.append({"type": "hook", "hook": self.hook.name, "phase": "start", "problem": problem})

    def _dropped(self) -> int:
        return self._mailbox.dropped + self._given_up


def _reason(error: Exception) -> str:
    """Return in a few words what went wrong: what the system says of an error, or its own text."""
    if isinstance(error, OSError):
        text = error.strerror or str(error)
    elif isinstance(error, RefusedError):
        text = str(error)
    else:
        text = f"{type(error).__name__}: {error}"
    return next(iter(text.splitlines()), type(error).__name__)
