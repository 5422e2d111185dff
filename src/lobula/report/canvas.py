"""Ink on an RGB picture: rectangles, frames and text, in place."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .font import CAP_HEIGHT, text_mask

Canvas = NDArray[np.uint8]
"""An (h, w, 3) RGB picture that is drawn on."""

Colour = tuple[int, int, int]


def rgb(colour: str) -> Colour:
    """Return ``#rrggbb`` as three numbers."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def mix(ground: Colour, colour: Colour, share: float) -> Colour:
    """Return ``ground`` with ``share``, 0 to 1, of ``colour`` in it."""
    red, green, blue = (round(g + share * (c - g)) for g, c in zip(ground, colour, strict=True))
    return red, green, blue


def box(canvas: Canvas, row: int, column: int, height: int, width: int, colour: Colour) -> None:
    """Fill a rectangle; what falls outside is cut off."""
    canvas[max(row, 0) : max(row + height, 0), max(column, 0) : max(column + width, 0)] = colour


def border(canvas: Canvas, width: int, colour: Colour) -> None:
    """Draw a frame of ``width`` pixels along the inside of the canvas's edge."""
    canvas[:width], canvas[-width:] = colour, colour
    canvas[:, :width], canvas[:, -width:] = colour, colour


def text(
    canvas: Canvas,
    words: str,
    row: int,
    column: int,
    colour: Colour,
    ground: Colour,
    *,
    size_px: float = 12.0,
    weight: float = 0.9,
    align: str = "left",
) -> None:
    """Write ``words`` on ``ground``, the top of their capitals at ``row``; what falls outside is cut off.

    ``align`` says what ``column`` is: the ``left`` edge, the ``right`` edge or the ``middle``.
    """
    tiles = [_tile(letter, size_px, weight, colour, ground) for letter in words]
    width = sum(tile.shape[1] for tile in tiles)
    left = column - {"left": 0, "middle": width // 2, "right": width}[align]
    top = row - round(size_px / CAP_HEIGHT)
    for tile in tiles:
        height, width = tile.shape[:2]
        if left >= 0 and top >= 0:
            target = canvas[top : top + height, left : left + width]
            target[...] = tile[: target.shape[0], : target.shape[1]]
        left += width


def label(
    canvas: Canvas, words: str, row: int, column: int, colour: Colour, ground: Colour, *, size_px: float = 12.0
) -> int:
    """Write ``words`` on a filled box whose top left corner is given; return the width of the box."""
    pad = round(size_px / 2)
    width = int(text_mask(words, size_px, 1.1).shape[1]) + 2 * pad
    box(canvas, row, column, round(size_px) + 2 * pad, width, ground)
    text(canvas, words, row + pad, column + pad, colour, ground, size_px=size_px, weight=1.1)
    return width


@lru_cache(maxsize=2048)
def _tile(letter: str, size_px: float, weight: float, colour: Colour, ground: Colour) -> Canvas:
    """One letter, ready to be copied: (h, w, 3)."""
    low, high = np.array(ground, np.float32), np.array(colour, np.float32)
    ink = text_mask(letter, size_px, weight)[:, :, None]
    tile: Canvas = np.round(low + ink * (high - low)).astype(np.uint8)
    return tile
