"""Commanded wheels: the kinematics of two wheels, by hand, and no will of their own."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lobula.arena.wheels import WheelMotion
from lobula.arena.world import RobotParams, World

TICK_S = 1 / 30


def motion(poses, **robots):
    world = World(robots=RobotParams(count=len(poses), **robots))
    chance = np.random.default_rng(4).spawn(len(poses) + 1)
    return WheelMotion(world, np.array(poses, float), chance[1:], chance[0])


def drive(wheels, ticks, **robots):
    moved = motion([(20.0, 20.0, 0.5)], **robots)
    moved.command(np.array([wheels], float))
    for _ in range(ticks):
        moved.chords()
        moved.advance()
    return moved


def test_equal_wheels_go_straight():
    moved = drive((9.0, 9.0), 30)
    assert moved.places_cm[0] == pytest.approx(20 + 20j + 9 * complex(math.cos(0.5), math.sin(0.5)))
    assert (moved.headings_rad[0], moved.distances_cm[0]) == (0.5, pytest.approx(9.0))


def test_opposite_wheels_turn_in_place_counter_clockwise():
    moved = drive((-2.4, 2.4), 15)  # 4.8 cm/s over 4.8 cm: 1 rad/s
    assert moved.places_cm[0] == 20 + 20j
    assert moved.headings_rad[0] == pytest.approx(0.5 + 0.5)
    assert moved.distances_cm[0] == 0


def test_a_circle_closes():
    ticks = 300
    ahead, bend = 4.0, 2 * math.pi / (ticks * TICK_S)  # cm/s and rad/s: once round
    moved = drive((ahead - 2.4 * bend, ahead + 2.4 * bend), ticks)
    assert moved.places_cm[0] == pytest.approx(20 + 20j, abs=1e-9)
    assert moved.headings_rad[0] == pytest.approx(0.5 + 2 * math.pi)
    assert moved.distances_cm[0] == pytest.approx(ahead * ticks * TICK_S)


def test_backwards():
    moved = drive((-6.0, -6.0), 10)
    assert moved.places_cm[0] == pytest.approx(20 + 20j - 2 * complex(math.cos(0.5), math.sin(0.5)))


def test_an_alarm_turns_nobody():
    moved = motion([(20.0, 20.0, 0.0), (40.0, 20.0, 0.0)])
    moved.avoid([0, 1])
    assert not moved.turning.any()
    assert moved.chords() == [0, 0]


def test_noise_shakes_what_drives_and_leaves_alone_what_stands():
    moved = motion([(20.0, 20.0, 0.0), (40.0, 20.0, 0.0)], motor_noise=0.1)
    moved.command(np.array([[5.0, 5.0], [0.0, 0.0]]))
    ways = np.array([list(moved.chords()) for _ in range(400)])
    assert np.abs(ways[:, 1]).max() == 0
    # the mean of two wheels, each with a tenth of its speed as noise
    assert np.abs(ways[:, 0]).std() == pytest.approx(5 * TICK_S * 0.1 / math.sqrt(2), rel=0.1)
