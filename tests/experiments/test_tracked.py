"""Tracks scored: by hand, and against what the simulation itself wrote down of the run they come from."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from lobula.arena.contact import WALL, obstacle_code
from lobula.arena.controls import RandomTurn
from lobula.arena.events import NOTHING
from lobula.arena.scorer import Scorer
from lobula.arena.simulation import Simulation
from lobula.arena.world import Obstacle, RobotParams, World
from lobula.errors import ParameterError
from lobula.experiments.tracked import score_tracks, world_of
from lobula.overhead import TRACK_DTYPE, Room, Tracks

from .test_manoeuvres import course


def tracks_of(poses: np.ndarray, *, ids=None, room: Room | None = None, error_cm: float = 0.0, seed: int = 0) -> Tracks:
    """Robots at ``poses`` (T, R, 3) at 30 Hz, with an error like that of real tracks; NaN where one is not found."""
    rng = np.random.default_rng(seed)
    count, robots, _ = poses.shape
    ids = tuple(range(robots)) if ids is None else ids
    poses = poses + rng.normal(0, (error_cm, error_cm, error_cm / 3), poses.shape)  # the heading's in rad
    frames = np.arange(count)
    rows = np.zeros((count, robots), TRACK_DTYPE)
    rows["frame"], rows["time_s"], rows["id"], rows["found"] = frames[:, None], frames[:, None] / 30, ids, True
    rows["x_cm"], rows["y_cm"], rows["heading_rad"] = np.moveaxis(poses, -1, 0)
    known = np.isfinite(poses[..., 0])
    return Tracks(rows=rows[known], frames=frames, times_s=frames / 30, ids=ids, room=room or Room())


def moved(poses: np.ndarray, x: float, y: float, turn: float) -> np.ndarray:
    """The course begun elsewhere, looking elsewhere."""
    away = poses.copy()
    cosine, sine = math.cos(turn), math.sin(turn)
    away[..., 0] = x + cosine * poses[..., 0] - sine * poses[..., 1]
    away[..., 1] = y + sine * poses[..., 0] + cosine * poses[..., 1]
    away[..., 2] = poses[..., 2] + turn
    return away


TURN = (("stop", 0, 0.2), ("turn", 150, 0.8), ("drive", 8, 1))
APPROACH = course(("drive", 8, 2), *TURN)[0]  # 16 cm, then it turns
STANDS = course(("stop", 0, 4))[0]
DRIVES = course(("drive", 8, 4))[0]


class TestByHand:
    def test_the_wall_is_avoided(self):
        """It turns with its middle 8 cm from the wall: 8 - 1.33 cm before the pupil."""
        scored = score_tracks(tracks_of(moved(APPROACH, 46.0, 27.0, 0.0), ids=(5,)))
        (event,) = scored.events
        assert (event["kind"], event["robot"], event["other"], event["tick"]) == ("AP", 5, WALL, 60)
        assert event["distance_cm"] == pytest.approx(8 - 1.33)
        assert event["incidence_deg"] == pytest.approx(0, abs=1e-6)
        assert (scored.score.ap, scored.score.sr1, scored.score.rule) == (1, 1.0, "geometric")
        assert scored.score.robot_minutes == pytest.approx(121 / 30 / 60)
        assert scored.score.distance_cm == pytest.approx(24.0)

    def test_nothing_is_near(self):
        (event,) = score_tracks(tracks_of(moved(APPROACH, 10.0, 27.0, 0.0))).events
        assert (event["kind"], event["other"]) == ("spurious", NOTHING)

    def test_a_robot_that_stands_ahead_is_approached(self):
        poses = np.concatenate([moved(APPROACH, 20.0, 27.0, 0.0), moved(STANDS, 44.0, 27.0, 0.0)], axis=1)
        (event,) = score_tracks(tracks_of(poses, ids=(3, 8))).events
        assert (event["kind"], event["robot"], event["other"]) == ("AA", 3, 8)
        assert event["distance_cm"] == pytest.approx(44 - 36 - 1.33 - 2)
        assert event["miss_cm"] == pytest.approx(-4.0)  # right through it

    def test_a_robot_that_crosses_is_translating(self):
        """At the alarm it passes 9 cm ahead, to the left, and it is 8 cm beyond the way by then."""
        passing = moved(DRIVES, 46.0, 19.0, math.pi / 2)  # at 2 s it is at y = 35
        poses = np.concatenate([moved(APPROACH, 20.0, 30.0, 0.0), passing], axis=1)
        (event,) = score_tracks(tracks_of(poses)).events
        assert (event["kind"], event["other"]) == ("AT", 1)

    def test_the_wall_is_hit(self):
        """62 + 8 t - 6 = 68 - 2: it touches in frame 90 of 8 / 30 cm each; then it turns, which is no avoidance."""
        poses = moved(course(("drive", 8, 3), *TURN)[0], 44.0, 27.0, 0.0)
        scored = score_tracks(tracks_of(poses))
        (event,) = scored.events
        assert (event["kind"], event["other"], event["tick"]) == ("CP", WALL, 89)
        assert event["seen"]
        assert scored.answers == 1
        assert scored.score.sr1 == 0.0

    def test_two_robots_touch(self):
        """The gap closes by 8 cm/s; the second stands with its back to the first, and cannot see it."""
        poses = np.concatenate(
            [moved(course(("drive", 8, 2), *TURN)[0], 20.0, 27.0, 0.0), moved(STANDS, 40.0, 27.0, 0.0)], 1
        )
        scored = score_tracks(tracks_of(poses, ids=(2, 6)))
        (event,) = scored.events
        assert (event["kind"], event["robot"], event["other"], event["tick"]) == ("CR", 2, 6, 59)
        assert event["seen"]
        assert not event["seen_by_other"]
        assert scored.score.sr2 == 0.0

    def test_an_obstacle_is_hit(self):
        world = replace(World(), obstacles=(Obstacle(x_cm=40.0, y_cm=27.0),))
        poses = moved(course(("drive", 8, 2), *TURN)[0], 19.5, 27.0, 0.0)  # 40 - 2.5 - 2 = 35.5
        (event,) = score_tracks(tracks_of(poses), world).events
        assert (event["kind"], event["other"]) == ("CP", obstacle_code(0))

    def test_a_circular_room(self):
        room = Room(60.0, 60.0, "circle")
        poses = moved(APPROACH, 36.0, 30.0, 0.0)
        (event,) = score_tracks(tracks_of(poses, room=room)).events
        assert (event["kind"], event["distance_cm"]) == ("AP", pytest.approx(8 - 1.33))

    def test_robots_that_are_lost_now_and_then(self):
        poses = np.concatenate([moved(APPROACH, 20.0, 27.0, 0.0), moved(STANDS, 44.0, 27.0, 0.0)], axis=1)
        poses[40:50, 1] = np.nan
        poses[57, 0] = np.nan
        (event,) = score_tracks(tracks_of(poses)).events
        assert (event["kind"], event["other"]) == ("AA", 1)
        poses[45:, 1] = np.nan  # for good: nobody knows what is ahead, but the wall is far
        (event,) = score_tracks(tracks_of(poses)).events
        assert event["kind"] == "spurious"


def test_a_room_that_is_not_that_of_the_tracks():
    with pytest.raises(ParameterError, match="its room is 70 x 55 cm: must be that of the tracks, 60x40"):
        score_tracks(tracks_of(STANDS, room=Room(60.0, 40.0)), World())
    with pytest.raises(ParameterError, match="2 frames: must be at least 3"):
        score_tracks(tracks_of(STANDS[:2]))


def test_a_world_takes_on_the_room():
    world = world_of(Room(60.0, 60.0, "circle"), World(robots=RobotParams(count=7)))
    assert (world.room.shape, world.room.radius_cm, world.robots.count) == ("circle", 30.0, 7)
    assert world_of(Room(60.0, 40.0)).room.size_cm == (60.0, 40.0)


class Dark:
    """An eye for controllers that do not look."""

    def views(self, cameras, bodies, **_):
        return np.zeros((len(cameras), 72, 99), np.uint8)


class Turning(RandomTurn):
    """Turns by chance, and cannot be asked again."""

    state = set_state = replay = None


@pytest.fixture(scope="module")
def run():
    """70 s of seven robots that turn by chance: what the simulation wrote down, and where they were."""
    world = World(robots=RobotParams(count=7))
    simulation = Simulation(world, Turning(15.0), seed=11, eye=Dark())
    referee, poses = Scorer(simulation), []
    for _ in range(2100):
        poses.append(simulation.pose.copy())
        referee.tick(simulation.tick())
    return referee, np.array(poses)


@pytest.mark.parametrize("error_cm", [0.0, 0.01], ids=["exact", "0.1 mm"])
def test_the_events_of_a_run_are_found_in_its_bare_motion(run, error_cm):
    referee, poses = run
    truth, scored = referee.events, score_tracks(tracks_of(poses, error_cm=error_cm))
    left = [(e["tick"], e["kind"], frozenset((e["robot"], e["other"]))) for e in scored.events]
    met = 0
    for event in truth:
        same = (event["kind"], frozenset((event["robot"], event["other"])))
        late = 4 if event["kind"] in ("CR", "CP") else 1  # frames; grazing, the last millimetre takes its time
        near = [one for one in left if one[1:] == same and abs(one[0] - event["tick"]) <= late]
        if near:
            left.remove(near[0])
            met += 1
    # the rest: turns that begin in the very touch of another or are cut off by the end, and gaps below a millimetre
    assert len(truth) > 100
    assert met > 0.9 * len(truth)
    assert len(left) < 0.07 * len(truth)
    own, watched = referee.score(), scored.score
    assert watched.robot_minutes == pytest.approx(own.robot_minutes)
    assert watched.distance_cm == pytest.approx(own.distance_cm, rel=0.03)
