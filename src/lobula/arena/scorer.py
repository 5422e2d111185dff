"""The referee: watches a simulation and writes down each avoidance and each contact, with its cause."""

from __future__ import annotations

import math
from collections.abc import Mapping
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..types import NEURONS
from .cause import approach, counterfactual_cause, geometric_cause, kind_of
from .contact import Contact
from .controller import can_replay
from .events import event_table
from .geometry import incidence_deg
from .history import Past
from .scoring import Score, counts
from .sight import could_see, objects, recent
from .simulation import Simulation, Tick

STRONGEST_S = 0.2
"""Potentials in an event are the strongest of the last 0.2 s, the window of the network's decision."""


class Scorer:
    """Collects the events of one simulation: call ``tick`` with what each of its ticks returned.

    Attributes
    ----------
    rule : "counterfactual"; or "geometric" where the controller cannot be replayed, and so causes are by place alone
    seconds : time spent so far
    """

    def __init__(self, simulation: Simulation) -> None:
        self.simulation = simulation
        self.rule = "counterfactual" if can_replay(simulation.controller) else "geometric"
        self.seconds = 0.0
        self._rows: list[dict[str, Any]] = []

    def tick(self, tick: Tick) -> None:
        """Take in what happened in the tick the simulation has just gone through.

        Raises
        ------
        ControllerError : the controller raised, or gave no proper answer, when it was asked again
        """
        if not (tick.contacts or tick.avoiding.any()):
            return
        start = perf_counter()
        for robot in np.flatnonzero(tick.avoiding).tolist():
            self._rows.append(self._avoidance(robot))
        for contact in tick.contacts:
            self._rows.append(self._contact(contact))
        self.seconds += perf_counter() - start

    @property
    def events(self) -> NDArray[Any]:
        """The events so far, (N,) EVENT_DTYPE, in the order they came."""
        return event_table(self._rows)

    def newest(self, number: int) -> NDArray[Any]:
        """Return the last ``number`` events."""
        return event_table(self._rows[len(self._rows) - number :])

    def score(self) -> Score:
        """Return the score so far."""
        robots, driven_cm = len(self.simulation.pose), float(self.simulation.robots["distance_cm"].sum())
        minutes = robots * self.simulation.time_s / 60
        return counts(self.events, robot_minutes=minutes, distance_cm=driven_cm, rule=self.rule)

    def state(self) -> dict[str, Any]:
        """Return what is needed to go on later: plain arrays."""
        return {"events": self.events}

    def set_state(self, state: Mapping[str, Any]) -> None:
        """Go on from ``state``, which ``state()`` gave."""
        events = np.asarray(state["events"])
        self._rows = [dict(zip(events.dtype.names or (), row, strict=True)) for row in events.tolist()]

    def _avoidance(self, robot: int) -> dict[str, Any]:
        simulation = self.simulation
        world, past = simulation.world, simulation.past(robot)
        about = objects(past, robot, world)
        by_place = geometric_cause(past, robot, about, world)
        cause, controller = by_place, simulation.controller
        if can_replay(controller):
            cause = counterfactual_cause(past, robot, about, world, simulation.eye, controller)
        found = next((one for one in about if one.other == cause.other), None)
        return _row(past, robot) | {
            "kind": kind_of(cause, past, robot, world),
            "other": cause.other,
            "distance_cm": cause.distance_cm,
            "miss_cm": approach(past, robot, cause.other, world)[1] if cause.other >= 0 else math.nan,
            "incidence_deg": found.incidence_deg if found else math.nan,
            "seen": found is not None and found.in_view_now,
            "rule": cause.rule,
            "geometric": kind_of(by_place, past, robot, world),
            "geometric_other": by_place.other,
        }

    def _contact(self, contact: Contact) -> dict[str, Any]:
        world, robot, other = self.simulation.world, contact.robot, contact.other
        past, kind = self.simulation.past(robot), "CR" if other >= 0 else "CP"
        x, y, _ = self.simulation.pose[robot].tolist()
        reach = world.body.radius_cm
        touched = (x + reach * math.cos(contact.direction_rad), y + reach * math.sin(contact.direction_rad))
        return _row(past, robot) | {
            "kind": kind,
            "other": other,
            "distance_cm": next(one.distance_cm for one in objects(past, robot, world) if one.other == other),
            "incidence_deg": incidence_deg(contact.heading_rad, contact.direction_rad),
            "seen": could_see(past, robot, other, touched, world),
            "seen_by_other": other >= 0 and could_see(past, other, robot, touched, world),
            "geometric": kind,
            "geometric_other": other,
        }


def _row(past: Past, robot: int) -> dict[str, Any]:
    """What every event of ``robot`` tells: when, who, and its strongest potentials of late."""
    row = {"tick": past.first_tick + len(past.times_s) - 1, "time_s": float(past.times_s[-1]), "robot": robot}
    if past.potentials is None:
        return row
    lately = past.potentials[recent(past, STRONGEST_S), robot]
    strongest = lately[np.abs(lately).argmax(axis=0), np.arange(len(NEURONS))]
    return row | dict(zip(NEURONS, strongest.tolist(), strict=True))
