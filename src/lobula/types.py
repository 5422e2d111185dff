"""The values that travel between the parts: a frame in, a reading out, and the table a run leaves behind."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.float32]
"""An (H, W) map, row then column; luminance units of 0..255 unless a docstring says otherwise."""

Neuron = Literal["lgmd1", "lgmd2", "lptc_r", "lptc_l"]
NEURONS: tuple[Neuron, ...] = ("lgmd1", "lgmd2", "lptc_r", "lptc_l")

State = Literal["ok", "warming_up", "stale", "flash", "turning"]
STATES: tuple[State, ...] = ("ok", "warming_up", "stale", "flash", "turning")
"""Named states of a reading; the position in this tuple is the code the C core uses."""


@dataclass(frozen=True, slots=True)
class Frame:
    """One picture of a source: ``image`` (H, W) luminance 0..255, ``time_s`` its own stamp, ``index`` its number.

    ``captured_s`` is when it was captured, on the clock of ``time.monotonic``; None where nobody knows, as in a file.
    """

    image: NDArray[np.uint8] | Image
    time_s: float
    index: int = 0
    captured_s: float | None = None


class Spikes(NamedTuple):
    """Spikes of one frame, a count for each neuron."""

    lgmd1: int = 0
    lgmd2: int = 0
    lptc_r: int = 0
    lptc_l: int = 0


class Reading(NamedTuple):
    """What the network says of one frame.

    ``lgmd1`` and ``lgmd2`` are membrane potentials in [0.5, 1), ``lptc_r`` in [0, 1), ``lptc_l`` in (-1, 0].
    ``taps`` holds the maps that ``step(..., taps=...)`` asked for, by name.
    """

    time_s: float
    lgmd1: float
    lgmd2: float
    lptc_r: float
    lptc_l: float
    spikes: Spikes
    collision: bool
    state: State
    taps: Mapping[str, Image] = {}


TRACE_DTYPE = np.dtype(
    [("frame", np.int64), ("time_s", np.float64)]
    + [(name, np.float64) for name in NEURONS]
    + [(f"spikes_{name}", np.int32) for name in NEURONS]
    + [("collision", np.bool_), ("state", "U10")]
)
"""Columns of a trace: what ``Network.run`` returns and what ``--trace`` writes, in this order."""
