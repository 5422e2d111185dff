"""The model clock: what a frame's own time stamp means to a model that is defined at 30 steps a second."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from ..params import Params, param


@dataclass(frozen=True, kw_only=True)
class ClockParams(Params):
    """Frame difference, residual, thresholds and spikes for each frame are defined on this clock."""

    period_ms: float = param(1000.0 / 30.0, "ms", "one tick", low=5, high=200, source="paper Sec. III: 30 fps")
    change_exponent: float = param(
        0.75, "", "a step of n ticks counts its change n^-exponent times", low=0, high=1,
        source="calibrated on the synthetic battery, 15 against 30 Hz",
    )  # fmt: skip
    max_gap_ms: float = param(
        500.0, "ms", "a longer silence starts the network afresh", low=100, high=10_000, source="chosen"
    )
    repeats: bool = param(True, "", "recognise frames that only repeat the one before", source="chosen")
    repeat_hold_ms: float = param(
        200.0, "ms", "repeats longer than this are a still scene", low=0, high=2000, source="chosen"
    )
    repeat_mean_grey: float = param(
        0.1, "grey", "mean change below which a frame repeats", low=0, high=5, source="chosen"
    )
    repeat_max_grey: float = param(
        8.0, "grey", "largest change below which a frame repeats", low=0, high=50, source="chosen"
    )


SLACK_MS = 1.0
"""Stamps are rounded, often to a millisecond: what lasts a round number of frames ends at the same frame all the same,
since each limit in ms stands this much to the side where no frame of a usual rate falls."""

NEAREST = 0.97
"""Likewise, of two frames as near to the end of a tick (at 45 or 75 Hz) the first is taken: share of a tick."""


def whole_quarters(ticks: float) -> float:
    """Return ``ticks`` rounded to quarters, up from 0.4 of one: the same for each step of a steady source.

    Whatever the rounding of its stamps, that is; no usual frame rate comes near 0.4 of a quarter.
    """
    return math.floor(4.0 * ticks + 0.6) / 4.0


class Beat(Enum):
    """What to do with a frame."""

    START = "start"
    """Nothing to compare it with: the first one, or the first after a long gap."""
    WAIT = "wait"
    """The source is faster than the clock: a later frame stands nearer to the end of this tick."""
    TICK = "tick"
    """The tick is complete; whether it advances the network is decided by ``advances``."""


class Clock:
    """Counts ticks by the frames' own stamps. Times in seconds, durations in milliseconds."""

    def __init__(self, p: ClockParams) -> None:
        self.p = p
        self.reset()

    def reset(self) -> None:
        """Forget every frame."""
        self.frame_s: float | None = None
        self.tick_s = self.step_s = 0.0
        self.still = False

    def beat(self, time_s: float) -> Beat:
        """Say what the frame stamped ``time_s`` is. A tick is complete at the frame nearest to its end."""
        before, self.frame_s = self.frame_s, time_s
        if before is None or (time_s - before) * 1000.0 > self.p.max_gap_ms + SLACK_MS:
            self.tick_s, self.step_s, self.still = time_s, time_s, False
            return Beat.START
        interval_ms, elapsed_ms = (time_s - before) * 1000.0, (time_s - self.tick_s) * 1000.0
        # The next frame would come closer to the end of the tick than this one: wait for it.
        if elapsed_ms + 0.5 * interval_ms < NEAREST * self.p.period_ms:
            return Beat.WAIT
        self.tick_s = time_s
        return Beat.TICK

    def advances(self, time_s: float, mean_abs: float, max_abs: float) -> float | None:
        """Return the step's length in ms, or None where the frame only repeats the one before.

        A 10 Hz camera in a 30 Hz file shows each picture three times. Stepping through the repeats would read as
        stillness and then double motion, so they are held until a change comes, which then counts over the whole
        time. Repeats that last longer than ``repeat_hold_ms`` are a still scene and advance the network.
        """
        elapsed_ms = (time_s - self.step_s) * 1000.0
        repeats = self.p.repeats and mean_abs < self.p.repeat_mean_grey and max_abs < self.p.repeat_max_grey
        if repeats and not self.still and elapsed_ms <= self.p.repeat_hold_ms + SLACK_MS:
            return None
        self.still = repeats
        self.step_s = time_s
        return elapsed_ms
