"""Readings as the page gets them: numbered, in columns; the newest of a live run, all of a recording."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..types import NEURONS, STATES, Reading

ROW = np.dtype(
    [("time_s", "<f8"), ("frame", "<u4"), ("potentials", "<f4", 4), ("spikes", "u1", 4), ("state", "u1"),
     ("collision", "u1")]
)  # fmt: skip
"""One frame's reading; potentials and spikes in the order of NEURONS, ``state`` the place in STATES."""

_MOST_SPIKES = 255
_STATE_CODES = {state: code for code, state in enumerate(STATES)}


class Rows:
    """A table of ``ROW``, one row a frame, filled by one thread and read by another.

    Rows are numbered from 0. With ``keep``, at least the newest that many are kept, at most twice as many; without,
    all are. ``version`` counts how often the table was begun anew.
    """

    def __init__(self, keep: int | None = None) -> None:
        self._keep = keep
        self._lock = threading.Lock()
        self._table = np.zeros(2 * keep if keep else 1024, ROW)
        self._base = self._end = 0
        self.version = 0

    def __len__(self) -> int:
        """Rows there ever were, those no longer kept included."""
        return self._end

    def append(self, index: int, reading: Reading) -> None:
        """Add the reading of frame ``index``."""
        potentials = (reading.lgmd1, reading.lgmd2, reading.lptc_r, reading.lptc_l)
        spikes = tuple(min(count, _MOST_SPIKES) for count in reading.spikes)
        row = (reading.time_s, index, potentials, spikes, _STATE_CODES[reading.state], reading.collision)
        with self._lock:
            self._make_room(self._end + 1)
            self._table[self._end - self._base] = row
            self._end += 1

    def put(self, number: int, rows: NDArray[Any]) -> None:
        """Lay ``rows`` from row ``number`` on, over those that are there; no gap may be left."""
        with self._lock:
            self._make_room(number + len(rows))
            self._table[number - self._base : number - self._base + len(rows)] = rows
            self._end = max(self._end, number + len(rows))

    def restart(self) -> None:
        """Begin anew: what is put from now on takes the place of what was there."""
        with self._lock:
            self._base = self._end = 0
            self.version += 1

    def since(self, version: int, number: int, most: int) -> tuple[int, int, NDArray[Any]]:
        """Return the rows from ``number`` on, at most ``most``; all where they are no longer those of ``version``.

        The answer is the version, the number of the first row, and the rows.
        """
        with self._lock:
            first = min(max(number if version == self.version else 0, self._base), self._end)
            rows = self._table[first - self._base : min(self._end, first + most) - self._base].copy()
            return self.version, first, rows

    def _make_room(self, end: int) -> None:
        if end - self._base <= len(self._table):
            return
        if self._keep is None:
            larger = np.zeros(max(end, 2 * len(self._table)), ROW)
            larger[: self._end] = self._table[: self._end]
            self._table = larger
            return
        gone = end - self._keep - self._base
        left = max(0, self._end - self._base - gone)
        self._table[:left] = self._table[gone : gone + left].copy()
        self._base += gone


def rows_of(trace: NDArray[Any]) -> NDArray[Any]:
    """Return a trace, (n,) TRACE_DTYPE, as (n,) ROW."""
    rows = np.zeros(len(trace), ROW)
    rows["time_s"], rows["frame"], rows["collision"] = trace["time_s"], trace["frame"], trace["collision"]
    for i, name in enumerate(NEURONS):
        rows["potentials"][:, i] = trace[name]
        rows["spikes"][:, i] = np.minimum(trace[f"spikes_{name}"], _MOST_SPIKES)
    for state, code in _STATE_CODES.items():
        rows["state"][trace["state"] == state] = code
    return rows


def columns(rows: NDArray[Any]) -> bytes:
    """Return (n,) ROW column by column, little-endian: 8 n bytes of times first, so that every column is aligned."""
    return b"".join(np.ascontiguousarray(rows[name]).tobytes() for name in ROW.names or ())
