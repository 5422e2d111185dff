"""Short misses bridged, wild sightings taken out: one robot's track made whole."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .tracks import TRACK_DTYPE


def plausible(rows: NDArray[np.void], fastest_cm_s: float) -> NDArray[np.bool_]:
    """Return which sightings (n,) of one robot are believed; they are in the order of time.

    One that nobody can drive to from the one before and away from to the one after, though those two fit together, is
    a misread pattern of something else.
    """
    believed = np.ones(len(rows), np.bool_)
    if len(rows) < 3:
        return believed
    z, t = rows["x_cm"] + 1j * rows["y_cm"], rows["time_s"]
    too_fast = np.abs(np.diff(z)) > fastest_cm_s * np.diff(t)
    fits_without = np.abs(z[2:] - z[:-2]) <= fastest_cm_s * (t[2:] - t[:-2])
    believed[1:-1] = ~(too_fast[:-1] & too_fast[1:] & fits_without)
    believed[0] = not (too_fast[0] and not too_fast[1])
    believed[-1] = not (too_fast[-1] and not too_fast[-2])
    return believed


def bridged(
    rows: NDArray[np.void], frames: NDArray[np.int64], times_s: NDArray[np.float64], max_gap_s: float
) -> NDArray[np.void]:
    """Return the track of one robot with the frames between two sightings at most ``max_gap_s`` apart filled in.

    Place and heading run evenly from one sighting to the next, the heading the shorter way; ``found`` is false there.
    """
    place = np.searchsorted(frames, rows["frame"])
    between = np.arange(place[0], place[-1] + 1) if len(place) else np.empty(0, np.int64)
    missing = np.setdiff1d(between, place)
    after = np.searchsorted(place, missing)
    start, end = rows[after - 1], rows[after]
    short = end["time_s"] - start["time_s"] <= max_gap_s
    missing, start, end = missing[short], start[short], end[short]
    share = (times_s[missing] - start["time_s"]) / (end["time_s"] - start["time_s"])
    turn = (end["heading_rad"] - start["heading_rad"] + math.pi) % (2 * math.pi) - math.pi
    filled = np.zeros(len(missing), TRACK_DTYPE)
    filled["frame"], filled["time_s"], filled["id"] = frames[missing], times_s[missing], start["id"]
    for name in ("x_cm", "y_cm"):
        filled[name] = start[name] + share * (end[name] - start[name])
    filled["heading_rad"] = (start["heading_rad"] + share * turn + math.pi) % (2 * math.pi) - math.pi
    filled["error_cm"] = filled["error_rad"] = math.nan
    whole = np.concatenate([rows, filled])
    return whole[np.argsort(whole["frame"], kind="stable")]
