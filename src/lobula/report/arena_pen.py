"""Smooth ink on an RGB picture, in place: discs, sectors, lines and paths at places between pixels.

Rows and columns are real numbers; (0, 0) is the middle of the upper left pixel. What falls outside is cut off.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .canvas import Canvas, Colour

Floats = NDArray[np.floating[Any]]
_Box = tuple[slice, slice]


def tint(canvas: Canvas, ink: Floats, colour: Colour) -> None:
    """Lay ``colour`` over ``canvas`` (h, w, 3), with the share ``ink`` (h, w), 0 to 1, at each pixel."""
    share = np.rint(ink * 128).astype(np.int16)  # so that a share times a difference of greys fits 16 bits
    for channel, value in enumerate(colour):  # one at a time: three numbers make a slow innermost loop
        plane = canvas[..., channel]
        plane += ((share * (np.int16(value) - plane.astype(np.int16))) >> 7).astype(np.uint8)


def tint_thinly(canvas: Canvas, ink: Floats, colour: Colour) -> None:
    """Do the same where there is ink on few pixels."""
    rows, columns = np.nonzero(ink)
    few = canvas[rows, columns]
    tint(few, ink[rows, columns], colour)
    canvas[rows, columns] = few


def disc(canvas: Canvas, row: float, column: float, radius: float, colour: Colour, share: float = 1.0) -> None:
    """Fill a circle."""
    box = _around(canvas, row, column, radius + 1)
    rows, columns = _offsets(box, row, column)
    tint(canvas[box], share * np.clip(radius + 0.5 - np.hypot(rows, columns), 0, 1), colour)


def ring(canvas: Canvas, row: float, column: float, radius: float, width: float, colour: Colour) -> None:
    """Draw a circle with a pen of ``width``."""
    box = _around(canvas, row, column, radius + width + 1)
    rows, columns = _offsets(box, row, column)
    away = np.abs(np.hypot(rows, columns) - radius)
    tint(canvas[box], np.clip(width / 2 + 0.5 - away, 0, 1), colour)


def line(canvas: Canvas, start: tuple[float, float], end: tuple[float, float], width: float, colour: Colour) -> None:
    """Draw a straight line between two (row, column)."""
    middle, half = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2), math.dist(start, end) / 2
    box = _around(canvas, *middle, half + width + 1)
    rows, columns = _offsets(box, *start)
    down, right = end[0] - start[0], end[1] - start[1]
    along = np.clip((rows * down + columns * right) / max(down * down + right * right, 1e-9), 0, 1)
    away = np.hypot(rows - along * down, columns - along * right)
    tint(canvas[box], np.clip(width / 2 + 0.5 - away, 0, 1), colour)


def sector(
    canvas: Canvas, row: float, column: float, heading_rad: float, half_rad: float, radius: float, colour: Colour,
    share: float, within: NDArray[np.bool_],
) -> None:  # fmt: skip
    """Fill a sector around ``heading_rad`` (0 is rightwards, counter-clockwise), fading out towards ``radius``.

    ``within`` (h, w) of the canvas is where it may be seen; ``half_rad`` is at most a quarter turn.
    """
    # its bounding box: the middle, the two corners, and the arc where it crosses an axis
    angles = [heading_rad - half_rad, heading_rad + half_rad]
    angles += [
        k * math.pi / 2 for k in range(math.ceil(angles[0] * 2 / math.pi), math.floor(angles[1] * 2 / math.pi) + 1)
    ]
    rows = [row, *(row - radius * math.sin(angle) for angle in angles)]
    columns = [column, *(column + radius * math.cos(angle) for angle in angles)]
    box = _clipped(canvas, min(rows), max(rows), min(columns), max(columns))
    down, right = _offsets(box, row, column)
    sides = []
    for side in (-1, 1):  # distance from each edge, positive inside
        angle = heading_rad + side * half_rad
        sides.append(side * (np.float32(math.sin(angle)) * right + np.float32(math.cos(angle)) * down))
    inside = np.clip(np.minimum(*sides) + np.float32(0.5), 0, 1)
    fading = np.clip(1 - np.sqrt(down * down + right * right) / np.float32(radius), 0, 1)
    tint(canvas[box], np.float32(share) * inside * fading * within[box], colour)


def path(ink: NDArray[np.float32], rows: Floats, columns: Floats, shares: Floats, width: float) -> None:
    """Draw a pen's way through points (n,) about a pixel apart into ``ink`` (h, w), each with its share.

    Where the way crosses itself the stronger ink holds.
    """
    height, wide = ink.shape
    top, left = np.rint(rows).astype(np.intp), np.rint(columns).astype(np.intp)
    reach = math.ceil(width / 2)
    flat = ink.reshape(-1)
    for down in range(-reach, reach + 1):
        for right in range(-reach, reach + 1):
            away = np.hypot(top + down - rows, left + right - columns)
            cover = np.clip(width / 2 + 0.5 - away, 0, 1) * shares
            kept = (cover > 0) & (top >= -down) & (top < height - down) & (left >= -right) & (left < wide - right)
            np.maximum.at(flat, ((top + down) * wide + left + right)[kept], cover[kept].astype(np.float32))


def _around(canvas: Canvas, row: float, column: float, reach: float) -> _Box:
    return _clipped(canvas, row - reach, row + reach, column - reach, column + reach)


def _clipped(canvas: Canvas, top: float, bottom: float, left: float, right: float) -> _Box:
    height, width = canvas.shape[:2]
    rows = slice(min(max(math.floor(top), 0), height), min(max(math.ceil(bottom) + 1, 0), height))
    return rows, slice(min(max(math.floor(left), 0), width), min(max(math.ceil(right) + 1, 0), width))


def _offsets(box: _Box, row: float, column: float) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Rows (h, 1) and columns (1, w) of the pixels in ``box``, from a place."""
    rows = np.arange(box[0].start, box[0].stop, dtype=np.float32) - np.float32(row)
    columns = np.arange(box[1].start, box[1].stop, dtype=np.float32) - np.float32(column)
    return rows[:, None], columns[None, :]
