"""Robots that were watched from above, scored as those of the simulated arena are.

Nobody can draw a real room again without one of its robots, so the cause of an avoidance is the one by the geometric
rule. What was in view is computed from where everybody was, as if the robots had the cameras of ``world``.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arena.cause import approach, geometric_cause, kind_of
from ..arena.contact import WALL, Episodes, Surroundings
from ..arena.events import event_table, obstacle_number
from ..arena.geometry import incidence_deg, touched_wall_normal
from ..arena.scoring import Score, counts
from ..arena.sight import could_see, objects
from ..arena.world import World
from ..errors import ParameterError
from ..overhead import Room, Tracks
from .manoeuvres import Manoeuvre, ManoeuvreParams
from .tracked_history import TrackedHistory, answered

_ROOM_TOLERANCE_CM = 0.5


class Scored(NamedTuple):
    """The score of a recording and its events, EVENT_DTYPE; ``robot`` and ``other`` there are the ids of the patterns.

    ``tick`` counts the frames of the recording from 0. ``answers`` is how many manoeuvres came with a touch.
    """

    score: Score
    events: NDArray[Any]
    answers: int


class Touched(NamedTuple):
    """A contact: columns of the robot and of what it touched (or its code), and the first frame in which they touch."""

    robot: int
    other: int
    frame: int


def score_tracks(tracks: Tracks, world: World | None = None, params: ManoeuvreParams | None = None) -> Scored:
    """Return the contacts and avoidances in ``tracks``.

    Parameters
    ----------
    tracks : what ``overhead.track`` or ``overhead.read_tracks`` gave
    world : the robots' size, their cameras, obstacles and the rules of scoring; if left out the paper's arena in the
        room of the tracks
    params : what counts as a manoeuvre and as a touch

    Raises
    ------
    ParameterError : the room of the world is not that of the tracks, or there are fewer than three frames
    """
    params = params or ManoeuvreParams()
    world = _timed(world or world_of(tracks.room), tracks)
    history = TrackedHistory(tracks, world, params)
    contacts, touching = contacts_of(history, world, params)
    within = round(params.touch_s / world.tick_s)
    free = [turn for turn in history.turns if not answered(turn, touching, within)]
    rows = [_avoidance(history, turn, world) for turn in free]
    rows += [_contact(history, contact, world) for contact in contacts]
    events = event_table(sorted(rows, key=lambda row: row["tick"]))
    for column in ("robot", "other", "geometric_other"):
        named = events[column]
        named[named >= 0] = np.array(tracks.ids)[named[named >= 0]]
    minutes = float(history.known.sum()) * world.tick_s / 60
    score = counts(events, robot_minutes=minutes, distance_cm=history.driven_cm, rule="geometric")
    return Scored(score, events, len(history.turns) - len(free))


def world_of(room: Room, world: World | None = None) -> World:
    """Return ``world`` (the paper's, if left out) with the plan of ``room``."""
    world = world or World()
    if room.shape == "circle":
        return replace(world, room=replace(world.room, shape="circle", radius_cm=room.width_cm / 2))
    return replace(world, room=replace(world.room, shape="box", width_cm=room.width_cm, depth_cm=room.depth_cm))


def contacts_of(
    history: TrackedHistory, world: World, params: ManoeuvreParams
) -> tuple[list[Touched], NDArray[np.bool_]]:
    """Return the contacts, one for each episode, and who touches anything in which frame (T, R).

    A touch that the recording begins with is none that came about in it. Of two robots the one that drove faster
    towards the other is named first.
    """
    frames, robots = history.known.shape
    around = Surroundings(world, robots)
    episodes = Episodes(world, around)
    touching = np.zeros((frames, robots), np.bool_)
    contacts = []
    pairs = [(robot, column) for robot in range(robots) for column in range(robot + 1, around.wall + 1)]
    for frame, xy in enumerate(history.poses[..., :2].tolist()):
        places = [complex(x, y) for x, y in xy]
        for robot, column in pairs:
            if not around.gap_cm(places, robot, column) <= params.touch_cm:  # who is not known touches nothing
                continue
            touching[frame, [one for one in (robot, column) if one < robots]] = True
            if episodes.begin(robot, column) and frame:
                who, other = (robot, around.code(column))
                if other >= 0 and _drives_at(history, frame, other, robot) > _drives_at(history, frame, robot, other):
                    who, other = other, robot
                contacts.append(Touched(who, other, frame))
        episodes.step(places)
    return contacts, touching


def _drives_at(history: TrackedHistory, frame: int, robot: int, other: int) -> float:
    """Return how fast ``robot`` drove towards ``other`` just before ``frame``, times their distance."""
    way = history.poses[frame, other, :2] - history.poses[frame, robot, :2]
    return float(np.nan_to_num(history.velocities_cm_s(frame - 1, robot)[robot]) @ way)


def _avoidance(history: TrackedHistory, turn: Manoeuvre, world: World) -> dict[str, Any]:
    past, here = history.past(turn.alarm, turn.robot)
    robot = here.index(turn.robot)
    about = objects(past, robot, world)
    cause = geometric_cause(past, robot, about, world)
    kind = kind_of(cause, past, robot, world)
    found = next((one for one in about if one.other == cause.other), None)
    other = here[cause.other] if cause.other >= 0 else cause.other
    return _row(history, turn.alarm, turn.robot, kind, other) | {
        "distance_cm": cause.distance_cm,
        "miss_cm": approach(past, robot, cause.other, world)[1] if cause.other >= 0 else math.nan,
        "incidence_deg": found.incidence_deg if found else math.nan,
        "seen": found is not None and found.in_view_now,
        "rule": cause.rule,
    }


def _contact(history: TrackedHistory, contact: Touched, world: World) -> dict[str, Any]:
    robots = [contact.robot, *([contact.other] if contact.other >= 0 else [])]
    # the last frame before it; the first with it where one of them was just found again
    frame = contact.frame - (1 if history.known[contact.frame - 1, robots].all() else 0)
    past, here = history.past(frame, contact.robot)
    robot, other = here.index(contact.robot), contact.other
    other = here.index(other) if other >= 0 else other
    x, y, heading = history.poses[contact.frame, contact.robot].tolist()
    direction = _direction(history, contact, (x, y), world)
    reach = world.body.radius_cm
    touched = (x + reach * math.cos(direction), y + reach * math.sin(direction))
    return _row(history, frame, contact.robot, "CR" if other >= 0 else "CP", contact.other) | {
        "distance_cm": next(one.distance_cm for one in objects(past, robot, world) if one.other == other),
        "incidence_deg": incidence_deg(heading, direction),
        "seen": could_see(past, robot, other, touched, world),
        "seen_by_other": other >= 0 and could_see(past, other, robot, touched, world),
    }


def _direction(history: TrackedHistory, contact: Touched, place: tuple[float, float], world: World) -> float:
    """Return where what is touched lies as seen from the robot's middle, rad."""
    if contact.other == WALL:
        return touched_wall_normal(world.room, place)
    if contact.other >= 0:
        x, y = history.poses[contact.frame, contact.other, :2].tolist()
    else:
        obstacle = world.obstacles[obstacle_number(contact.other)]
        x, y = obstacle.x_cm, obstacle.y_cm
    return cmath.phase(complex(x - place[0], y - place[1]))


def _row(history: TrackedHistory, frame: int, robot: int, kind: str, other: int) -> dict[str, Any]:
    row = {"tick": frame, "time_s": float(history.times_s[frame]), "robot": robot, "kind": kind, "other": other}
    return row | {"geometric": kind, "geometric_other": other}


def _timed(world: World, tracks: Tracks) -> World:
    """Return ``world`` at the rate of the recording.

    Raises
    ------
    ParameterError : its room is not that of the tracks, or there are too few frames
    """
    width, depth = world.room.size_cm
    off_cm = max(abs(width - tracks.room.width_cm), abs(depth - tracks.room.depth_cm))
    if world.room.shape != tracks.room.shape or off_cm > _ROOM_TOLERANCE_CM:
        raise ParameterError(f"world: its room is {world.room_text}: must be that of the tracks, {tracks.room}")
    if len(tracks.times_s) < 3:
        raise ParameterError(f"tracks {tracks.source}: {len(tracks.times_s)} frames: must be at least 3 to be scored")
    rate_hz = 1 / float(np.median(np.diff(tracks.times_s)))
    return replace(world, camera=replace(world.camera, rate_hz=rate_hz))
