"""A run in the words of ROS: what goes into which standard message, for bags and for the node alike.

Source: docs.ros.org, packages std_msgs, sensor_msgs and diagnostic_msgs.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from ..types import NEURONS
from .said import said

OK, WARN, ERROR, STALE = 0, 1, 2, 3
"""Levels of a diagnostic_msgs/DiagnosticStatus."""

POTENTIALS_LABEL = " ".join(NEURONS)
"""What the numbers of an array stand for: the label of its only dimension."""


class Status(NamedTuple):
    """The fields of a DiagnosticStatus."""

    level: int
    name: str
    message: str
    values: list[tuple[str, str]]


def potentials(record: Mapping[str, Any]) -> list[float]:
    """Return the four potentials of a reading, as ``NEURONS`` names them."""
    return [float(record[name]) for name in NEURONS]


def spikes(record: Mapping[str, Any]) -> list[int]:
    """Return the spikes of the four neurons in the frame of a reading."""
    return [int(record[f"spikes_{name}"]) for name in NEURONS]


def alarm(record: Mapping[str, Any]) -> bool | None:
    """Return whether the alarm is on after this event, None for an event that does not say."""
    return record["phase"] == "start" if record["type"] == "collision" else None


def reading_status(record: Mapping[str, Any]) -> Status:
    """Return a reading as a status: an alarm is an error, a state in which nothing is decided a warning."""
    if record["collision"]:
        level, text = ERROR, "collision"
    else:
        level, text = {"ok": OK, "stale": STALE}.get(record["state"], WARN), str(record["state"]).replace("_", " ")
    return Status(level, "lobula: reading", text, _values(record))


def status(record: Mapping[str, Any]) -> Status:
    """Return an event or the summary as a status: a collision is an error, a lost or silent source is stale.

    A state or a hook's trouble that begins is a warning.
    """
    kind, phase = record["type"], record.get("phase")
    if (kind, phase) == ("collision", "start"):
        level = ERROR
    elif (kind, phase) == ("source", "lost") or (record.get("state"), phase) == ("stale", "start"):
        level = STALE
    elif kind in ("state", "hook") and phase == "start":
        level = WARN
    else:
        level = OK
    return Status(level, f"lobula: {kind}", said(record), _values(record))


def _values(record: Mapping[str, Any]) -> list[tuple[str, str]]:
    return [(key, str(value)) for key, value in record.items()]
