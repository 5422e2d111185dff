"""Robots drive straight or along arcs, and a queued turn is a stop, a turn within the law, and onward."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lobula.arena.motion import FORWARD, STOP, TURN, Motion
from lobula.arena.world import RobotParams, TurnParams, World

from .stand_ins import world_of

START = np.array([[10.0, 20.0, 0.7]])


def motion(world: World, poses: np.ndarray = START, seed: int = 0) -> Motion:
    rngs = [np.random.default_rng([seed, r]) for r in range(len(poses) + 1)]
    return Motion(world, poses, rngs[1:], rngs[0])


def drive(moving: Motion, ticks: int) -> None:
    for _ in range(ticks):
        moving.chords()
        moving.advance()


def test_ahead_is_a_straight_line_at_the_robots_speed() -> None:
    moving = motion(world_of())
    drive(moving, 40)
    assert moving.places_cm[0] == pytest.approx(10 + 20j + 12 * complex(math.cos(0.7), math.sin(0.7)))
    assert moving.headings_rad == [0.7]
    assert moving.distances_cm == [pytest.approx(12)]


def test_speeds_lie_in_their_range() -> None:
    moving = motion(World(), np.zeros((200, 3)))
    speeds = np.array(moving.speeds_cm_s)
    assert speeds.min() >= 6
    assert speeds.max() <= 10
    assert speeds.mean() == pytest.approx(8, abs=4 * 4 / math.sqrt(12 * 200))


@pytest.mark.parametrize("ticks", [1, 30, 3000])
def test_a_bent_path_is_an_arc_of_a_circle(ticks: int) -> None:
    world = World(robots=RobotParams(count=1, curvature_per_m=8))
    moving = motion(world, seed=3)
    drive(moving, ticks)
    way, bend = moving.distances_cm[0], moving.headings_rad[0] - 0.7
    assert way == pytest.approx(moving.speeds_cm_s[0] * ticks / 30)
    assert 0 < abs(bend / way) <= 0.08
    radius = way / bend
    x = 10 + radius * (math.sin(0.7 + bend) - math.sin(0.7))
    y = 20 - radius * (math.cos(0.7 + bend) - math.cos(0.7))
    assert moving.places_cm[0] == pytest.approx(complex(x, y), abs=1e-9)


def test_an_avoidance_stops_turns_in_place_and_drives_on() -> None:
    moving = motion(world_of())
    moving.avoid([0])
    phases, headings = [], []
    for _ in range(32):
        phases.append(moving.phases[0])
        drive(moving, 1)
        headings.append(moving.headings_rad[0])
    assert phases == [STOP] * 6 + [TURN] * 24 + [FORWARD] * 2
    assert headings[5] == 0.7
    turns = np.diff(np.unwrap([0.7, *headings[5:30]]))[1:]
    assert np.ptp(turns) < 1e-12  # at one rate
    assert 120 <= abs(math.degrees(turns.sum())) <= 180
    assert abs(moving.places_cm[0] - (10 + 20j)) == pytest.approx(2 * 0.3)  # two ticks of driving since
    assert moving.turning.tolist() == [False]


def test_no_stop_where_the_law_has_none() -> None:
    moving = motion(replace(world_of(), turn=TurnParams(stop_s=0, turn_s=0.1)))
    moving.avoid([0])
    assert moving.phases == [TURN]
    drive(moving, 3)
    assert moving.phases == [FORWARD]


def test_a_robot_that_turns_takes_no_notice() -> None:
    moving = motion(world_of())
    moving.avoid([0])
    drive(moving, 20)
    moving.avoid([0])
    drive(moving, 10)
    assert moving.phases == [FORWARD]


def test_turns_are_uniform_within_the_law_and_to_either_side() -> None:
    count = 1500
    moving = motion(world_of(), np.zeros((count, 3)))
    moving.avoid(range(count))
    for _ in range(30):
        drive(moving, 1)
        if moving.phases[0] == TURN:
            before = np.array(moving.headings_rad)
    rates = before / 23  # the last but one of 24 ticks
    angles = np.abs(np.degrees(rates * 24))
    assert angles.min() >= 120
    assert angles.max() <= 180
    assert angles.mean() == pytest.approx(150, abs=4 * 60 / math.sqrt(12 * count))
    assert angles.std() == pytest.approx(60 / math.sqrt(12), rel=0.08)
    assert (rates > 0).mean() == pytest.approx(0.5, abs=4 * 0.5 / math.sqrt(count))


def test_motor_noise_spreads_headings_as_two_independent_wheels_do() -> None:
    count, ticks, noise = 1000, 20, 0.1
    world = World(robots=RobotParams(count=1, speed_low_cm_s=9, speed_high_cm_s=9, motor_noise=noise))
    moving = motion(world, np.zeros((count, 3)))
    drive(moving, ticks)
    each_tick = 0.3 * noise * math.sqrt(2) / 4.8  # difference of the wheels' ways over the track
    spread = each_tick * math.sqrt(ticks)
    assert np.std(moving.headings_rad) == pytest.approx(spread, rel=4 / math.sqrt(2 * count))
    assert np.mean(moving.headings_rad) == pytest.approx(0, abs=4 * spread / math.sqrt(count))
    ways = np.array(moving.distances_cm)
    assert ways.mean() == pytest.approx(0.3 * ticks, abs=4 * 0.3 * noise / math.sqrt(2) * math.sqrt(ticks / count))


def test_it_goes_on_from_a_saved_state() -> None:
    world = World(robots=RobotParams(count=2, curvature_per_m=1, motor_noise=0.05))
    poses = np.array([[10.0, 20.0, 0.7], [30.0, 30.0, 2.0]])
    first, second = motion(world, poses), motion(world, poses, seed=9)
    first.avoid([1])
    drive(first, 17)
    second.set_state(first.state())
    for moving in (first, second):
        drive(moving, 5)
        moving.avoid([0, 1])
        drive(moving, 40)
    assert first.places_cm == second.places_cm
    assert first.headings_rad == second.headings_rad
    assert first.distances_cm == second.distances_cm
    assert first.phases == second.phases


def test_headings_stay_within_half_a_turn() -> None:
    moving = motion(world_of())
    for _ in range(40):
        moving.avoid([0])
        drive(moving, 31)
    assert -math.pi <= moving.headings_rad[0] <= math.pi
