"""The marks of events on a top view of the arena, each kind with a shape and a colour of its own; and their legend."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .arena_pen import tint
from .canvas import Canvas, rgb, text
from .palette import DARK, EVENT_LABELS, event_colours

KINDS = tuple(EVENT_LABELS)
COLOURS = {kind: rgb(colour) for kind, colour in event_colours(DARK).items()}
RED = ("CR", "CP")
"""Contacts."""

_GROUND, _TEXT, _DIM = rgb(DARK.ground), rgb(DARK.text), rgb(DARK.dim)
_REACH = 9  # px, half a mark with its dark outline


class Marks(NamedTuple):
    """N events, in the order of their frames: in which frame, of which kind, where."""

    frames: NDArray[np.int64]
    kinds: NDArray[np.str_]
    places_cm: NDArray[np.float64]  # (N, 2)


def draw_mark(canvas: Canvas, kind: str, row: float, column: float, share: float = 1.0) -> None:
    """Draw the mark of a kind of event around a place, with ``share`` of its full strength."""
    top, left = round(row) - _REACH, round(column) - _REACH
    size = 2 * _REACH + 1
    height, width = canvas.shape[:2]
    rows = slice(min(max(top, 0), height), min(max(top + size, 0), height))
    columns = slice(min(max(left, 0), width), min(max(left + size, 0), width))
    part = canvas[rows, columns]
    inner = slice(rows.start - top, rows.stop - top), slice(columns.start - left, columns.stop - left)
    outline, shape = _inks(kind)
    tint(part, share * 0.8 * outline[inner], _GROUND)
    tint(part, share * shape[inner], COLOURS[kind])


def draw_legend(canvas: Canvas, top: int, left: int, width: int, counts: Mapping[str, int]) -> None:
    """Write each kind's mark, name, count and meaning into a band of ``width``, 48 px high."""
    letters = np.cumsum([0, *(max(len(kind) + len(EVENT_LABELS[kind]), 14) for kind in KINDS)])
    for kind, before in zip(KINDS, letters.tolist(), strict=False):
        column = left + round(width * before / letters[-1])
        draw_mark(canvas, kind, top + 14, column + 14)
        text(canvas, f"{kind} {counts.get(kind, 0)}", top + 8, column + 32, _TEXT, _GROUND, size_px=12)
        text(canvas, EVENT_LABELS[kind], top + 32, column + 6, _DIM, _GROUND, size_px=7)


@lru_cache(maxsize=len(KINDS))
def _inks(kind: str) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """The mark with a dark rim around it, and the mark itself, each (19, 19)."""
    grid = np.arange(-_REACH, _REACH + 1, dtype=np.float32)
    y, x = grid[:, None], grid[None, :]
    away = _distance(kind, np.abs(x), np.abs(y))
    return np.clip(2.5 - away, 0, 1).astype(np.float32), np.clip(0.5 - away, 0, 1).astype(np.float32)


def _distance(kind: str, x: NDArray[np.float32], y: NDArray[np.float32]) -> NDArray[np.float32]:
    """Distance of each pixel from the mark's shape, px, negative inside; all shapes are symmetric: x, y >= 0."""
    radius, square = np.hypot(x, y), np.maximum(x, y)
    cross = np.maximum(np.abs(x - y) / np.sqrt(2) - 1.4, square - 5.5)
    shapes = {
        "AA": radius - 5.0,
        "AT": (x + y - 7.0) / np.sqrt(2),
        "AP": square - 4.3,
        "spurious": np.abs(radius - 4.0) - 1.1,
        "CR": cross,
        "CP": np.minimum(np.abs(square - 5.3) - 1.0, np.maximum(np.abs(x - y) / np.sqrt(2) - 0.9, square - 5.3)),
    }
    return np.asarray(shapes[kind], np.float32)
