"""Difference of Gaussians as one sum over a square window for each pixel."""

from __future__ import annotations

import math

Rows = list[list[float]]


def gauss(rows: Rows, radius: int, sigma: float) -> Rows:
    """Weighted mean over the (2 radius + 1) square; a pixel outside counts as the nearest one inside."""
    height, width = len(rows), len(rows[0])
    around = range(-radius, radius + 1)
    norm = sum(math.exp(-(dy * dy + dx * dx) / (2 * sigma * sigma)) for dy in around for dx in around)
    out = []
    for y in range(height):
        line = []
        for x in range(width):
            total = 0.0
            for dy in around:
                for dx in around:
                    inside_y = min(max(y + dy, 0), height - 1)
                    inside_x = min(max(x + dx, 0), width - 1)
                    total += math.exp(-(dy * dy + dx * dx) / (2 * sigma * sigma)) * rows[inside_y][inside_x]
            line.append(total / norm)
        out.append(line)
    return out


def polarity(e: float, i: float, dead: float) -> float:
    """The sign rule: both positive or zero, both negative, or nothing."""
    if abs(e) < dead:
        return 0.0
    if e >= 0 and i >= 0:
        return abs(e - i)
    if e < 0 and i < 0:
        return -abs(e - i)
    return 0.0


def dog(rows: Rows, radius: int = 2, sigma: float = 2.0, dead: float = 1e-4) -> Rows:
    """5 x 5 of sigma 2 against 9 x 9 of sigma 4."""
    inner, outer = gauss(rows, radius, sigma), gauss(rows, 2 * radius, 2 * sigma)
    return [[polarity(e, i, dead) for e, i in zip(*lines, strict=True)] for lines in zip(inner, outer, strict=True)]
