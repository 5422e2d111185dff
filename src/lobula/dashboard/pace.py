"""How long the detector takes, as the page shows it: the middle and the worst of the last while."""

from __future__ import annotations

import statistics
from collections import deque

_KEPT = 256


class Pace:
    """The last durations, s."""

    def __init__(self) -> None:
        self._durations_s: deque[float] = deque(maxlen=_KEPT)

    def add(self, duration_s: float) -> None:
        """Take note of one duration."""
        self._durations_s.append(duration_s)

    def told(self) -> dict[str, float] | None:
        """Return median and worst in ms; None before the first."""
        if not self._durations_s:
            return None
        return {
            "median": round(1000 * statistics.median(self._durations_s), 3),
            "worst": round(1000 * max(self._durations_s), 3),
        }
