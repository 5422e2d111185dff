"""What travels to a hook: one record of a run, and with a reading perhaps its picture."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..runtime.events import Record
from ..runtime.ndjson import HEADER_KEYS
from ..types import TRACE_DTYPE, Reading

Kind = Literal["event", "reading", "summary"]


class Message(NamedTuple):
    """One record on its way out.

    ``record`` is what ``lobula run --json`` prints, or for a reading ``type`` and the columns of a trace. It carries
    ``unix_s`` too, the system's clock when the run told it, so that a receiver can tell a late one from a fresh one.
    ``picture`` is the (h, w, 3) RGB picture of a reading where the hook asked for pictures.
    """

    kind: Kind
    record: Record
    picture: NDArray[np.uint8] | None = None


def told(kind: Kind, record: Mapping[str, Any]) -> Message:
    """Return ``record`` as a message, stamped with the system's clock."""
    return Message(kind, {**record, "unix_s": _now_s()})


def reading_told(index: int, reading: Reading, picture: NDArray[np.uint8] | None = None) -> Message:
    """Return the reading of frame ``index`` as a message."""
    numbers = (round(float(value), 6) for value in reading[:5])
    values = (int(index), *numbers, *map(int, reading.spikes), bool(reading.collision), reading.state)
    record = {"type": "reading"} | dict(zip(TRACE_DTYPE.names or (), values, strict=True))
    return Message("reading", record | {"unix_s": _now_s()}, picture)


def header_told(header: Mapping[str, Any]) -> Record:
    """Return the header as records on a wire show it: without the list of settings."""
    return {key: header[key] for key in HEADER_KEYS if key in header} | {"unix_s": _now_s()}


def line(record: Mapping[str, Any]) -> bytes:
    """Return ``record`` as one line of NDJSON."""
    return json.dumps(record, separators=(",", ":"), allow_nan=False).encode() + b"\n"


def _now_s() -> float:
    return round(time.time(), 3)
