"""The curves of the report page as inline SVG: sharp at any width, coloured by the page's own light or dark theme."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..types import NEURONS, Neuron
from .palette import LABELS, MEANINGS, RANGES
from .spans import Span, collision_spans, frame_ends_s, state_spans, thinned

_WIDTH, _TRACE, _RASTER = 1000.0, 100.0, 24.0
_MARGIN = 3.0  # above and below the range of a potential, so that a line on its end is drawn whole
_MOST_POINTS = 2000


def traces_html(trace: NDArray[np.void], thresholds: Mapping[Neuron, float]) -> str:
    """Return one row for each neuron (its name, its potential with the threshold, its spikes) and the time axis."""
    if len(trace) == 0:
        return '<p class="none">The source gave no frames.</p>'
    start_s, end_s = float(trace["time_s"][0]), float(frame_ends_s(trace["time_s"])[-1])
    scale = _WIDTH / max(end_s - start_s, 1e-9)
    shades = _shades(state_spans(trace), "off", start_s, scale) + _shades(collision_spans(trace), "hit", start_s, scale)
    rows = "".join(_row(trace, neuron, thresholds[neuron], shades, start_s, scale) for neuron in NEURONS)
    legend = (
        '<p class="legend"><span class="hit">collision</span><span class="off">state other than ok</span>'
        '<span class="level">threshold</span></p>'
    )
    return f'<div class="traces">{rows}{_axis(start_s, end_s)}</div>{legend}'


def _row(trace: NDArray[np.void], neuron: Neuron, threshold: float, shades: str, start_s: float, scale: float) -> str:
    low, high = RANGES[neuron]
    time_s, potential = thinned(trace["time_s"], trace[neuron], _MOST_POINTS)
    height = (_TRACE - 2 * _MARGIN) / (high - low)
    x, y = (time_s - start_s) * scale, _MARGIN + (high - potential) * height
    line = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
    level = _MARGIN + (high - threshold) * height

    time_s, counts = thinned(trace["time_s"], trace[f"spikes_{neuron}"], _MOST_POINTS)
    seen = counts > 0
    x = (time_s[seen] - start_s) * scale
    tall = np.minimum(8.0 * np.log2(1.0 + counts[seen]), _RASTER)  # 1 spike a third of the band, 7 and more all of it
    ticks = " ".join(f"M{a:.1f} {_RASTER:g}v-{h:.1f}" for a, h in zip(x, tall, strict=True))

    peak = float(potential[np.abs(potential).argmax()])
    total = int(trace[f"spikes_{neuron}"].sum())
    label = f"{LABELS[neuron]}: peak {peak:.3f}, {total} spikes"
    return (
        f'<div class="row {neuron}"><div class="name"><b>{LABELS[neuron]}</b><span>{MEANINGS[neuron]}</span>'
        f"<span>peak {peak:.3f}, {total} spikes</span></div>"
        f'<div class="plot"><i class="top">{high:g}</i><i class="bottom">{low:g}</i>'
        f'<svg class="curve" viewBox="0 0 {_WIDTH:g} {_TRACE:g}" preserveAspectRatio="none" role="img" '
        f'aria-label="{label}">{shades}<path class="level" d="M0 {level:.1f}H{_WIDTH:g}"/>'
        f'<polyline points="{line}"/></svg>'
        f'<svg class="spikes" viewBox="0 0 {_WIDTH:g} {_RASTER:g}" preserveAspectRatio="none" aria-hidden="true">'
        f'<path d="{ticks}"/></svg></div></div>'
    )


def _shades(spans: list[Span], kind: str, start_s: float, scale: float) -> str:
    return "".join(
        f'<rect class="{kind}" x="{(s.start_s - start_s) * scale:.1f}" y="0" '
        f'width="{max((s.end_s - s.start_s) * scale, 1.0):.1f}" height="{_TRACE:g}"/>'
        for s in spans
    )


def _axis(start_s: float, end_s: float) -> str:
    """Time in round steps, at most eight; placed in percent, so that it stretches with the curves."""
    step_s = _round_step((end_s - start_s) / 7)
    digits = max(0, -math.floor(math.log10(step_s)))
    ticks = np.arange(math.ceil(start_s / step_s - 1e-9), math.floor(end_s / step_s + 1e-9) + 1) * step_s
    labels = "".join(
        f'<span style="left:{100 * (t - start_s) / max(end_s - start_s, 1e-9):.2f}%">{t:.{digits}f}</span>'
        for t in ticks
    )
    return f'<div class="row axis"><div class="name"><span>time, s</span></div><div class="plot">{labels}</div></div>'


def _round_step(step_s: float) -> float:
    """The next 1, 2 or 5 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(max(step_s, 1e-3)))
    return next(m * power for m in (1, 2, 5, 10) if m * power >= step_s * (1 - 1e-9))
