"""Readings become events: a collision or a named state has a start and an end, whatever the frame rate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from ..types import NEURONS, Reading, Spikes, State

REJOIN_S = 0.5
"""A collision that starts again this soon after its end is the same one, s."""

_JITTER_S = 1e-6  # stamps are sums of rounded numbers: 2.7 - 2.2 is not above 0.5

Record = dict[str, Any]
"""One line of the NDJSON output, as ``lobula run --json`` prints it."""


@dataclass(kw_only=True)
class Collision:
    """One collision event: frames are numbers of the source, times its stamps in seconds.

    ``end_frame`` is the first frame without the alarm, or the last one of a run that ended inside it; None while the
    alarm lasts. ``peak_frame`` is where the weaker LGMD was strongest.
    """

    id: int
    start_frame: int
    start_s: float
    peak_frame: int
    peak: float
    end_frame: int | None = None
    end_s: float = 0.0


class EventLog:
    """Turns readings, one by one, into the records of the events they start and end.

    A start is told at once. The end of a collision is held back until it cannot start again within ``REJOIN_S``.
    ``count`` is how many have begun, ``latest`` the last of them: a camera may run for weeks, so no others are kept.
    """

    def __init__(self) -> None:
        self.count = 0
        self.latest: Collision | None = None
        self._open: Collision | None = None
        self.state: State = "ok"
        self._entered_s = 0.0
        self._last: tuple[int, float] | None = None

    def step(self, index: int, reading: Reading) -> list[Record]:
        """Take the reading of frame ``index`` and return what it starts or ends, oldest first."""
        self._last = (index, reading.time_s)
        records = self._elapse(reading.time_s)
        records += self.enter(reading.state, index, reading.time_s)
        if reading.collision:
            records += self._alarm(index, reading)
        elif self._open is not None and self._open.end_frame is None:
            self._open.end_frame, self._open.end_s = index, reading.time_s
        return records

    def enter(self, state: State, index: int, time_s: float) -> list[Record]:
        """Change to ``state`` and return the records of it; ``ok`` is the absence of a state and has none."""
        if state == self.state:
            return []
        left, self.state = self.state, state
        # a silence is told by the clock here, and a frame that comes late has an older stamp than that
        time_s = self._entered_s = max(time_s, self._entered_s)
        ends = [] if left == "ok" else [_state_record(left, "end", index, time_s)]
        starts = [] if state == "ok" else [_state_record(state, "start", index, time_s)]
        return ends + starts

    def elapse(self, time_s: float) -> list[Record]:
        """Let time pass, as while a camera is silent; return the end of a collision that has become final."""
        if self._last is not None:
            self._last = (self._last[0], max(self._last[1], time_s))
        return self._elapse(time_s)

    def lose(self, index: int, time_s: float) -> list[Record]:
        """The source gives nothing: what was under way is over, and the state is ``stale``."""
        records = self.elapse(time_s) + self._cut(index, time_s)
        return records + self.enter("stale", index, time_s)

    def _elapse(self, time_s: float) -> list[Record]:
        event = self._open
        if event is None or event.end_frame is None or time_s - event.end_s <= REJOIN_S + _JITTER_S:
            return []
        self._open = None
        return [_end_record(event)]

    def finish(self) -> list[Record]:
        """End what is still under way, at the last frame, and return the records."""
        if self._last is None:
            return []
        index, time_s = self._last
        return self._cut(index, time_s) + self.enter("ok", index, time_s)

    def _cut(self, index: int, time_s: float) -> list[Record]:
        """End a collision that is under way here and now, one that has ended where it did."""
        event, self._open = self._open, None
        if event is None:
            return []
        if event.end_frame is None:
            event.end_frame, event.end_s = index, time_s
        return [_end_record(event)]

    def _alarm(self, index: int, reading: Reading) -> list[Record]:
        strength = min(reading.lgmd1, reading.lgmd2)
        event = self._open
        if event is None:
            self.count += 1
            event = self._open = self.latest = Collision(
                id=self.count, start_frame=index, start_s=reading.time_s, peak_frame=index, peak=strength
            )
            return [_start_record(event, reading)]
        event.end_frame = None
        if strength > event.peak:
            event.peak_frame, event.peak = index, strength
        return []


def collisions_of(trace: NDArray[np.void]) -> list[Collision]:
    """Return the collision events of a whole trace, (n,) TRACE_DTYPE, oldest first."""
    log = EventLog()
    found: list[Collision] = []
    for row in trace:
        log.step(int(row["frame"]), reading_of(row))
        if log.latest is not None and log.count > len(found):
            found.append(log.latest)
    log.finish()
    return found


def reading_of(row: np.void) -> Reading:
    """Return one row of a trace as the reading it was."""
    lgmd1, lgmd2, lptc_r, lptc_l = (float(row[name]) for name in NEURONS)
    spikes = Spikes(*(int(row[f"spikes_{name}"]) for name in NEURONS))
    state = cast(State, str(row["state"]))
    return Reading(float(row["time_s"]), lgmd1, lgmd2, lptc_r, lptc_l, spikes, bool(row["collision"]), state)


def _start_record(event: Collision, reading: Reading) -> Record:
    potentials = {name: round(getattr(reading, name), 6) for name in NEURONS}
    return {
        "type": "collision",
        "phase": "start",
        "id": event.id,
        "frame": event.start_frame,
        "time_s": _told(event.start_s),
    } | potentials


def _end_record(event: Collision) -> Record:
    return {
        "type": "collision",
        "phase": "end",
        "id": event.id,
        "frame": event.end_frame,
        "time_s": _told(event.end_s),
        "peak_frame": event.peak_frame,
    }


def _state_record(state: State, phase: str, index: int, time_s: float) -> Record:
    return {"type": "state", "state": state, "phase": phase, "frame": index, "time_s": _told(time_s)}


def source_record(phase: str, index: int, time_s: float, facts: Mapping[str, Any]) -> Record:
    """Return the record of what became of a live source after frame ``index``."""
    return {"type": "source", "phase": phase, "frame": index, "time_s": _told(time_s), **facts}


def motor_record(action: str, index: int, time_s: float) -> Record:
    """Return the record of what a robot's wheels do from frame ``index`` on."""
    return {"type": "motor", "action": action, "frame": index, "time_s": _told(time_s)}


def _told(time_s: float) -> float:
    """A time as a record tells it: to the microsecond, so that equal stamps read alike however they were reckoned."""
    return round(time_s, 6)
