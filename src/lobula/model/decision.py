"""Coordination and competition: the LGMDs must agree, the LPTCs must not win."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import NamedTuple

from ..params import Params, param
from ..types import Spikes
from .clock import SLACK_MS, whole_quarters


@dataclass(frozen=True, kw_only=True)
class DecisionParams(Params):
    """The two logic gates and the comparator at the end of the network."""

    neurons: str = param(
        "all", "", "who decides: all four, the two LGMDs, or LGMD-2 alone", choices=("all", "lgmds", "lgmd2"),
        source="paper Sec. II-E",
    )  # fmt: skip
    window_ms: float = param(
        200.0, "ms", "spikes are summed over this", low=30, high=1000, source="published code: NewLGMDs, 6 frames"
    )
    collision_spikes: int = param(
        4, "", "LGMD spikes in the window that make a collision", low=1, high=100, source="published code: robot"
    )
    lptc_weight: float = param(
        1.0, "", "weight of the LPTC spikes in the comparator", low=0, high=100, source="paper Alg. 1"
    )
    end_ms: float = param(200.0, "ms", "a collision ends this long after the rule last held", low=0, high=2000,
                          source="chosen")  # fmt: skip
    warm_up_ms: float = param(200.0, "ms", "no decision this long after a start", low=0, high=5000, source="chosen")
    turning_deg_s: float = param(
        45.0, "deg/s", "a faster yaw is turning: no decision", low=1, high=2000, source="chosen"
    )
    after_turn_ms: float = param(
        67.0, "ms", "no decision this long after a turn", low=0, high=2000, source="chosen: two ticks"
    )


class Entry(NamedTuple):
    """One step in the window: its time and its weighted spikes."""

    time_s: float
    lgmd1: float
    lgmd2: float
    lptc: float


class Decision:
    """AND of the LGMDs, OR of the LPTCs, comparator; keeps the spikes of the window."""

    def __init__(self, p: DecisionParams) -> None:
        self.p = p
        self.reset()

    def reset(self) -> None:
        """Forget every spike."""
        self.window: deque[Entry] = deque()
        self.held_s: float | None = None

    def clear(self) -> None:
        """Empty the window, as after a turn; a collision under way still ends by itself."""
        self.window.clear()

    def step(self, time_s: float, spikes: Spikes, weight: float) -> None:
        """Add one step's spikes, ``weight`` = dt / clock in whole quarters, and note whether the rule holds.

        Over the last ``window_ms``: A = min(LGMD-1, LGMD-2) spikes, B = LPTC spikes, the larger of the two sides.
        The rule holds while A >= ``collision_spikes`` and A > ``lptc_weight`` B.

        Source: paper Sec. II-E and Algorithm 1; window and count from published code (docs/sources.md).
        """
        weight = whole_quarters(weight)
        lptc = max(spikes.lptc_r, spikes.lptc_l)
        self.window.append(Entry(time_s, weight * spikes.lgmd1, weight * spikes.lgmd2, weight * lptc))
        if self.holds(time_s):
            self.held_s = time_s

    def collision(self, time_s: float) -> bool:
        """Whether the rule held within the last ``end_ms``."""
        return self.held_s is not None and (time_s - self.held_s) * 1000.0 <= max(0.0, self.p.end_ms - SLACK_MS)

    def evidence(self, time_s: float) -> tuple[float, float]:
        """Return A and B over the window that ends at ``time_s``: LGMD spikes after the AND, LPTC spikes."""
        while self.window and (time_s - self.window[0].time_s) * 1000.0 > self.p.window_ms - SLACK_MS:
            self.window.popleft()
        lgmd1, lgmd2, lptc = (math.fsum(e[i] for e in self.window) for i in (1, 2, 3))
        return (lgmd2 if self.p.neurons == "lgmd2" else min(lgmd1, lgmd2)), lptc

    def holds(self, time_s: float) -> bool:
        """Whether the rule holds now. Weighted sums are rounded to whole spikes.

        One step is never enough, however long: an LPTC compares two steps, so the LGMDs would win each first one. On
        the clock itself this changes nothing, where ``collision_spikes`` takes two steps to collect.
        """
        a, b = (math.floor(x + 0.5) for x in self.evidence(time_s))
        if sum(e.lgmd2 > 0 and (e.lgmd1 > 0 or self.p.neurons == "lgmd2") for e in self.window) < 2:
            return False
        return a >= self.p.collision_spikes and (self.p.neurons != "all" or a > self.p.lptc_weight * b)
