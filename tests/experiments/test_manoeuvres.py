"""Turns in place read off motions that are written down frame by frame."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lobula.experiments.manoeuvres import ManoeuvreParams, manoeuvres, motion_of

PARAMS = ManoeuvreParams()


def course(*legs: tuple[str, float, float], rate_hz: float = 30.0):
    """Poses (T, 1, 3) and times of legs ("drive", cm/s, s), ("turn", deg, s) and ("stop", 0, s), from the origin."""
    pose, poses = np.zeros(3), [np.zeros(3)]
    for kind, amount, seconds in legs:
        steps = round(seconds * rate_hz)
        for _ in range(steps):
            pose = pose.copy()
            if kind == "drive":
                pose[:2] += amount / rate_hz * np.array([math.cos(pose[2]), math.sin(pose[2])])
            elif kind == "turn":
                pose[2] += math.radians(amount) / steps
            poses.append(pose)
    poses = np.array(poses)[:, None]
    poses[..., 2] = (poses[..., 2] + math.pi) % (2 * math.pi) - math.pi
    return poses, np.arange(len(poses)) / rate_hz


def found(poses, times_s):
    return manoeuvres(motion_of(poses, times_s, PARAMS), times_s, PARAMS)


@pytest.mark.parametrize("rate_hz", [15.0, 30.0, 60.0])
@pytest.mark.parametrize("angle", [150.0, -120.0, 40.0])
def test_stop_and_turn(angle, rate_hz):
    poses, times_s = course(("drive", 8, 2), ("stop", 0, 0.2), ("turn", angle, 0.8), ("drive", 8, 1), rate_hz=rate_hz)
    (turn,) = found(poses, times_s)
    assert turn.robot == 0
    assert turn.alarm == 2 * rate_hz
    assert times_s[turn.end] == pytest.approx(3.0, abs=0.11)


def test_noise_of_a_tenth_of_a_millimetre_moves_nothing_by_more_than_a_frame():
    rng = np.random.default_rng(0)
    poses, times_s = course(("drive", 6, 2), ("stop", 0, 0.2), ("turn", 130, 0.8), ("drive", 6, 2), ("stop", 0, 0.2),
                            ("turn", -170, 0.8), ("drive", 6, 1))  # fmt: skip
    poses = poses + rng.normal(0, (0.01, 0.01, 0.005), poses.shape)
    alarms = [turn.alarm for turn in found(poses, times_s)]
    assert alarms == pytest.approx([60, 150], abs=1)


def test_two_turns_with_a_halt_between_them_are_two():
    poses, times_s = course(("drive", 8, 2), ("stop", 0, 0.2), ("turn", 150, 0.8), ("stop", 0, 0.2), ("turn", 150, 0.8),
                            ("drive", 8, 1))  # fmt: skip
    first, second = found(poses, times_s)
    assert first.alarm == 60
    assert 90 <= first.end <= second.alarm <= 96  # the second stop begins in frame 90 and ends in 96


def test_what_is_no_manoeuvre():
    assert not found(*course(("drive", 8, 2), ("stop", 0, 1), ("drive", 8, 1)))  # a rest
    assert not found(*course(("drive", 8, 2), ("turn", 20, 0.3), ("drive", 8, 1)))  # too small
    assert not found(*course(("drive", 8, 2), ("turn", 60, 4), ("drive", 8, 1)))  # too slow
    assert not found(*course(("turn", 150, 0.8), ("drive", 8, 1)))  # begun before the recording
    curve = np.linspace(0, 2, 60)
    circling = np.column_stack([10 * np.sin(curve), 10 * np.cos(curve), -curve])[:, None]
    assert not found(circling, np.arange(60) / 30)  # drives a curve


def test_frames_that_are_missing():
    poses, times_s = course(("drive", 8, 2), ("stop", 0, 0.2), ("turn", 150, 0.8), ("drive", 8, 1))
    kept = np.setdiff1d(np.arange(len(poses)), [20, 21, 50, 75, 76, 77])
    (turn,) = found(poses[kept], times_s[kept])
    assert kept[turn.alarm] == 60
    lost = poses.copy()
    lost[[20, 21, 50, 75, 76, 77]] = np.nan
    (turn,) = found(lost, times_s)
    assert turn.alarm == 60
    assert 89 <= turn.end <= 92  # one turn, though its middle was not seen


def test_each_robot_is_measured_by_its_own_speed():
    slow, times_s = course(("drive", 3, 2), ("stop", 0, 0.2), ("turn", 150, 0.8), ("drive", 3, 1))
    fast, _ = course(("drive", 12, 4))
    (turn,) = found(np.concatenate([fast, slow], axis=1), times_s)
    assert (turn.robot, turn.alarm) == (1, 60)


def test_speed_and_rate_of_turn():
    poses, times_s = course(("drive", 8, 1), ("turn", -90, 1))
    motion = motion_of(poses, times_s, PARAMS)
    assert motion.speed_cm_s[5:25, 0] == pytest.approx(np.full(20, 8.0))
    assert motion.turn_rad_s[35:55, 0] == pytest.approx(np.full(20, -math.pi / 2))
    assert motion.standing[:, 0].tolist() == [False] * 30 + [True] * 31  # in frame 30 it is half-way to standing still
    assert motion.drives[:, 0].tolist() == [False] + [True] * 30 + [False] * 30
