"""What the page is told once: what is watched, how the neurons and states are called, what can be changed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._version import __version__
from ..errors import ParameterError
from ..report.palette import LABELS, MEANINGS, RANGES, STATE_LABELS, thresholds
from ..types import NEURONS, STATES
from .analysis import event_records
from .board import Board
from .live_settings import LiveSettings
from .rows import Rows, rows_of
from .scene import MAP_GROUPS

_FACTS = ("source", "preset", "neurons", "engine", "width", "height", "fps", "settings_hash", "version")


def about_run(mode: str, header: Mapping[str, Any], settings: LiveSettings | None) -> dict[str, Any]:
    """Return what stays the same.

    ``mode`` is "live", "robot", "recording" or "trace"; ``header`` that of the run, or what a saved trace
    remembers of it.
    """
    source = str(header.get("source", ""))
    return {
        "mode": mode,
        "name": source if "://" in source or mode == "robot" else Path(source).name or source,
        "facts": {key: header[key] for key in _FACTS if key in header},
        "lobula": __version__,
        "neurons": [
            {"name": n, "label": LABELS[n], "meaning": MEANINGS[n], "low": RANGES[n][0], "high": RANGES[n][1]}
            for n in NEURONS
        ],
        "states": [{"name": state, "label": STATE_LABELS[state]} for state in STATES],
        "thresholds": thresholds(header),
        "maps": {} if settings is None else dict(MAP_GROUPS),
        "settings": [] if settings is None else settings.described(),
    }


def board_of_trace(trace: NDArray[Any], header: Mapping[str, Any], name: str) -> Board:
    """Return the board of a saved trace, TRACE_DTYPE (n,): all rows, all events, no pictures, nothing to change.

    ``name`` is that of its file.

    Raises
    ------
    ParameterError : a value that is not finite; the page could not show it
    """
    _require_finite(trace, name)
    rows = Rows()
    rows.put(0, rows_of(trace))
    board = Board({**about_run("trace", header, None), "name": Path(name).name}, rows)
    board.replace_events(event_records(trace))
    board.tell(complete=True, total=len(trace))
    return board


def _require_finite(trace: NDArray[Any], name: str) -> None:
    for column in ("time_s", *NEURONS):
        wrong = np.flatnonzero(~np.isfinite(trace[column]))
        if len(wrong):
            raise ParameterError(
                f"trace {name}: column {column}, row {wrong[0] + 1}: {trace[column][wrong[0]]}: must be finite"
            )
