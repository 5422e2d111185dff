"""A run in the arena as a film or a picture, from its record alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

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
from ..errors import ParameterError
from ..model.network import NetworkParams
from ..model.neurons.spiking import SpikingParams, spike_count
from ..model.presets import NAMES, NEURONS, preset
from ..params import settings_hash
from ..report.arena_marks import Marks
from ..report.arena_plan import ArenaPlan
from ..report.arena_video import ArenaVideo, Line, Own, Tale, write_still
from ..report.arena_view import Course
from ..runtime.header import thresholds
from ..runtime.interrupts import Interrupts
from ..types import Reading, Spikes

LONGEST_S = 180.0
"""A film whose speed is not asked for is no longer than this."""

MOST_FPS = 30.0
SPEEDS = (1 / 64, 256.0)
_BATCH = 4


class Film(NamedTuple):
    """What was written: where, how many pictures, how long it plays, how many times as fast as the run."""

    path: Path
    frames: int
    duration_s: float
    speed: float


def save_film(
    record: Record, path: str | Path, *, robot: int = 0, start_s: float | None = None, end_s: float | None = None,
    speed: float | None = None, params: NetworkParams | None = None, advance: Callable[[], None] | None = None,
) -> Film:  # fmt: skip
    """Write ``path``, an MP4 that browsers play: the arena from above, and the view and potentials of ``robot``.

    Parameters
    ----------
    start_s, end_s : the part of the run to show; all of it
    speed : times as fast as the run; 1, or the power of two that makes a long run a film of three minutes at most
    params : settings of the network, for thresholds and spikes; found among the presets where nothing is given. With
        other settings the thresholds are the paper's
    advance : called after each picture

    Raises
    ------
    ParameterError : no such robot, an empty part, a speed out of range, a name that does not end in .mp4
    OutputError : the file cannot be written
    Interrupted : Ctrl-C or SIGTERM, taken between two pictures; ``NAME.part.mp4`` holds what there is, and plays
    """
    path = Path(path)
    if path.suffix.lower() != ".mp4":
        raise ParameterError(f"film {path}: must end in .mp4")
    robots = record.poses.shape[1]
    if not 0 <= robot < robots:
        raise ParameterError(f"robot {robot}: must be one of 0..{robots - 1}")
    rate_hz = record.world.camera.rate_hz
    frames, speed = frames_of(len(record.poses), rate_hz, start_s=start_s, end_s=end_s, speed=speed)
    known = _preset_of(record)
    params = params or (known and known[1])
    own = Own(robot, _readings(record, robot, params), thresholds(params or preset("paper")), _log(record, robot))
    fps = rate_hz * speed / frames.step
    about = {"seed": record.seed, "controller": record.controller, "robot": robot, "speed": speed}
    video = ArenaVideo(path, tell(record), own, speed=speed, fps=fps, about=about)
    try:
        with Interrupts() as interrupts:
            for frame, image in interrupts.between(_pictures(record, robot, frames)):
                video.frame(frame, image)
                if advance:
                    advance()
    except BaseException:  # Ctrl-C too: the part stays and plays
        video.abandon()
        raise
    video.finish()
    return Film(path, len(frames), len(frames) / fps, speed)


def frames_of(
    count: int, rate_hz: float, *, start_s: float | None = None, end_s: float | None = None, speed: float | None = None
) -> tuple[range, float]:
    """Return which of a run's ``count`` frames a film shows, and how many times as fast; as for ``save_film``.

    Raises
    ------
    ParameterError : an empty part, a speed out of range
    """
    part = _part(count, rate_hz, start_s, end_s)
    speed = _fitting(len(part) / rate_hz) if speed is None else speed
    if not SPEEDS[0] <= speed <= SPEEDS[1]:
        raise ParameterError(f"speed {speed!r}: must be from 1/64 to {SPEEDS[1]:g} times as fast as the run")
    return part[:: max(1, math.ceil(rate_hz * speed / MOST_FPS - 1e-9))], speed


def save_still(record: Record, path: str | Path, *, start_s: float | None = None, end_s: float | None = None) -> None:
    """Write ``path``, a PNG: the run from above with all tracks and events.

    Raises
    ------
    ParameterError : an empty part, a name that does not end in .png
    OutputError : the file cannot be written
    """
    if Path(path).suffix.lower() != ".png":
        raise ParameterError(f"picture {path}: must end in .png")
    part = _part(len(record.poses), record.world.camera.rate_hz, start_s, end_s)
    write_still(path, tell(record, part))


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
    robots, known = record.poses.shape[1], _preset_of(record)
    title = f"{robots} robot{'s' * (robots > 1)}, seed {record.seed}, {known[0] if known else record.controller}"
    return Tale(plan, course, _marks(record, events, part.start), title, _scores(events))


def _part(count: int, rate_hz: float, start_s: float | None, end_s: float | None) -> range:
    first = 0 if start_s is None else math.ceil(start_s * rate_hz - 1e-6)
    last = count if end_s is None else min(count, math.ceil(end_s * rate_hz - 1e-6))
    if not 0 <= first < last:
        of = " to ".join("its end" if end is None else f"{end:g} s" for end in (start_s or 0.0, end_s))
        raise ParameterError(f"from {of}: must be a part of the run, 0 to {count / rate_hz:g} s")
    return range(first, last)


def _fitting(length_s: float) -> float:
    return 2.0 ** max(0, math.ceil(math.log2(length_s / LONGEST_S)))


def _pictures(record: Record, robot: int, frames: range) -> Iterator[tuple[int, NDArray[np.uint8]]]:
    """Draw again what the robot saw in each of ``frames``; a few in one go, those between them too."""
    for at in range(0, len(frames), _BATCH):
        batch = frames[at : at + _BATCH]
        images = record.views(robot, batch[0], batch[-1] + 1)[:: frames.step]
        yield from zip(batch, images, strict=True)


def _preset_of(record: Record) -> tuple[str, NetworkParams] | None:
    """Return the preset the controller's hash belongs to, in words too; None for all else."""
    name, _, found = record.controller.partition(" ")
    for base, neurons in product(reversed(NAMES), NEURONS):
        params = preset(base, neurons=neurons)
        if name == "NetworkController" and settings_hash(params) == found:
            return f"preset {base}, neurons {neurons}", params
    return None


def _alarms(record: Record) -> NDArray[np.bool_]:
    """(T, R), from an avoidance on until the turn begins: a single frame is hardly seen."""
    held = record.alarms.copy()
    for frame in range(1, len(held)):
        held[frame] |= held[frame - 1] & (record.phases[frame] == STOP)
    return held


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
