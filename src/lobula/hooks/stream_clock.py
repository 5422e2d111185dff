"""When a record happened, for recordings that are laid beside others: the frames' own times on the system's clock."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


class StreamClock:
    """Gives records a time since 1970, ns.

    The first record sets where time 0 of the source lies; from there on the frames' own stamps count. So a clip that
    was read in a blink keeps its true pace, and a live source stays as even as its stamps.
    """

    def __init__(self) -> None:
        self._zero_s: float | None = None
        self._last_s = 0.0

    def at_ns(self, record: Mapping[str, Any]) -> int:
        """Return when ``record`` happened; one without a time, such as the summary, counts as the latest so far."""
        time_s = float(record.get("time_s", self._last_s))
        self._last_s = max(self._last_s, time_s)
        if self._zero_s is None:
            self._zero_s = record["unix_s"] - time_s
        return max(0, round((self._zero_s + time_s) * 1e6) * 1000)  # a float holds such a time to a quarter of a us
