"""What a viewer sees beside the traces: a picture, maps of the layers, the parts of the rule."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..frames.geometry import Layout
from ..types import Image

MAP_GROUPS: Mapping[str, tuple[str, ...]] = {
    "Lamina": ("change", "lamina", "adapted_on", "adapted_off"),
    "LGMD-1": ("lgmd1_inhibition_on", "lgmd1_inhibition_off", "lgmd1_summation", "lgmd1_grouped"),
    "LGMD-2": ("lgmd2_inhibition_on", "lgmd2_inhibition_off", "lgmd2_summation", "lgmd2_grouped"),
    "LPTC": ("motion",),
}
"""The network's taps as the page offers them."""

_STEPS = 127
_FADE = 0.95  # of the full scale, from one picture to the next: a quiet scene does not blow up its noise at once


class MapPacket(NamedTuple):
    """One map for the page: a signed byte a pixel, 127 for ``peak`` in the map's own unit."""

    name: str
    peak: float
    width: int
    height: int
    data: bytes


class Scene(NamedTuple):
    """One moment. ``number`` tells scenes apart; ``jpeg`` is empty where there is no picture.

    ``box`` is where the maps lie on the picture, (left, top, width, height) as shares of its sides.
    """

    number: int
    time_s: float
    jpeg: bytes
    box: tuple[float, float, float, float]
    maps: Mapping[str, MapPacket]
    why: list[dict[str, Any]]


def box_of(layout: Layout, width: int, height: int) -> tuple[float, float, float, float]:
    """Return the ``box`` of maps of ``width`` x ``height``; padding puts parts of it outside the picture."""
    seen, place = layout.seen, layout.place
    across, down = seen.width / place.width, seen.height / place.height
    left, top = seen.x - across * place.x, seen.y - down * place.y
    return left / layout.width, top / layout.height, across * width / layout.width, down * height / layout.height


class MapScale:
    """Turns maps into packets on a scale that rises at once and falls slowly, so that it does not flicker."""

    def __init__(self) -> None:
        self._peaks: dict[str, float] = {}

    def __call__(self, name: str, image: Image) -> MapPacket:
        """Return the map ``image`` (H, W) as a packet."""
        peak = max(float(np.abs(image).max()), _FADE * self._peaks.get(name, 0.0), 1e-9)
        self._peaks[name] = peak
        steps = np.rint(image * np.float32(_STEPS / peak)).astype(np.int8)
        height, width = image.shape
        return MapPacket(name, peak, width, height, steps.tobytes())
