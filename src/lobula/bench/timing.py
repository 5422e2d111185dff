"""Timing that survives a busy machine: contenders take turns, and medians are taken of whole rounds."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from statistics import median

Pass = Callable[[], int]
"""Does the work once and returns the number of frames it took in."""


@dataclass
class Timing:
    """Time of one contender, microseconds a frame: the median of each round, and the best pass of all."""

    rounds_us: list[float] = field(default_factory=list)
    best_us: float = float("inf")

    @property
    def median_us(self) -> float:
        """Median over the rounds."""
        return median(self.rounds_us)

    def as_dict(self) -> dict[str, float]:
        """Median and best, rounded to nanoseconds."""
        return {"median": round(self.median_us, 3), "best": round(self.best_us, 3)}


def interleaved(
    contenders: Mapping[str, Pass],
    rounds: int,
    clock: Callable[[], int] = time.thread_time_ns,
    at_least_ms: float = 50.0,
) -> dict[str, Timing]:
    """Time ``contenders`` in turns, ``rounds`` times each.

    A turn is as many passes as fill ``at_least_ms``, and counts as the median of their times per frame: what else the
    machine does meets all contenders alike. One pass of each goes before, unmeasured. ``clock`` counts nanoseconds; by
    default those of this thread alone.
    """
    timings = {name: Timing() for name in contenders}
    for work in contenders.values():
        work()
    for _ in range(rounds):
        for name, work in contenders.items():
            passes: list[float] = []
            spent_ns = 0
            while not passes or spent_ns < at_least_ms * 1e6:
                start = clock()
                frames = work()
                # A clock of coarse steps may stand still: one step then.
                ns = max(clock() - start, 1)
                spent_ns += ns
                passes.append(ns / 1000.0 / frames)
            timings[name].rounds_us.append(median(passes))
            timings[name].best_us = min(timings[name].best_us, *passes)
    return timings


def ratio(slow: Timing, fast: Timing) -> float:
    """Return how many times longer ``slow`` takes: the median over rounds measured side by side."""
    return median(a / b for a, b in zip(slow.rounds_us, fast.rounds_us, strict=True))
