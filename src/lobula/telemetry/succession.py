"""One reading after the other: what was lost in between, whether the robot began anew, its time without the wrap."""

from __future__ import annotations

from typing import NamedTuple

from .messages import RobotReading

_WRAP = 2**32


class Place(NamedTuple):
    """Where a reading stands.

    ``number`` grows from 0 over all restarts, by the robot's own count of pictures; ``stamp_s`` is the robot's time
    since it was first heard, and jumps where ``restarted`` says that the robot was switched on anew.
    """

    number: int
    stamp_s: float
    restarted: bool


class Succession:
    """Puts readings in their places. ``lost`` counts those that were made and did not arrive."""

    def __init__(self) -> None:
        self.lost = 0
        self._last: RobotReading | None = None
        self._number = self._ms = 0
        self._unbroken = False

    def connect(self) -> None:
        """Take note of a new connection: what was missed between the two is the connection's loss, not the line's."""
        self._unbroken = False

    def place(self, reading: RobotReading) -> Place | None:
        """Return where ``reading`` stands, or None for one that was there already."""
        last, self._last = self._last, reading
        unbroken, self._unbroken = self._unbroken, True
        if last is None:
            return Place(0, 0.0, False)
        forward_ms = (reading.time_ms - last.time_ms) % _WRAP
        if (reading.frame, forward_ms) == (last.frame, 0):
            self._unbroken = unbroken
            return None
        if reading.frame <= last.frame or forward_ms >= _WRAP // 2:
            self._number += 1
            self._ms += reading.time_ms - last.time_ms
            return Place(self._number, self._ms / 1000, True)
        pictures = reading.frame - last.frame
        if unbroken:  # of so many pictures no more readings can have been made
            self.lost += min((reading.sequence - last.sequence - 1) % 2**16, pictures - 1)
        self._number += pictures
        self._ms += forward_ms
        return Place(self._number, self._ms / 1000, False)
