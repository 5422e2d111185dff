"""Spikes and the decision, from the whole history each time."""

from __future__ import annotations

import math
from fractions import Fraction

Step = tuple[float, tuple[int, int, int, int], float]
"""Time in s, spikes of LGMD-1, LGMD-2, LPTC-R and LPTC-L, and the length of the step in ticks."""


def quarters(ticks: float) -> Fraction:
    """The nearest quarter tick; from 0.4 of a quarter, the one above."""
    below = math.floor(4 * ticks)
    return Fraction(below + (4 * ticks - below >= 0.4), 4)


def spike_count(potential: float, threshold: float) -> int:
    """Eq. (4), K_sp = 4."""
    return math.floor(math.exp(4 * (abs(potential) - threshold)))


def whole(counts: list[tuple[int, float]]) -> int:
    """The sum weighted by quarter ticks to the nearest whole spike, halves upwards."""
    return math.floor(sum((n * quarters(ticks) for n, ticks in counts), Fraction(0)) + Fraction(1, 2))


def rule(history: list[Step], now_s: float, neurons: str = "all", needed: int = 4, window_ms: float = 200.0) -> bool:
    """A >= ``needed`` over the window, A > B where the LPTCs have a say, and evidence in two steps of it."""
    recent = [step for step in history if (now_s - step[0]) * 1000 <= window_ms - 1]
    first = whole([(spikes[0], ticks) for _, spikes, ticks in recent])
    second = whole([(spikes[1], ticks) for _, spikes, ticks in recent])
    lptcs = whole([(max(spikes[2], spikes[3]), ticks) for _, spikes, ticks in recent])
    a = second if neurons == "lgmd2" else min(first, second)
    both = [s for _, s, _ in recent if s[1] > 0 and (neurons == "lgmd2" or s[0] > 0)]
    return len(both) >= 2 and a >= needed and (neurons != "all" or a > lptcs)


def decide(history: list[Step], now_s: float, neurons: str = "all", needed: int = 4) -> bool:
    """Whether the rule held at any step of the last 199 ms: 200 less a millisecond for rounded stamps."""
    return any(
        (now_s - history[k][0]) * 1000 <= 199 and rule(history[: k + 1], history[k][0], neurons, needed)
        for k in range(len(history))
    )
