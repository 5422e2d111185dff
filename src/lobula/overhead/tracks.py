"""Tracks: where every robot was in every frame, as a table, as poses per frame, as CSV."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import FrameSourceError
from .room import Room

TRACK_DTYPE = np.dtype(
    [
        ("frame", np.int64),
        ("time_s", np.float64),
        ("id", np.int32),
        *((name, np.float64) for name in ("x_cm", "y_cm", "heading_rad")),
        ("found", np.bool_),
        *((name, np.float64) for name in ("error_cm", "error_rad")),
    ]
)
"""One robot in one frame. ``found`` is false where a short gap was bridged: the errors are NaN there."""

POSE_DTYPE = np.dtype([("x_cm", np.float64), ("y_cm", np.float64), ("heading_rad", np.float64)])

_NEEDED = ("frame", "time_s", "id", "x_cm", "y_cm", "heading_rad", "found")
_MM = 10.0


@dataclass(frozen=True, kw_only=True)
class Tracks:
    """All tracks of one recording.

    ``rows`` (n,) TRACK_DTYPE, by frame and id; a robot that was lost for long has no rows then. ``frames`` (T,) and
    ``times_s`` (T,) are those of the recording; ``ids`` (R,) rise. ``calibration_error_cm`` is NaN where nobody can
    tell. ``left_out`` counts patterns that were seen and not believed, by the reason; ``notes`` are for people.
    ``stopped`` is what ended the tracks before the recording's end: its failure, or an interruption. ``draw``
    makes a picture (H, W, 3) of a frame with the room and the robots drawn in.
    """

    rows: NDArray[np.void]
    frames: NDArray[np.int64]
    times_s: NDArray[np.float64]
    ids: tuple[int, ...]
    room: Room
    source: str = ""
    calibration_error_cm: float = math.nan
    left_out: dict[str, int] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    stopped: BaseException | None = None
    draw: Callable[[], NDArray[np.uint8]] | None = field(default=None, repr=False)

    def poses(self) -> NDArray[np.void]:
        """Return (T, R) POSE_DTYPE: a row for every frame, a column for every robot, NaN where it is not known."""
        table = np.full((len(self.frames), len(self.ids)), np.nan, np.float64).astype(POSE_DTYPE)
        place = np.searchsorted(self.frames, self.rows["frame"]), np.searchsorted(self.ids, self.rows["id"])
        for name in POSE_DTYPE.names or ():
            table[name][place] = self.rows[name]
        return table

    def summary(self) -> dict[str, Any]:
        """Return what there is to say about the tracks, ready for JSON: errors in mm and degrees, None if unknown."""
        count, duration_s = len(self.frames), float(self.times_s[-1] - self.times_s[0]) if len(self.times_s) else 0.0
        found = self.rows[self.rows["found"]]
        return {
            "source": self.source,
            "room": str(self.room),
            "frames": count,
            "duration_s": round(duration_s, 6),
            "rate_hz": round((count - 1) / duration_s, 4) if duration_s else None,
            "found_share": len(found) / (count * len(self.ids)) if self.ids else 0.0,
            **_errors(found),
            "calibration_error_mm": _rounded(self.calibration_error_cm * _MM),
            "robots": [self._robot(one) for one in self.ids],
            "left_out": dict(self.left_out),
            "notes": list(self.notes),
            "status": "ok" if self.stopped is None else str(self.stopped),
        }

    def _robot(self, one: int) -> dict[str, Any]:
        rows = self.rows[self.rows["id"] == one]
        found = rows[rows["found"]]
        steps = np.hypot(np.diff(rows["x_cm"]), np.diff(rows["y_cm"]))
        whole = np.searchsorted(self.frames, rows["frame"])
        return {
            "id": one,
            "found_share": len(found) / len(self.frames),
            "bridged_share": (len(rows) - len(found)) / len(self.frames),
            "distance_cm": round(float(steps[np.diff(whole) == 1].sum()), 3),
            **_errors(found),
        }


def tracks_csv(rows: NDArray[np.void]) -> Iterable[str]:
    """Yield the lines of a CSV file with the columns of ``TRACK_DTYPE``; ``found`` is 1 or 0."""
    yield ",".join(TRACK_DTYPE.names or ()) + "\n"
    for frame, time_s, one, x, y, heading, found, error_cm, error_rad in rows.tolist():
        errors = f"{error_cm:.5f},{error_rad:.6f}" if found else ","
        yield f"{frame},{time_s:.6f},{one},{x:.4f},{y:.4f},{heading:.5f},{int(found)},{errors}\n"


def read_tracks(path: str | Path, room: Room) -> Tracks:
    """Return the tracks that ``tracks_csv`` wrote to ``path``; columns of errors may be missing, others are ignored.

    Frames in which no robot was seen are not in such a file and so not in the tracks.

    Raises
    ------
    FrameSourceError : it cannot be read, has no rows, lacks a column, or a value is no number
    """
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as file:
            rows = [_row(line) for line in csv.DictReader(file)]
    except OSError as error:
        raise FrameSourceError(f"tracks {path}: cannot be read: {error.strerror}") from error
    except (KeyError, TypeError, ValueError) as error:
        raise FrameSourceError(f"tracks {path}: every row must hold numbers in {', '.join(_NEEDED)}") from error
    if not rows:
        raise FrameSourceError(f"tracks {path}: has no rows")
    table = np.array(rows, TRACK_DTYPE)
    table = table[np.lexsort((table["id"], table["frame"]))]
    frames, first = np.unique(table["frame"], return_index=True)
    ids = tuple(np.unique(table["id"]).tolist())
    return Tracks(rows=table, frames=frames, times_s=table["time_s"][first], ids=ids, room=room, source=str(path))


def _row(line: dict[str, str]) -> tuple[float, ...]:
    errors = (float(line.get(name) or "nan") for name in ("error_cm", "error_rad"))
    frame, time_s, one, x, y, heading, found = (float(line[name]) for name in _NEEDED)
    if not all(map(math.isfinite, (frame, time_s, one, x, y, heading))):
        raise ValueError(line)
    return int(frame), time_s, int(one), x, y, heading, bool(int(found)), *errors


def _errors(found: NDArray[np.void]) -> dict[str, float | None]:
    """Root mean square of the standard errors."""
    mean2 = {name: float(np.mean(found[name] ** 2)) if len(found) else math.nan for name in ("error_cm", "error_rad")}
    return {
        "error_mm": _rounded(math.sqrt(mean2["error_cm"]) * _MM),
        "error_deg": _rounded(math.degrees(math.sqrt(mean2["error_rad"]))),
    }


def _rounded(value: float) -> float | None:
    return round(value, 5) if math.isfinite(value) else None
