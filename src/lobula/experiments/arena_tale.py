"""What the drawings of a run need, told from its record: in plain arrays and words."""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arena.chance import Chance
from ..arena.contact import WALL
from ..arena.events import CONTACTS, NOTHING, name_of, obstacle_number
from ..arena.motion import FORWARD, STOP
from ..arena.record import Record
from ..arena.scene import build_scene
from ..arena.scoring import Tally
from ..arena.world import World
from ..model.network import NetworkParams
from ..model.neurons.spiking import SpikingParams, spike_count
from ..model.presets import NAMES, NEURONS, preset
from ..params import to_dict, with_settings
from ..report.arena_marks import Marks
from ..report.arena_plan import ArenaPlan
from ..report.arena_video import Line, Own, Tale
from ..report.arena_view import Course
from ..runtime.header import thresholds
from ..types import Reading, Spikes


def tell(record: Record, part: range | None = None) -> Tale:
    """Return what the drawings need of a record, or of ``part`` of its frames."""
    part = range(len(record.poses)) if part is None else part
    world, frames = record.world, slice(part.start, part.stop)
    events = record.events[(record.events["tick"] >= part.start) & (record.events["tick"] < part.stop)]
    course = Course(
        record.times_s[frames], record.poses[frames], record.phases[frames] != FORWARD, _alarms(record)[frames]
    )
    scene = build_scene(world, Chance(record.seed, record.poses.shape[1]).texture)
    plan = ArenaPlan(
        circle=world.room.shape == "circle",
        size_cm=world.room.size_cm,
        wall_grey=scene.wall_grey,
        obstacles_cm=np.array([[o.x_cm, o.y_cm, o.radius_cm] for o in world.obstacles]).reshape(-1, 3),
        body_cm=world.body.radius_cm,
        pupil_cm=world.camera.ahead_cm,
        fov_deg=world.camera.fov_deg,
    )
    robots = record.poses.shape[1]
    title = f"{robots} robot{'s' * (robots > 1)}, seed {record.seed}, {driver_of(record)}"
    return Tale(plan, course, _marks(record, events, part.start), title, _scores(events))


def network_of(record: Record) -> NetworkParams | None:
    """Return the settings of the networks that drove the robots; None where something else did.

    Raises
    ------
    ParameterError : settings that this version does not know
    """
    plain = NetworkParams()
    if record.settings is None or record.settings.keys() != to_dict(plain).keys():
        return None
    params: NetworkParams = with_settings(plain, record.settings, "record")
    return params


def driver_of(record: Record) -> str:
    """Return what drove the robots in words: the preset, where the settings are one's, else the controller."""
    for base, neurons in product(reversed(NAMES), NEURONS):
        if record.settings == to_dict(preset(base, neurons=neurons)):
            return f"preset {base}, neurons {neurons}"
    return record.controller


def _alarms(record: Record) -> NDArray[np.bool_]:
    """(T, R), from an avoidance on until the turn begins: a single frame is hardly seen."""
    held = record.alarms.copy()
    for frame in range(1, len(held)):
        held[frame] |= held[frame - 1] & (record.phases[frame] == STOP)
    return held


def tell_own(record: Record, robot: int) -> Own:
    """Return what a film shows of ``robot``: its potentials with the thresholds of its network, else the paper's."""
    params = network_of(record)
    return Own(robot, _readings(record, robot, params), thresholds(params or preset("paper")), _log(record, robot))


def _readings(record: Record, robot: int, params: NetworkParams | None) -> list[Reading] | None:
    """What the robot's network said in each frame; None where the controller has no potentials."""
    if record.potentials is None:
        return None
    encoders = [SpikingParams()] * 2 + [SpikingParams(threshold=0.2)] * 2
    if params:
        encoders = [params.lgmd1.spiking, params.lgmd2.spiking, params.lptc.spiking, params.lptc.spiking]
    turning, alarms = (record.phases[:, robot] != FORWARD).tolist(), _alarms(record)[:, robot].tolist()
    readings = []
    for at_s, u, turns, alarm in zip(
        record.times_s.tolist(), record.potentials[:, robot].astype(np.float64).tolist(), turning, alarms, strict=True
    ):
        counts = (spike_count(value, p) for value, p in zip(u, encoders, strict=True))
        lgmd1, lgmd2, lptc_r, lptc_l = u
        said = Reading(
            at_s, lgmd1, lgmd2, lptc_r, lptc_l, Spikes(*counts), alarm, "turning" if turns and not alarm else "ok"
        )
        readings.append(said)
    return readings


def _marks(record: Record, events: NDArray[Any], first: int) -> Marks:
    places = [_place(record, event) for event in events]
    return Marks(events["tick"] - first, events["kind"].astype(str), np.array(places, np.float64).reshape(-1, 2))


def _log(record: Record, robot: int) -> list[Line]:
    """Everything that happened to the robot, what others did to it included."""
    lines = []
    for event in record.events:
        kind, other = str(event["kind"]), int(event["other"])
        if event["robot"] == robot:
            words = ("touched " if kind in CONTACTS else "avoided ") + _named(other)
        elif kind in CONTACTS and other == robot:
            words = f"was touched by {name_of(int(event['robot']))}"
        else:
            continue
        lines.append(Line(int(event["tick"]), kind, words))
    return lines


def _named(other: int) -> str:
    return name_of(other) if other >= 0 or other == NOTHING else f"the {name_of(other)}"


def _place(record: Record, event: Any) -> tuple[float, float]:
    """Where an event is drawn: a contact where the two touched, an avoidance where the robot was."""
    tick, other = int(event["tick"]), int(event["other"])
    x, y, _ = record.poses[tick, event["robot"]].tolist()
    if event["kind"] not in CONTACTS or other == NOTHING:
        return x, y
    if other >= 0:
        there = record.poses[tick, other]
        return (x + float(there[0])) / 2, (y + float(there[1])) / 2
    if other == WALL:
        return _wall_beside(record.world, x, y)
    obstacle = record.world.obstacles[obstacle_number(other)]
    way = complex(x - obstacle.x_cm, y - obstacle.y_cm)
    on_it = complex(obstacle.x_cm, obstacle.y_cm) + obstacle.radius_cm * way / abs(way)
    return on_it.real, on_it.imag


def _wall_beside(world: World, x: float, y: float) -> tuple[float, float]:
    """Return the place on the wall that is nearest to a place."""
    width, depth = world.room.size_cm
    if world.room.shape == "circle":
        middle = complex(width / 2, width / 2)
        way = complex(x, y) - middle
        on_it = middle + width / 2 * way / (abs(way) or 1)
        return on_it.real, on_it.imag
    on_sides = [(x, 0.0), (x, depth), (0.0, y), (width, y)]
    return min(on_sides, key=lambda place: math.dist(place, (x, y)))


def _scores(events: NDArray[Any]) -> list[str]:
    """The success rates after none, one, two, ... of the events."""
    kinds: dict[str, int] = dict.fromkeys(("cr", "cp", "aa", "at", "ap", "spurious"), 0)
    lines = [_in_words(Tally())]
    for kind in events["kind"].tolist():
        kinds[kind.lower()] += 1
        lines.append(_in_words(Tally(**kinds)))
    return lines


def _in_words(tally: Tally) -> str:
    return "   ".join(
        f"{name} {'-' if math.isnan(rate) else f'{100 * rate:.0f} %'}"
        for name, rate in (("SR1", tally.sr1), ("SR2", tally.sr2))
    )
