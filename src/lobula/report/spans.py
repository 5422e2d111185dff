"""Stretches of a trace: when a collision or a state lasted, and a long curve made short without losing its peaks."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..runtime.events import REJOIN_S
from ..types import State


class Span(NamedTuple):
    """From ``start_s`` to ``end_s``, the time of the first frame after it."""

    name: str
    start_s: float
    end_s: float


def collision_spans(trace: NDArray[np.void]) -> list[Span]:
    """Return the collisions of a trace, in order: alarms no more than ``REJOIN_S`` apart are one, as in the events."""
    spans: list[Span] = []
    for span in _runs(trace, np.where(trace["collision"], "collision", "")):
        if not span.name:
            continue
        if spans and span.start_s - spans[-1].end_s <= REJOIN_S + 1e-6:  # stamps are sums of rounded numbers
            spans[-1] = spans[-1]._replace(end_s=span.end_s)
        else:
            spans.append(span)
    return spans


def state_spans(trace: NDArray[np.void], *, without: tuple[State, ...] = ("ok",)) -> list[Span]:
    """Return the stretches of one state each, in order, leaving out the states in ``without``."""
    return [span for span in _runs(trace, trace["state"]) if span.name not in without]


def frame_ends_s(time_s: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return when each frame was followed by the next; the last one is given the median gap."""
    gap_s = float(np.median(np.diff(time_s))) if len(time_s) > 1 else 0.0
    return np.append(time_s[1:], time_s[-1:] + gap_s)


def _runs(trace: NDArray[np.void], names: NDArray[np.str_]) -> list[Span]:
    if len(trace) == 0:
        return []
    first = np.flatnonzero(np.append(True, names[1:] != names[:-1]))
    last = np.append(first[1:], len(names)) - 1
    ends_s = frame_ends_s(trace["time_s"])
    return [Span(str(names[a]), float(trace["time_s"][a]), float(ends_s[b])) for a, b in zip(first, last, strict=True)]


def thinned(
    time_s: NDArray[np.float64], values: NDArray[np.float64], most: int = 4000
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return at most ``most`` points of a curve: of each piece its lowest and its highest, so no peak is lost."""
    if len(values) <= most:
        return time_s, values
    pieces = np.array_split(np.arange(len(values)), most // 2)
    kept = sorted({i for p in pieces for i in (p[np.argmin(values[p])], p[np.argmax(values[p])])})
    return time_s[kept], values[kept]
