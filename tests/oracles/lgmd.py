"""The LGMD branch: inhibition, competition, grouping, sigmoid, spike frequency adaptation."""

from __future__ import annotations

import math
from typing import NamedTuple

from .lamina import CLOCK_MS, share

Rows = list[list[float]]


class Rings(NamedTuple):
    """Weights and delays of the centre, the 4 nearest and the 4 diagonal cells, and the bias at rest."""

    weights: tuple[float, float, float]
    delays_ms: tuple[float, float, float]
    bias: float


def around(rows: Rows, y: int, x: int) -> list[tuple[int, float]]:
    """The 3 x 3 neighbourhood as (ring, value), edge pixels repeated outwards."""
    height, width = len(rows), len(rows[0])
    return [
        (abs(dy) + abs(dx), rows[min(max(y + dy, 0), height - 1)][min(max(x + dx, 0), width - 1)])
        for dy in (-1, 0, 1) for dx in (-1, 0, 1)
    ]  # fmt: skip


def inhibition(now: Rows, before: Rows, rings: Rings) -> Rows:
    """Eq. (1): each neighbour counts with the weight and the delay of its ring."""
    out = []
    for y in range(len(now)):
        line = []
        for x in range(len(now[0])):
            total = 0.0
            for (ring, present), (_, past) in zip(around(now, y, x), around(before, y, x), strict=True):
                a = share(rings.delays_ms[ring])
                total += rings.weights[ring] * (a * present + (1 - a) * past)
            line.append(total)
        out.append(line)
    return out


def summation(on: tuple[Rows, Rows], off: tuple[Rows, Rows], ring_on: Rings, ring_off: Rings, arousal: float,
              thetas: tuple[float, float, float]) -> Rows:
    """Eq. (2) in both channels, each a pair (now, before), and their weighted sum."""
    i_on, i_off = inhibition(*on, ring_on), inhibition(*off, ring_off)
    w_on, w_off = max(ring_on.bias, arousal), max(ring_off.bias, arousal)
    out = []
    for y in range(len(i_on)):
        line = []
        for x in range(len(i_on[0])):
            s_on = max(on[0][y][x] - w_on * i_on[y][x], 0.0)
            s_off = max(off[0][y][x] - w_off * i_off[y][x], 0.0)
            line.append(thetas[0] * s_on + thetas[1] * s_off + thetas[2] * s_on * s_off)
        out.append(line)
    return out


def grouping(rows: Rows, threshold: float = 30.0, floor: float = 0.01) -> Rows:
    """S times its neighbourhood over the strongest one; small results are dropped."""
    means = [[sum(v for _, v in around(rows, y, x)) / 9 for x in range(len(rows[0]))] for y in range(len(rows))]
    omega = floor + max(max(line) for line in means) / 4
    grouped = [[rows[y][x] * means[y][x] / omega for x in range(len(rows[0]))] for y in range(len(rows))]
    return [[g if g >= threshold else 0.0 for g in line] for line in grouped]


def sigmoid(rows: Rows, c_sig: float = 1.0) -> float:
    """K: from 0.5 for an empty map up to 1."""
    pixels = len(rows) * len(rows[0])
    return 1 / (1 + math.exp(-sum(map(sum, rows)) / (pixels * c_sig)))


def adaptation(raw: float, raw_before: float, u_before: float, dt_ms: float = CLOCK_MS) -> float:
    """SFA: what does not grow by 0.003 a tick loses a share 1 - 800 / (800 + dt)."""
    a = 800 / (800 + dt_ms)
    growth = raw - raw_before
    faded = a * (u_before + growth) if growth <= 0.003 * dt_ms / CLOCK_MS else a * raw
    return max(faded, 0.5)
