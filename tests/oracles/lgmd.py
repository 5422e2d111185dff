"""The LGMD branch: inhibition, competition, grouping, sigmoid, spike frequency adaptation."""

from __future__ import annotations

import math
from typing import NamedTuple

from .dog import framed
from .lamina import CLOCK_MS, share

Rows = list[list[float]]


class Rings(NamedTuple):
    """Weights and delays of the centre, the 4 nearest and the 4 diagonal cells, and the bias at rest."""

    weights: tuple[float, float, float]
    delays_ms: tuple[float, float, float]
    bias: float


def around(wide: Rows, y: int, x: int) -> list[float]:
    """The 3 x 3 neighbourhood of (y, x) out of the framed picture."""
    return wide[y][x : x + 3] + wide[y + 1][x : x + 3] + wide[y + 2][x : x + 3]


RING = (2, 1, 2, 1, 0, 1, 2, 1, 2)
"""The ring each of them lies on: 0 the centre, 1 the nearest, 2 the diagonal ones."""


def inhibition(now: Rows, before: Rows, rings: Rings) -> Rows:
    """Eq. (1): each neighbour counts with the weight and the delay of its ring."""
    wide_now, wide_before = framed(now, 1), framed(before, 1)
    a = [share(tau) for tau in rings.delays_ms]
    out = []
    for y in range(len(now)):
        line = []
        for x in range(len(now[0])):
            total = 0.0
            for ring, present, past in zip(RING, around(wide_now, y, x), around(wide_before, y, x), strict=True):
                total += rings.weights[ring] * (a[ring] * present + (1 - a[ring]) * past)
            line.append(total)
        out.append(line)
    return out


def competition(excitation: Rows, inhibited: Rows, bias: float) -> Rows:
    """Eq. (2), rectified."""
    return [[max(e - bias * i, 0.0) for e, i in zip(*lines, strict=True)]
            for lines in zip(excitation, inhibited, strict=True)]  # fmt: skip


def summation(on: Rows, off: Rows, thetas: tuple[float, float, float]) -> Rows:
    """The weighted sum of both channels and of their product."""
    return [[thetas[0] * p + thetas[1] * q + thetas[2] * p * q for p, q in zip(*lines, strict=True)]
            for lines in zip(on, off, strict=True)]  # fmt: skip


def grouping(rows: Rows, threshold: float = 30.0, floor: float = 0.01) -> Rows:
    """S times its neighbourhood over the strongest one; small results are dropped."""
    wide = framed(rows, 1)
    means = [[sum(around(wide, y, x)) / 9 for x in range(len(rows[0]))] for y in range(len(rows))]
    omega = floor + max(max(line) for line in means) / 4
    grouped = [[rows[y][x] * means[y][x] / omega for x in range(len(rows[0]))] for y in range(len(rows))]
    return [[g if g >= threshold else 0.0 for g in line] for line in grouped]


def sigmoid(rows: Rows, c_sig: float = 1.0, beside: float = 0.0) -> float:
    """K: from 0.5 for an empty map up to 1; ``beside`` is what excites besides the map."""
    pixels = len(rows) * len(rows[0])
    return 1 / (1 + math.exp(-(sum(map(sum, rows)) + beside) / (pixels * c_sig)))


def looming(on: float, off: float, gain: float, on_weight: float) -> float:
    """What patches that darken add, where those that brighten do not outweigh them."""
    return gain * max(off - on_weight * on, 0.0)


def adaptation(raw: float, raw_before: float, u_before: float, dt_ms: float = CLOCK_MS) -> float:
    """SFA: what does not grow by 0.003 a tick loses a share 1 - 800 / (800 + dt)."""
    a = 800 / (800 + dt_ms)
    growth = raw - raw_before
    faded = a * (u_before + growth) if growth <= 0.003 * dt_ms / CLOCK_MS else a * raw
    return max(faded, 0.5)
