"""What a run counts, and the summary it ends with."""

from __future__ import annotations

import math
import statistics
import time
from collections import deque
from typing import Any

from .events import EventLog, Record
from .outputs import Outputs
from .sources import Numbered, Source

_TIMED = 4096  # durations kept for a median: a camera may run for weeks

DONE, REFUSED, FAILED = 0, 2, 3


class Durations:
    """Median of the newest durations, and the longest of all, in seconds."""

    def __init__(self) -> None:
        self._newest: deque[float] = deque(maxlen=_TIMED)
        self.worst_s = 0.0

    def __len__(self) -> int:
        return len(self._newest)

    def add(self, duration_s: float) -> None:
        """Take one in."""
        self._newest.append(duration_s)
        self.worst_s = max(self.worst_s, duration_s)

    def median_s(self) -> float:
        """Return the median, 0 if there is none."""
        return statistics.median(self._newest) if self._newest else 0.0


class Tally:
    """Counts what the summary tells; ``log`` holds the events."""

    def __init__(self, source: Source, outputs: Outputs) -> None:
        self.log = EventLog()
        self.frames = self.index = 0
        self.last_s = 0.0
        self._lost = 0
        self._away_s = 0.0
        self._away_since_s: float | None = None
        self.exit_code = DONE
        self.message: str | None = None
        self._status = "ok"
        self._source = source
        self._outputs = outputs
        self._first_s = math.nan
        self._steps = Durations()
        self._latencies = Durations()

    def count(self, frame: Numbered, duration_s: float, latency_s: float | None) -> None:
        """Take note of a frame, how long the network took, and how long after its capture the decision stood."""
        if not self.frames:
            self._first_s = frame.time_s
        self.frames += 1
        self.index, self.last_s = frame.index, frame.time_s
        self._steps.add(duration_s)
        if latency_s is not None:
            self._latencies.add(latency_s)

    def lose(self, at_s: float) -> None:
        """Take note that the source went away, at a time of ``time.monotonic``."""
        self._lost += 1
        self._away_since_s = at_s

    def regain(self, at_s: float) -> None:
        """Take note that it is back."""
        self._away_s += self._away_now_s(at_s)
        self._away_since_s = None

    def end(self, status: str, exit_code: int, message: str) -> None:
        """Take note of an end that is not the end of the source."""
        self._status, self.exit_code, self.message = status, exit_code, message

    def words(self) -> str:
        """Return in one line how the run fares."""
        state = self.log.state.replace("_", " ")
        text = f"{state}; collisions {self.log.count}, dropped {self._source.dropped}, lost {self._lost}"
        if self._latencies:
            text += f"; latency {1000 * self._latencies.median_s():.1f} ms, worst {1000 * self._latencies.worst_s:.0f}"
        return text

    def summary(self) -> Record:
        """Return the summary record as things stand."""
        if self._status == "ok" and self._outputs.failures:
            self.end("output_failed", FAILED, "")
        # n frames have n - 1 gaps between them; the last frame lasts as long as the others did on average
        gaps = self.frames - 1
        duration_s = (self.last_s - self._first_s) * self.frames / gaps if gaps > 0 else 0.0
        record: Record = {
            "type": "summary",
            "status": self._status,
            "frames": self.frames,
            "dropped": self._source.dropped,
            "damaged": self._source.damaged,
            "collisions": self.log.count,
            "duration_s": round(duration_s, 6),
            "ms_per_frame": round(1000 * self._steps.median_s(), 4),
            "ms_worst": round(1000 * self._steps.worst_s, 4),
        }
        problems = [text for text in (self.message, *self._outputs.failures) if text]
        said = {"problems": problems, "notes": [*self._source.notes, *self._outputs.notes]}
        return record | self._live() | {name: texts for name, texts in said.items() if texts}

    def _live(self) -> dict[str, Any]:
        """What is told of live sources only."""
        if not self._source.live:
            return {}
        told: dict[str, Any] = {
            "lost": self._lost,
            "away_s": round(self._away_s + self._away_now_s(time.monotonic()), 3),
        }
        if self._latencies:
            told["latency_ms"] = round(1000 * self._latencies.median_s(), 2)
            told["latency_ms_worst"] = round(1000 * self._latencies.worst_s, 2)
        return told

    def _away_now_s(self, at_s: float) -> float:
        return 0.0 if self._away_since_s is None else at_s - self._away_since_s


def unbegun_summary(status: str, message: str) -> Record:
    """Return the summary of a run that never began, so that a reader of records always meets exactly one."""
    return {
        "type": "summary",
        "status": status,
        "frames": 0,
        "dropped": 0,
        "damaged": 0,
        "collisions": 0,
        "duration_s": 0.0,
        "ms_per_frame": 0.0,
        "ms_worst": 0.0,
        "problems": [message],
    }
