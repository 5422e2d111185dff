"""The scorer on small runs whose events are known beforehand; with the network, the eye and real replays."""

from __future__ import annotations

import math

import numpy as np
import pytest

import lobula
from lobula.arena.cause import Replay
from lobula.arena.contact import WALL, obstacle_code
from lobula.arena.controls import AlwaysTurn, NeverTurn
from lobula.arena.events import NOTHING
from lobula.arena.network_controller import NetworkController
from lobula.arena.scorer import Scorer
from lobula.arena.simulation import Simulation
from lobula.arena.world import Obstacle, RobotParams, World
from lobula.engine.library import available

needs_core = pytest.mark.skipif(not available(), reason="minutes on the NumPy reference")


def run(controller, poses, *, seconds, speed=8.0, seed=1, obstacles=()):
    """A scored run of robots that start at (x, y, heading in deg), all at the same speed."""
    robots = RobotParams(count=len(poses), speed_low_cm_s=speed, speed_high_cm_s=speed)
    world = World(robots=robots, obstacles=obstacles)
    start = np.array([(x, y, math.radians(deg)) for x, y, deg in poses])
    scorer = Scorer(Simulation(world, controller, seed, poses=start))
    for _ in range(round(seconds * world.camera.rate_hz)):
        scorer.tick(scorer.simulation.tick())
    return scorer


def network(neurons="lgmds"):
    return NetworkController(lobula.preset("published", neurons=neurons))


class Blind(NeverTurn):
    """Turns once, at 1 s, and cannot be asked again."""

    state = set_state = replay = None

    def step(self, images, time_s, turning):
        return np.full(len(turning), abs(time_s - 1.0) < 0.01)


@needs_core
@pytest.mark.parametrize(("heading_deg", "y"), [(0, 27), (25, 20)])
def test_one_robot_drives_at_a_wall(heading_deg, y):
    event = run(network(), [(35, y, heading_deg)], seconds=4.3).events[0]
    assert (event["kind"], event["geometric"], event["other"], event["rule"]) == ("AP", "AP", WALL, "alone")
    assert event["incidence_deg"] == pytest.approx(heading_deg)
    assert event["seen"]
    assert 0 < event["distance_cm"] < 20
    assert math.isnan(event["miss_cm"])
    assert event["lgmd2"] > 0.7  # it spiked


@needs_core
def test_one_robot_drives_at_an_obstacle():
    obstacles = (Obstacle(x_cm=20, y_cm=45), Obstacle(x_cm=40, y_cm=27))
    (event,) = run(network(), [(16, 27, 0)], seconds=2.6, obstacles=obstacles).events
    assert (event["kind"], event["geometric"], event["rule"]) == ("AP", "AP", "alone")
    assert event["other"] == event["geometric_other"] == obstacle_code(1)
    assert event["incidence_deg"] == pytest.approx(0, abs=1e-6)
    assert event["seen"]


@needs_core
def test_two_robots_meet_head_on():
    events = run(network(), [(18, 27, 0), (52, 27, 180)], seconds=2.2).events
    assert events["kind"].tolist() == ["AA", "AA"]
    assert sorted(zip(events["robot"].tolist(), events["other"].tolist(), strict=True)) == [(0, 1), (1, 0)]
    assert events["rule"].tolist() == ["alone", "alone"]
    assert events["geometric"].tolist() == ["AA", "AA"]
    assert events["miss_cm"][0] == pytest.approx(-4.0)
    assert events["incidence_deg"].tolist() == pytest.approx([0, 0], abs=1e-6)


@needs_core
def test_a_robot_that_passes_in_front_is_translating():
    # it crosses 6 cm ahead of a standing robot
    world = World(robots=RobotParams(count=2, speed_low_cm_s=0, speed_high_cm_s=10))
    start = np.array([(30, 27, 0), (38, 13, math.pi / 2)])
    simulation = Simulation(world, network(), 1, poses=start)
    simulation.motion.speeds_cm_s[:] = 0, 10
    scorer = Scorer(simulation)
    for _ in range(75):
        scorer.tick(simulation.tick())
    events = scorer.events[scorer.events["robot"] == 0]
    assert events["kind"].tolist() == ["AT"]
    assert events["other"].tolist() == [1]
    assert events["miss_cm"][0] > 1


@needs_core
def test_a_replay_of_what_was_there_says_what_was_said():
    world = World(robots=RobotParams(count=3))
    simulation = Simulation(world, network("all"), 4)
    said = []
    for _ in range(150):
        simulation.tick()
        said.append([reading.collision for reading in simulation.controller.readings])
        if any(said[-1]):
            for robot in range(3):
                past = simulation.past(robot)
                again = Replay(past, robot, world, simulation.eye, simulation.controller).alarms()
                assert again[:-2].tolist() == [row[robot] for row in said[past.first_tick :]]
    assert np.any(said)


@needs_core
@pytest.mark.parametrize("preset", ["published", "paper"])
def test_an_object_that_vanishes_is_forgotten_before_the_alarm_is_looked_at(preset):
    # robot 0 drives at robot 1, which vanishes 3 cm in front of it, a second before the end; or has never been there
    world, frames, heading = World(robots=RobotParams(count=2)), 66, 0.4
    start = np.array([(12.0, 20, heading), (27.4, 26.5, 3.5)])
    eye = Simulation(world, NeverTurn(), 1, poses=start).eye
    times_s = np.arange(frames) / 30
    poses = np.repeat(start[None], frames, axis=0)
    poses[:, 0, :2] += 8 * times_s[:, None] * np.array([math.cos(heading), math.sin(heading)])
    vanish = frames - 31

    def trace(there):
        shown = np.stack([there, there], axis=1)
        images = eye.views(poses[:, 0], poses, own=np.zeros(frames), keys=np.arange(frames), shown=shown)
        return lobula.Network(lobula.preset(preset)).run(images, times_s)

    never, vanished = trace(np.zeros(frames, bool)), trace(np.arange(frames) < vanish)
    assert vanished["spikes_lgmd1"][:vanish].sum() > never["spikes_lgmd1"][:vanish].sum() + 4  # it had been noticed
    settled = vanish + 18  # after 0.6 s; the first frame that is looked at comes 0.93 s after it has vanished
    for name in ("lgmd1", "lgmd2", "lptc_r", "lptc_l"):
        assert np.abs(never[name] - vanished[name])[settled:].max() < 1e-3
        assert (never[f"spikes_{name}"] == vanished[f"spikes_{name}"])[settled:].all()
    assert (never["collision"] == vanished["collision"])[settled:].all()


