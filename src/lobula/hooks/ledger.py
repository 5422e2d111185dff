"""What became of the messages of one hook: counts that add up, and news of trouble, told once."""

from __future__ import annotations

import re
import threading

from ..runtime.events import Record
from .hook import RefusedError
from .mailbox import Mailbox, Parcel

TOO_SLOW = "does not keep up: the oldest records are left out"
TOO_LATE = "not delivered before the end"


class Ledger:
    """Written by the run's thread and by the hook's; every message ends up as sent or as dropped, never as both.

    The news are records: one when trouble starts, one when it is over and the hook has caught up. In between failures
    are only counted.
    """

    def __init__(self, name: str, mailbox: Mailbox) -> None:
        self._name = name
        self._mailbox = mailbox
        self._lock = threading.Lock()  # taken before the mailbox's own
        self._news: list[Record] = []
        self._sent = self._failures = self._given_up = 0
        self._in_hand = False  # taken out of the mailbox, and nobody knows yet what becomes of it
        self._problem: str | None = None  # what is being told, until it is over
        self._last_problem: str | None = None
        self._before = (0, 0)  # failures and drops when the trouble started

    def take(self) -> Parcel | None:
        """Wait for the next message and take it in hand; None when none will come."""
        parcel = self._mailbox.take()
        with self._lock:
            self._in_hand = parcel is not None
        return parcel

    def put_back(self, parcel: Parcel) -> None:
        """Return what is in hand to its place in the mailbox."""
        with self._lock:
            if self._in_hand:  # else time was up, and it counts as dropped
                self._mailbox.put_back(parcel)
                self._in_hand = False

    def succeed(self) -> None:
        """What was in hand has been sent."""
        caught_up = not len(self._mailbox)
        with self._lock:
            self._sent += self._in_hand
            self._in_hand = False
            if self._problem is not None and caught_up:
                self._problem = None
                failures, dropped = self._before
                self._news.append({
                    "type": "hook", "hook": self._name, "phase": "end",
                    "failures": self._failures - failures, "dropped": self._dropped() - dropped,
                })  # fmt: skip

    def fail(self, error: Exception) -> None:
        """A try has failed; another one is to come."""
        with self._lock:
            self._tell(_reason(error))
            self._failures += 1

    def give_up(self, error: Exception) -> None:
        """A try has failed, and what was in hand is not tried again."""
        with self._lock:
            self._tell(_reason(error))
            self._failures += 1
            self._given_up += self._in_hand
            self._in_hand = False

    def overflow(self) -> None:
        """The mailbox had no room for all that came."""
        with self._lock:
            self._tell(TOO_SLOW)

    def settle(self) -> None:
        """The time is up: what was not sent is dropped."""
        with self._lock:
            lost = self._mailbox.empty() + self._in_hand
            self._given_up += self._in_hand
            self._in_hand = False
            if lost:
                self._tell(TOO_LATE)

    def news(self) -> list[Record]:
        """Return what is to be told since the last call, oldest first."""
        with self._lock:
            news, self._news = self._news, []
        return news

    def tally(self) -> Record:
        """Return ``hook, sent, dropped, failures``, and the last ``problem`` if there was any."""
        with self._lock:
            problem = {} if self._last_problem is None else {"problem": self._last_problem}
            counts = {"sent": self._sent, "dropped": self._dropped(), "failures": self._failures}
            return {"hook": self._name} | counts | problem

    def _tell(self, problem: str) -> None:
        """Take note of trouble, and of its start if there was none; the lock is held."""
        if self._problem is None or problem not in (TOO_SLOW, TOO_LATE):  # what follows from a cause does not hide it
            self._last_problem = problem
        if self._problem is None:
            self._problem = problem
            self._before = (self._failures, self._dropped())
            self._news.append({"type": "hook", "hook": self._name, "phase": "start", "problem": problem})

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
    text = re.sub(r"_ssl\.c:\d+: | \(_ssl\.c:\d+\)", "", text)  # where in Python's own source it was noticed
    return next(iter(text.splitlines()), type(error).__name__)
