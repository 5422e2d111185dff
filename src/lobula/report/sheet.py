"""Movies and their traces on one sheet, drawn by lobula itself: for machines without matplotlib."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..runtime.events import reading_of
from ..types import NEURONS
from .canvas import Canvas, rgb, text
from .montage import Tile, montage
from .palette import DARK, thresholds
from .plots import Scene
from .spans import collision_spans
from .strip import SPAN_S, STRIP_HEIGHT, Strip

_TITLE_PX, _WIDTH = 34, 640
_PICTURES = 3


def scene_sheet(scenes: Sequence[Scene], about: Mapping[str, Any] | None = None) -> Canvas:
    """Return the scenes one below the other: title, frames, and three seconds of running traces.

    The moment of the first collision is one of the frames. ``about`` is a run's header.
    """
    ground, ink = rgb(DARK.ground), rgb(DARK.text)
    parts = []
    for scene in scenes:
        pictures = montage(_tiles(scene), columns=_PICTURES)
        block = np.full((_TITLE_PX + len(pictures) + STRIP_HEIGHT, max(_WIDTH, pictures.shape[1]), 3), ground, np.uint8)
        text(block, scene.title, 14, 12, ink, ground, size_px=11)
        block[_TITLE_PX : _TITLE_PX + len(pictures), : pictures.shape[1]] = pictures
        strip = Strip(block.shape[1], thresholds(about or {}))
        for row in _telling(scene.trace):
            strip.push(int(row["frame"]), reading_of(row))
        strip.draw(block[-STRIP_HEIGHT:])
        parts.append(block)
    return np.concatenate(parts)


def _telling(trace: NDArray[np.void]) -> NDArray[np.void]:
    """The trace until shortly after the last spike, so that the spikes are in the seconds that the strip shows."""
    spiking = np.any([trace[f"spikes_{neuron}"] > 0 for neuron in NEURONS], axis=0)
    last_s = trace["time_s"][spiking][-1] if spiking.any() else trace["time_s"][-1]
    told: NDArray[np.void] = trace[trace["time_s"] <= max(last_s + 0.5, trace["time_s"][0] + SPAN_S)]
    return told


def _tiles(scene: Scene) -> list[Tile]:
    last = len(scene.frames) - 1
    alarms = collision_spans(scene.trace)
    chosen = [round(last * part / (_PICTURES - 1)) for part in range(_PICTURES)]
    if alarms:
        chosen[1] = int(np.searchsorted(scene.trace["time_s"], alarms[0].start_s))
    tiles = []
    for number in chosen:
        frame = scene.frames[number]
        marked = " COLLISION" if alarms and number == chosen[1] else ""
        tiles.append(Tile(_grey(frame.image), f"{frame.time_s:.2f} s{marked}"))
    return tiles


def _grey(image: NDArray[Any]) -> NDArray[np.uint8]:
    return np.asarray(np.rint(image), np.uint8)
