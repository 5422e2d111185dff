"""Correlators: every pair of cells, each with its delayed twin, written out in full."""

from __future__ import annotations

import math
from fractions import Fraction

from .decision import quarters
from .lamina import share

Rows = list[list[float]]


def correlate(now: Rows, before: Rows, spans: list[int], delays_ms: list[float]) -> Rows:
    """Sum over the spans of Mh(x) M(x + d) - M(x) Mh(x + d), booked at x; pairs inside the picture only."""
    height, width = len(now), len(now[0])
    out = [[0.0] * width for _ in range(height)]
    for d, tau in zip(spans, delays_ms, strict=True):
        a = share(tau)
        for y in range(height):
            for x in range(width - d):
                delayed_left = a * now[y][x] + (1 - a) * before[y][x]
                delayed_right = a * now[y][x + d] + (1 - a) * before[y][x + d]
                out[y][x] += delayed_left * now[y][x + d] - now[y][x] * delayed_right
    return out


def spans(ticks: float) -> list[int]:
    """Spans of 1 to 4 px in a step of ``ticks``."""
    return [max(1, math.floor(d * quarters(min(ticks, 4)) + Fraction(1, 2))) for d in (1, 2, 3, 4)]


def potentials(hs: float, pixels: int, k_hs: float) -> tuple[float, float]:
    """Right and left LPTC from the net motion of the whole picture."""
    v = 2 / (1 + math.exp(-abs(hs) / (pixels * k_hs))) - 1
    return (v, 0.0) if hs > 0 else (0.0, -v if hs < 0 else 0.0)
