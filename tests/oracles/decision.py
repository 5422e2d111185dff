"""Spikes and the decision, from the whole history each time."""

from __future__ import annotations

import math
from fractions import Fraction

Step = tuple[float, tuple[int, int, int, int], float]
"""Time in s, spikes of LGMD-1, LGMD-2, LPTC-R and LPTC-L, and the weight of the step."""


def spike_count(potential: float, threshold: float) -> int:
    """Eq. (4), K_sp = 4."""
    return math.floor(math.exp(4 * (abs(potential) - threshold)))


def whole(counts: list[tuple[int, float]]) -> int:
    """The weighted sum to the nearest whole spike, halves upwards, without rounding on the way."""
    return math.floor(sum((n * Fraction(weight) for n, weight in counts), Fraction(0)) + Fraction(1, 2))


def rule(history: list[Step], now_s: float, neurons: str = "all", needed: int = 4, window_ms: float = 200.0) -> bool:
    """A >= ``needed`` over the window, A > B where the LPTCs have a say, and evidence in two steps of it."""
    recent = [step for step in history if (now_s - step[0]) * 1000 <= window_ms - 1]
    first = whole([(spikes[0], weight) for _, spikes, weight in recent])
    second = whole([(spikes[1], weight) for _, spikes, weight in recent])
    lptcs = whole([(max(spikes[2], spikes[3]), weight) for _, spikes, weight in recent])
    a = second if neurons == "lgmd2" else min(first, second)
    both = [s for _, s, _ in recent if s[1] > 0 and (neurons == "lgmd2" or s[0] > 0)]
    return len(both) >= 2 and a >= needed and (neurons != "all" or a > lptcs)


def decide(history: list[Step], now_s: float, neurons: str = "all", needed: int = 4) -> bool:
    """Whether the rule held at any step of the last 200 ms."""
    return any(
        (now_s - history[k][0]) * 1000 < 200 and rule(history[: k + 1], history[k][0], neurons, needed)
        for k in range(len(history))
    )
