"""So many a second, by the stamps of the frames: the same ones however fast a recording is read."""

from __future__ import annotations

import math

_JITTER_S = 1e-6  # stamps are sums of rounded numbers


class Pace:
    """Says which of a row of stamps are due at ``rate_hz``: none at 0, all of them at infinity."""

    def __init__(self, rate_hz: float) -> None:
        self._period_s = math.inf if rate_hz == 0 else 1 / rate_hz
        self._last_s = -math.inf if rate_hz > 0 else math.inf

    def due(self, time_s: float) -> bool:
        """Return True if ``time_s`` is far enough from the last one that was due."""
        if not time_s - self._last_s >= self._period_s - _JITTER_S:
            return False
        self._last_s = time_s
        return True
