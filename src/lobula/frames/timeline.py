"""One run of time for a live source, over every connection to it, and when each of its pictures was captured."""

from __future__ import annotations

import math

BACK_S = 1.0
"""A stamp that lies further before the last one than this begins a new count, s; nearer ones are out of order."""

AHEAD_S = 5.0
"""So does one that has gone on this much more than the clock has, s. Lateness is none: a network may hiccup."""

WINDOW_S = 30.0
"""The fastest way from the source to here is looked for in the last one to two of these, s: clocks drift apart."""

_LEAST_S = 1e-3  # between the last picture of one count and the first of the next


class Timeline:
    """Gives every picture a time that increases: the source's own stamps, as far as they are to be believed.

    A new connection counts from 0 again, and a camera that sets its clock counts from anywhere: there the line goes on
    by the time that passed here. ``breaks`` counts those places: what came before them is not the past of what follows.
    """

    def __init__(self) -> None:
        self.breaks = 0
        self.last_s = 0.0
        self._stamp_s: float | None = None
        self._arrived_s = 0.0
        self._shift_s = 0.0  # from stamp to time
        self._connected_anew = False

    def connect(self) -> None:
        """Take note that the next stamps are those of a new connection."""
        self._connected_anew = self._stamp_s is not None

    def place(self, stamp_s: float, arrived_s: float) -> float | None:
        """Return the time of a picture that arrived at ``arrived_s``, or None for one that is out of order."""
        if self._stamp_s is not None:
            step_s, waited_s = stamp_s - self._stamp_s, arrived_s - self._arrived_s
            if self._connected_anew or step_s < -BACK_S or step_s > waited_s + AHEAD_S:
                self._connected_anew = False
                self.breaks += 1
                self._shift_s = self.last_s + max(waited_s, _LEAST_S) - stamp_s
            elif stamp_s + self._shift_s <= self.last_s:
                return None
        self._stamp_s, self._arrived_s = stamp_s, arrived_s
        self.last_s = stamp_s + self._shift_s
        return self.last_s


class Transit:
    """Tells when a picture was captured by the fastest way that any picture of the last minute took.

    A source's stamps say how long after each other its pictures were captured, the clock here says how long after each
    other they came: what is more than the least was spent in a queue. The least itself, from the lens to here, cannot
    be seen from here and counts as nothing.
    """

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        """Forget the way of pictures before a break."""
        self._least_s = self._least_before_s = math.inf
        self._began_s = -math.inf

    def captured(self, time_s: float, arrived_s: float) -> float:
        """Return when a picture of ``time_s`` was captured, on the clock of ``arrived_s``; never later than that."""
        if arrived_s - self._began_s > WINDOW_S:
            self._least_before_s, self._least_s, self._began_s = self._least_s, math.inf, arrived_s
        self._least_s = min(self._least_s, arrived_s - time_s)
        return time_s + min(self._least_s, self._least_before_s)
