"""Carries messages to one hook in a thread of its own: whatever the hook does, the run neither waits nor fails."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..runtime.events import Record
from ..runtime.sinks import Picture
from ..types import Reading
from .hook import Hook, RefusedError
from .ledger import Ledger
from .mailbox import Mailbox
from .message import Message, reading_told, told
from .pace import Pace

RETRY_S, LONGEST_RETRY_S = 0.5, 30.0
"""First and longest wait before a lost peer is tried again; each wait is twice the one before."""

LAST_TRIES = 2
"""Failures in a row after which a hook is given up once the run is over: a link that broke unseen is made anew."""


PICTURE_PX = 640
"""Pictures are at least this wide and less than twice as wide, or as wide as they came: some may have to wait."""


class Post:
    """The mailbox, the thread and the ledger of one hook.

    The thread starts with the first frame or event, so a request that is refused reaches nobody.
    """

    def __init__(self, hook: Hook, readings_hz: float | None = None, retry_s: float = RETRY_S) -> None:
        self._hook = hook
        self._readings = Pace(hook.readings_hz if readings_hz is None else readings_hz)
        self._pictures = Pace(hook.pictures_hz)
        self._carries_readings = "reading" in hook.kinds
        self._mailbox = Mailbox(hook.events_kept, hook.readings_kept)
        self._ledger = Ledger(hook.name, self._mailbox)
        self._first_retry_s = self._retry_s = retry_s
        self._header: Record = {}
        self._thread: threading.Thread | None = None
        self._connected = False

    def open(self, header: Mapping[str, Any]) -> None:
        """Take note of the header and let the hook say now what can never work."""
        self._header = dict(header)
        self._hook.check()

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Queue a reading, if one is due."""
        self._begin()
        if not self._carries_readings or not self._readings.due(reading.time_s):
            return
        self._put(reading_told(index, reading, self._shown(reading.time_s, picture)))

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
            self._disconnect()
            return
        self._thread.join(duration_s)
        self._ledger.settle()
        if self._thread.is_alive():
            with suppress(Exception):
                self._hook.abort()

    def news(self) -> list[Record]:
        """Return the records of trouble since the last call."""
        return self._ledger.news()

    def tally(self) -> Record:
        """Return what became of the messages, as ``Ledger.tally``."""
        return self._ledger.tally()

    def _begin(self) -> None:
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, name=f"lobula hook {self._hook.name}", daemon=True)
            self._thread.start()

    def _shown(self, time_s: float, picture: Picture | None) -> NDArray[np.uint8] | None:
        """Return a copy of the picture, if one is due; one that cannot be made is the last that is asked for."""
        if picture is None or not self._pictures.due(time_s):
            return None
        try:
            return _kept(picture())
        except Exception as error:  # the run needs no colours: it goes on, and so does the hook
            self._ledger.fail(RefusedError(f"no pictures: {error!r}"))
            self._pictures = Pace(0)
            return None

    def _put(self, message: Message) -> None:
        if self._hook.wants(message) and self._mailbox.put(message):
            self._ledger.overflow()

    def _work(self) -> None:
        """Run in the thread: deliver until the mailbox is closed and empty, or closed and the peer away."""
        while not self._connect() and not self._mailbox.closing:
            self._back_off()
        tries = LAST_TRIES
        while tries and (parcel := self._ledger.take()) is not None:
            if self._deliver(parcel.message):
                tries = LAST_TRIES
                continue
            self._ledger.put_back(parcel)
            if self._mailbox.closing:
                tries -= 1
            else:
                self._back_off()
        self._disconnect()

    def _back_off(self) -> None:
        self._mailbox.pause(self._retry_s)
        self._retry_s = min(2 * self._retry_s, LONGEST_RETRY_S)

    def _deliver(self, message: Message) -> bool:
        """Try to hand over ``message`` and return whether it is done with, for good or for bad."""
        if not self._connect():
            return False
        try:
            self._hook.send(message)
        except RefusedError as error:
            self._ledger.give_up(error)
        except OSError as error:
            self._disconnect()
            self._ledger.fail(error)
            return False
        except Exception as error:  # a fault of the hook or its library: what it chokes on is not tried again
            self._disconnect()
            self._ledger.give_up(error)
        else:
            self._retry_s = self._first_retry_s
            self._ledger.succeed()
        return True

    def _connect(self) -> bool:
        if self._connected:
            return True
        try:
            self._hook.connect(self._header)
        except Exception as error:
            self._disconnect()
            self._ledger.fail(error)
            return False
        self._connected = True
        return True

    def _disconnect(self) -> None:
        self._connected = False
        with suppress(Exception):
            self._hook.disconnect()


def _kept(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A copy of ``picture``, which is valid in this call only; of a wide one every second pixel, or third and so on."""
    step = max(1, picture.shape[1] // PICTURE_PX)
    return picture[::step, ::step].copy()
