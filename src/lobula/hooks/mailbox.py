"""The bounded queue before a hook: what finds no room pushes out the oldest of its kind, and that is counted."""

from __future__ import annotations

import threading
from collections import deque
from typing import NamedTuple

from .message import Message


class Parcel(NamedTuple):
    """A message and its place in the order of arrival."""

    number: int
    message: Message


class Mailbox:
    """Messages in the order they came. Readings have a lane of their own, so they never push out an event."""

    def __init__(self, events_kept: int, readings_kept: int) -> None:
        self._changed = threading.Condition()
        self._events: deque[Parcel] = deque()
        self._readings: deque[Parcel] = deque()
        self._kept = (events_kept, readings_kept)
        self._came = 0
        self._closing = False
        self.dropped = 0

    def __len__(self) -> int:
        with self._changed:
            return len(self._events) + len(self._readings)

    @property
    def closing(self) -> bool:
        """True once ``close`` was called."""
        with self._changed:
            return self._closing

    def put(self, message: Message) -> int:
        """Add a message and return how many are lost by it; never waits."""
        with self._changed:
            self._came += 1
            lane, kept = self._lane(message)
            lane.append(Parcel(self._came, message))
            self._changed.notify_all()
            return self._trim(lane, kept)

    def put_back(self, parcel: Parcel) -> int:
        """Return a parcel that could not be delivered to its place; if there is no room left, it is the one to go."""
        with self._changed:
            lane, kept = self._lane(parcel.message)
            lane.appendleft(parcel)
            return self._trim(lane, kept)

    def take(self) -> Parcel | None:
        """Wait for the oldest message and take it; None when there is none and none will come."""
        with self._changed:
            self._changed.wait_for(lambda: self._events or self._readings or self._closing)
            lanes = [lane for lane in (self._events, self._readings) if lane]
            return min(lanes, key=lambda lane: lane[0].number).popleft() if lanes else None

    def pause(self, duration_s: float) -> None:
        """Wait for ``duration_s``, or until the mailbox is closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._closing, duration_s)

    def close(self) -> None:
        """Say that no message will come."""
        with self._changed:
            self._closing = True
            self._changed.notify_all()

    def empty(self) -> int:
        """Give up what still waits and return how many that were."""
        with self._changed:
            lost = len(self._events) + len(self._readings)
            self._events.clear()
            self._readings.clear()
            self.dropped += lost
            return lost

    def _lane(self, message: Message) -> tuple[deque[Parcel], int]:
        return (self._readings, self._kept[1]) if message.kind == "reading" else (self._events, self._kept[0])

    def _trim(self, lane: deque[Parcel], kept: int) -> int:
        lost = max(0, len(lane) - kept)
        for _ in range(lost):
            lane.popleft()
        self.dropped += lost
        return lost
