"""What is counted: a table of events, one row for each avoidance and each contact."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..types import NEURONS
from .contact import WALL, obstacle_code

NOTHING = int(np.iinfo(np.int16).min)
"""Code of no cause at all in the column ``other``; ``contact`` has those of the wall and of the obstacles."""

AVOIDANCES = ("AA", "AT", "AP", "spurious")
CONTACTS = ("CR", "CP")
KINDS = (*CONTACTS, *AVOIDANCES)
"""CR, CP: contacts with robots and with the periphery (wall or obstacle). AA, AT: avoidances of approaching and of
translating robots. AP: avoidances of the periphery. Spurious: avoidances of nothing near."""

RULES = ("alone", "together", "none", "geometric")
"""How the cause of an avoidance was found, see ``cause``: its removal alone removed the trigger; only that of all
near objects did, and it is the nearest; none did; or by the geometric rule."""

EVENT_DTYPE = np.dtype(
    [
        ("tick", np.int64),
        ("time_s", np.float64),
        ("kind", "U8"),
        ("robot", np.int16),
        ("other", np.int16),
        ("distance_cm", np.float64),
        ("miss_cm", np.float64),
        ("incidence_deg", np.float64),
        ("seen", np.bool_),
        ("seen_by_other", np.bool_),
        ("rule", "U9"),
        ("geometric", "U8"),
        ("geometric_other", np.int16),
    ]
    + [(name, np.float64) for name in NEURONS]
)
"""Columns of the event table.

tick, time_s : of the frame that raised the alarm, or of the last frame before the contact
kind : one of ``KINDS``
robot, other : who, and because of whom: a robot's index, or a code below zero
distance_cm : from the pupil to the surface of ``other`` at that frame
miss_cm : avoidance of a robot: the gap that would have been left had both driven on, below 0 where they would have
    overlapped; NaN for all else
incidence_deg : between the heading and the way to what was met or avoided: 0 is head-on; for the wall its normal
seen : avoidance: ``other`` was in view at that frame. Contact: the robot could have seen it coming, which means
    that it was not turning and had ``other`` in view at some time in the last second
seen_by_other : contact of two robots: the same of the other one
rule : how the cause was found, one of ``RULES``; empty for contacts
geometric, geometric_other : kind and cause by the geometric rule alone
lgmd1, lgmd2, lptc_r, lptc_l : the robot's strongest potentials of the last 0.2 s; NaN where the controller has none
"""


def obstacle_number(other: int) -> int:
    """Return which obstacle of the world a code below WALL means."""
    return obstacle_code(0) - other


def name_of(other: int) -> str:
    """Return a code of the column ``other`` in words."""
    if other >= 0:
        return f"robot {other}"
    return {NOTHING: "nothing", WALL: "wall"}.get(other, f"obstacle {obstacle_number(other)}")


def event_table(rows: list[dict[str, Any]] | None = None) -> NDArray[Any]:
    """Return ``rows`` as a table, (N,) EVENT_DTYPE; a number that a row does not name is NaN, 0 or NOTHING."""
    rows = rows or []
    table = np.zeros(len(rows), EVENT_DTYPE)
    for name in EVENT_DTYPE.names or ():
        kind = EVENT_DTYPE[name].kind
        missing = {"f": np.nan, "i": NOTHING, "b": False, "U": ""}[kind]
        table[name] = [row.get(name, missing) for row in rows]
    return table
