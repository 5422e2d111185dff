"""The strip under an annotated picture: four potentials over the last seconds, their spikes and the decision."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..types import NEURONS, Neuron, Reading
from .canvas import Canvas, Colour, box, label, mix, rgb, text
from .palette import DARK, LABELS, RANGES, STATE_LABELS

SPAN_S = 3.0
"""Time that the running traces show, s."""

_HEAD, _AXIS = 40, 22
_TRACE, _RASTER, _GAP = 40, 14, 6
_PITCH = _TRACE + _RASTER + _GAP
_LEFT, _RIGHT = 108, 10
STRIP_HEIGHT = _HEAD + len(NEURONS) * _PITCH + _AXIS

_SHADES = 32
_GROUND, _TEXT, _DIM, _RED = rgb(DARK.ground), rgb(DARK.text), rgb(DARK.dim), rgb(DARK.collision)
_PANELS: tuple[Colour, ...] = (rgb(DARK.panel), rgb(DARK.line), mix(rgb(DARK.panel), _RED, 0.45))
"""What lies behind a column of a trace: an ok reading, a state other than ok, a collision."""


class _Past(NamedTuple):
    """The n readings in view, laid out over the w columns of the plot."""

    column: NDArray[np.float64]  # (n,) where each reading lies; the newest at w - 1
    panel: NDArray[np.intp]  # (w,) index into _PANELS
    tick: int  # width of a spike's tick, px


class Strip:
    """Keeps the last seconds of readings and draws them, newest at the right."""

    def __init__(self, width: int, thresholds: Mapping[Neuron, float]) -> None:
        self._width = width
        self._plot = width - _LEFT - _RIGHT
        self._thresholds = thresholds
        self._readings: deque[Reading] = deque()
        self._index = 0
        self._blank = self._draw_blank()
        # Every shade of a neuron's ink on every panel, so that drawing a trace is one look-up per pixel.
        shades = [k / (_SHADES - 1) for k in range(_SHADES)]
        self._inks = {
            n: np.array([mix(panel, rgb(DARK.neurons[n]), s) for panel in _PANELS for s in shades], np.uint8)
            for n in NEURONS
        }

    def push(self, index: int, reading: Reading) -> None:
        """Take the newest reading and forget those that have left the view."""
        self._index = index
        self._readings.append(reading._replace(taps={}))
        while len(self._readings) > 2 and self._readings[1].time_s < reading.time_s - SPAN_S:
            self._readings.popleft()

    def draw(self, canvas: Canvas) -> None:
        """Draw on ``canvas``, (STRIP_HEIGHT, width, 3), of which nothing is kept."""
        canvas[...] = self._blank
        self._draw_head(canvas)
        past = self._past()
        for number, neuron in enumerate(NEURONS):
            self._draw_neuron(canvas, _HEAD + number * _PITCH, neuron, past)
        self._draw_seconds(canvas)

    def _draw_blank(self) -> Canvas:
        """What is the same in every frame: names and ends of the axes."""
        canvas = np.zeros((STRIP_HEIGHT, self._width, 3), np.uint8)
        canvas[...] = _GROUND
        for number, neuron in enumerate(NEURONS):
            top = _HEAD + number * _PITCH
            text(canvas, LABELS[neuron], top + 3, 10, rgb(DARK.neurons[neuron]), _GROUND, size_px=11)
            low, high = RANGES[neuron]
            text(canvas, f"{high:g}", top + 1, _LEFT - 4, _DIM, _GROUND, size_px=7, align="right")
            text(canvas, f"{low:g}", top + _TRACE - 9, _LEFT - 4, _DIM, _GROUND, size_px=7, align="right")
        return canvas

    def _past(self) -> _Past:
        time_s = np.array([r.time_s for r in self._readings])
        column = (self._plot - 1) * (1 + (time_s - time_s[-1]) / SPAN_S)
        # A reading holds until the next one, so a column belongs to the last reading at or before it.
        owner = np.searchsorted(column, np.arange(self._plot), side="right") - 1
        kind = np.array([2 if r.collision else int(r.state != "ok") for r in self._readings])
        apart_px = (column[-1] - column[0]) / max(len(column) - 1, 1)
        return _Past(column, np.where(owner < 0, 0, kind[owner]), min(max(int(0.6 * apart_px), 1), 5))

    def _draw_head(self, canvas: Canvas) -> None:
        now, column = self._readings[-1], 10
        if now.collision:
            column += label(canvas, "COLLISION", 10, column, (255, 255, 255), _RED, size_px=11) + 8
        if now.state != "ok" or not now.collision:
            label(canvas, STATE_LABELS[now.state], 10, column, _GROUND, rgb(DARK.states[now.state]), size_px=11)
        right = self._width - _RIGHT
        text(canvas, f"{now.time_s:.3f} s", 15, right, _TEXT, _GROUND, align="right")
        text(canvas, f"frame {self._index}", 15, right - 130, _DIM, _GROUND, align="right")

    def _draw_neuron(self, canvas: Canvas, top: int, neuron: Neuron, past: _Past) -> None:
        potential = np.array([getattr(r, neuron) for r in self._readings])
        counts = np.array([getattr(r.spikes, neuron) for r in self._readings])
        threshold, (low, high) = self._thresholds[neuron], RANGES[neuron]

        # Cut, not rounded: 0.699 is below its threshold and must not read 0.70.
        value = f"{math.trunc(round(potential[-1] * 100, 6)) / 100:.2f}"
        colour = _TEXT if abs(potential[-1]) >= abs(threshold) else _DIM
        text(canvas, value, top + 26, 10, colour, _GROUND)
        if counts[-1]:
            text(canvas, f"x{counts[-1]}", top + 26, 58, rgb(DARK.neurons[neuron]), _GROUND)

        scale = (_TRACE - 3) / (high - low)
        row = 1 + (high - np.interp(np.arange(self._plot + 1) - 0.5, past.column, potential, left=np.nan)) * scale
        rest = 1.0 if neuron == "lptc_l" else 1 + (high - low) * scale  # LPTC-L rests at 0, the top of its range
        shade = np.zeros((_TRACE + _RASTER, self._plot), np.intp)
        shade[:_TRACE] = _trace_ink(row, rest) * (_SHADES - 1)
        shade[_TRACE + 1 :][_raster(past, counts, self._plot)] = _SHADES - 1
        panel = canvas[top : top + _TRACE + _RASTER, _LEFT : _LEFT + self._plot]
        np.take(self._inks[neuron], shade + _SHADES * past.panel, axis=0, out=panel, mode="clip")
        panel[1 + round((high - threshold) * scale), np.arange(self._plot) % 8 < 4] = _DIM
        panel[_TRACE] = rgb(DARK.line)

    def _draw_seconds(self, canvas: Canvas) -> None:
        now_s, top = self._readings[-1].time_s, _HEAD + len(NEURONS) * _PITCH
        for second in range(math.ceil(now_s - SPAN_S), math.floor(now_s) + 1):
            column = _LEFT + round((self._plot - 1) * (1 + (second - now_s) / SPAN_S))
            box(canvas, top - 3, column, 4, 1, _DIM)
            if _LEFT + 8 < column < self._width - _RIGHT - 12:
                text(canvas, f"{second} s", top + 6, column, _DIM, _GROUND, size_px=8, align="middle")


def _trace_ink(row: NDArray[np.float64], rest: float) -> NDArray[np.float32]:
    """Ink, 0 to 1, of a trace that passes ``row`` (w + 1,) at the edges of its columns: a line, a tint to ``rest``.

    Columns before the first reading are NaN in ``row`` and get no ink.
    """
    ink = np.zeros((_TRACE, len(row) - 1), np.float32)
    first = int(np.isnan(row).sum())
    y, edges = np.arange(_TRACE, dtype=np.float32)[:, None], row[first:].astype(np.float32)
    upper, lower = np.minimum(edges[:-1], edges[1:]), np.maximum(edges[:-1], edges[1:])
    away = np.maximum(upper - y, y - lower)  # rows between a pixel and the part of the line in its column
    middle = (upper + lower) / 2
    tinted = (y >= np.minimum(middle, np.float32(rest))) & (y <= np.maximum(middle, np.float32(rest)))
    ink[:, first:] = np.maximum(np.clip(np.float32(1.3) - away, 0, 1), np.float32(0.2) * tinted)
    return ink


def _raster(past: _Past, counts: NDArray[np.int64], width: int) -> NDArray[np.bool_]:
    """Where the ticks of the spikes are, (_RASTER - 1, w): one tick a frame, taller for more spikes."""
    height = np.zeros(width + past.tick)
    left = np.round(past.column).astype(int) - past.tick + 1  # the newest tick ends at the right edge
    seen = (counts > 0) & (left >= 0)
    for offset in range(past.tick):
        np.maximum.at(height, left[seen] + offset, 4.0 * np.log2(1.0 + counts[seen]))  # 1 spike 4 px, 3 8 px, 8 all
    rows_from_foot = np.arange(_RASTER - 1, 0, -1)[:, None]
    return rows_from_foot <= np.minimum(height[:width], _RASTER - 1)