@needs_core
@pytest.mark.parametrize("preset", ["published", "paper"])
@pytest.mark.parametrize("heading", [0.0, 0.5, 1.0])
def test_a_plain_wall_raises_no_alarm(preset, heading):
    # what the counterfactual rests on: once it is painted plain, the wall is gone for the network
    world, start = World(robots=RobotParams(count=1)), np.array([(68 - 22 * math.cos(heading), 10, heading)])
    times_s = np.arange(80) / 30
    poses = np.repeat(start[None], 80, axis=0)
    poses[:, 0, :2] += 8 * times_s[:, None] * np.array([math.cos(heading), math.sin(heading)])
    eye = Simulation(world, NeverTurn(), 1, poses=start).eye
    plain, striped = (
        lobula.Network(lobula.preset(preset, neurons="lgmds")).run(
            eye.views(poses[:, 0], poses, own=np.zeros(80), keys=np.arange(80), walls=np.full(80, walls)), times_s
        )
        for walls in (False, True)
    )
    assert striped["collision"].any()
    assert not plain["collision"].any()


@needs_core
def test_who_always_turns_turns_because_of_nothing():
    scorer = run(AlwaysTurn(), [(60, 27, 0)], seconds=4)
    assert (scorer.events["kind"] == "spurious").all()
    assert (scorer.events["other"] == NOTHING).all()
    assert scorer.events["geometric"][0] == "AP"  # the wall was near
    assert scorer.score().spurious == len(scorer.events) > 2


@needs_core
def test_without_replay_causes_are_by_place_alone_and_the_score_says_so():
    scorer = run(Blind(), [(50, 27, 0), (40, 20, -90)], seconds=1.2)
    assert scorer.rule == scorer.score().rule == "geometric"
    assert scorer.events["rule"].tolist() == ["geometric", "geometric"]
    assert scorer.events["kind"].tolist() == scorer.events["geometric"].tolist() == ["AP", "AP"]


@needs_core
def test_a_wall_met_head_on_is_a_contact_that_was_seen():
    scorer = run(NeverTurn(), [(55, 27, 0)], seconds=2)
    (event,) = scorer.events
    assert (event["kind"], event["geometric"], event["other"], event["robot"]) == ("CP", "CP", WALL, 0)
    assert event["seen"]
    assert event["incidence_deg"] == pytest.approx(0, abs=1e-6)
    # 13 cm at 8 cm/s: within the 49th frame's tick, 48 / 30 s; the pupil was 0.2 cm short of 0.67 from the wall
    assert event["tick"] == 48
    assert event["time_s"] == pytest.approx(48 / 30)
    assert event["distance_cm"] == pytest.approx(70 - 55 - 8 * 48 / 30 - 1.33)


@needs_core
def test_a_wall_met_obliquely_keeps_its_angle():
    (event,) = run(NeverTurn(), [(63, 20, 60)], seconds=1.5).events
    assert event["incidence_deg"] == pytest.approx(60)


@needs_core
def test_an_obstacle_that_is_met_counts_as_periphery():
    (event,) = run(NeverTurn(), [(25, 28, 0)], seconds=1.5, obstacles=(Obstacle(x_cm=40, y_cm=27, radius_cm=3),)).events
    assert (event["kind"], event["other"], event["seen"]) == ("CP", obstacle_code(0), True)
    assert event["incidence_deg"] == pytest.approx(math.degrees(math.asin(1 / 5)))


@needs_core
def test_two_that_meet_are_one_contact():
    score = run(NeverTurn(), [(25, 27, 0), (45, 27, 180)], seconds=1.2).score()
    assert (score.cr, score.unseen_cr, score.cr_views) == (1, 0, 2)
    assert score.robot_minutes == pytest.approx(2 * 1.2 / 60)
    assert score.distance_cm == pytest.approx(16.0)  # each had 8 cm to go


@needs_core
def test_struck_from_behind_is_seen_by_one():
    world = World(robots=RobotParams(count=2, speed_low_cm_s=0, speed_high_cm_s=10))
    simulation = Simulation(world, NeverTurn(), 1, poses=np.array([(20.0, 27, 0), (30, 27, 0)]))
    simulation.motion.speeds_cm_s[:] = 10, 2
    scorer = Scorer(simulation)
    for _ in range(30):
        scorer.tick(simulation.tick())
    (event,) = scorer.events
    assert (event["kind"], event["robot"], event["other"]) == ("CR", 0, 1)
    assert (event["seen"], event["seen_by_other"]) == (True, False)
    assert scorer.score().unseen_cr == 0


@needs_core
def test_a_scorer_goes_on_from_its_state():
    first = run(NeverTurn(), [(55, 27, 0), (15, 27, 180)], seconds=2)
    again = Scorer(first.simulation)
    again.set_state(first.state())
    assert again.events.tobytes() == first.events.tobytes()
    assert again.score() == first.score()
    assert len(again.events) == 2
