"""Detectors for one camera as a controller of all robots."""

from __future__ import annotations

import numpy as np
import pytest

from lobula import arena
from lobula.arena.controller import can_replay


class Remembers:
    """Says yes once the pictures it has seen sum up to more than 100."""

    def __init__(self):
        self.seen = []

    def step(self, image, time_s, turning):
        self.seen.append(int(image[0, 0]))
        return sum(self.seen) > 100


class Grown:
    """Avoid when more of the picture is dark than a quarter of a second ago."""

    def __init__(self):
        self.past = []

    def step(self, image, time_s, turning):
        dark = float((image < 70).mean())
        self.past = [*self.past[-7:], dark]
        return dark - self.past[0] > 0.02


def pictures(*values):
    return np.array(values, np.uint8)[:, None, None]


def started(robots):
    controller = arena.EachRobot(Remembers)
    controller.start(robots, np.random.default_rng(0))
    return controller


def test_each_robot_has_its_own():
    controller, turning = started(2), np.zeros(2, bool)
    assert controller.step(pictures(60, 1), 0.0, turning) == [False, False]
    assert controller.step(pictures(60, 1), 0.1, turning) == [True, False]


def test_a_replay_starts_from_the_state_and_leaves_the_run_alone():
    controller, turning = started(1), np.zeros(3, bool)
    controller.step(pictures(50), 0.0, turning[:1])
    state = controller.state(0)
    assert controller.replay(state, pictures(10, 45, 0), np.arange(3.0), turning).tolist() == [False, True, True]
    assert controller.replay(state, pictures(10, 20, 0), np.arange(3.0), turning).tolist() == [False, False, False]
    assert state == {"seen": [50]} == controller.state(0)
    assert can_replay(controller)


def test_a_state_brings_it_back():
    controller, turning = started(2), np.zeros(2, bool)
    controller.step(pictures(90, 5), 0.0, turning)
    kept = controller.state(0)
    controller.set_state(1, kept)
    assert controller.step(pictures(20, 20), 0.1, turning) == [True, True]
    assert kept == {"seen": [90]}


def test_its_run_has_causes_and_can_be_resumed(tmp_path):
    whole = arena.run(controller=arena.EachRobot(Grown), minutes=0.3, seed=3)
    assert whole.score.rule == "counterfactual"
    assert whole.score.aa + whole.score.at > 0
    assert whole.controller == "EachRobot Grown"

    stop = iter(range(9))

    def progress(done, minutes):
        if next(stop, None) is None:
            raise KeyboardInterrupt

    with pytest.raises(arena.RunInterrupted) as caught:
        arena.run(controller=arena.EachRobot(Grown), minutes=0.3, seed=3, progress=progress)
    resumed = arena.run(controller=arena.EachRobot(Grown), resume=caught.value.run.snapshot)
    assert resumed.events.tobytes() == whole.events.tobytes()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (Grown, "controller Grown: is a class: must be an object, Grown()"),
        (Grown(), "controller Grown: has no start(): must have start(robots, rng) and step(images, time_s, turning)"),
        (len, "has no start() and no step(): must have"),
    ],
)
def test_what_is_no_controller(given, words):
    with pytest.raises(arena.ControllerError) as caught:
        arena.run(controller=given, minutes=0.01, seed=3)
    assert words in str(caught.value)
