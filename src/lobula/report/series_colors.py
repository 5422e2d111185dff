"""Colours of series that are no neurons, such as models: the palette's own, in a fixed order; then grey."""

from __future__ import annotations

from .palette import LIGHT

_ORDER = (
    LIGHT.neurons["lgmd2"], LIGHT.neurons["lgmd1"], LIGHT.neurons["lptc_l"], LIGHT.neurons["lptc_r"],
    LIGHT.states["stale"], LIGHT.states["turning"],
)  # fmt: skip
MARKERS = "osD^vP"


def series_color(number: int) -> str:
    """Return the colour of series ``number``, counted from 0."""
    return _ORDER[number] if number < len(_ORDER) else LIGHT.dim


def series_marker(number: int) -> str:
    """Return the mark of series ``number``: no series is told by its colour alone."""
    return MARKERS[number % len(MARKERS)]
