"""Difference of Gaussians as one sum over a square window for each pixel."""

from __future__ import annotations

import math

Rows = list[list[float]]


def framed(rows: Rows, margin: int) -> Rows:
    """The picture with its edge pixels repeated outwards."""
    wide = [[line[0]] * margin + line + [line[-1]] * margin for line in rows]
    return [wide[0]] * margin + wide + [wide[-1]] * margin


def gauss(rows: Rows, radius: int, sigma: float) -> Rows:
    """Weighted mean over the (2 radius + 1) square; a pixel outside counts as the nearest one inside."""
    around = range(-radius, radius + 1)
    weights = [[math.exp(-(dy * dy + dx * dx) / (2 * sigma * sigma)) for dx in around] for dy in around]
    norm = sum(map(sum, weights))
    wide = framed(rows, radius)
    out = []
    for y in range(len(rows)):
        line = []
        for x in range(len(rows[0])):
            total = 0.0
            for dy, row in enumerate(weights):
                for weight, value in zip(row, wide[y + dy][x : x + len(row)], strict=True):
                    total += weight * value
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
