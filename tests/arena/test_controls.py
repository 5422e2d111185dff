"""Never, always, by chance: and chance has its rate, goes on from a saved state, and answers again the same."""

import math

import numpy as np
import pytest

from lobula.arena.controls import AlwaysTurn, NeverTurn, RandomTurn
from lobula.errors import ParameterError

IMAGES = np.zeros((4, 24, 32), np.uint8)
STILL = np.zeros(4, bool)


def said(controller: RandomTurn, ticks: range) -> np.ndarray:
    return np.array([controller.step(IMAGES, tick / 30, STILL) for tick in ticks])


def chance(rate_per_min: float = 30.0) -> RandomTurn:
    controller = RandomTurn(rate_per_min)
    controller.start(4, np.random.default_rng(1))
    return controller


def test_never_and_always() -> None:
    assert not NeverTurn().step(IMAGES, 0.0, STILL).any()
    assert AlwaysTurn().step(IMAGES, 0.0, STILL).all()
    assert not NeverTurn().replay(None, IMAGES, np.arange(4.0), STILL).any()
    assert AlwaysTurn().replay(None, IMAGES, np.arange(4.0), STILL).all()


@pytest.mark.parametrize("rate_per_min", [6, 60])
def test_chance_keeps_its_rate_at_any_frame_rate(rate_per_min: float) -> None:
    for hz in (15, 60):
        controller, minutes = chance(rate_per_min), 5
        frames = minutes * 60 * hz
        count = sum(controller.step(IMAGES, tick / hz, STILL).sum() for tick in range(frames + 1))
        # at most one alarm a frame: 1 - exp(-x) instead of x
        expected = 4 * frames * -math.expm1(-rate_per_min / 60 / hz)
        assert count == pytest.approx(expected, abs=4 * math.sqrt(expected))


def test_robots_have_chances_of_their_own() -> None:
    alarms = said(chance(60), range(3000)).astype(float)
    correlation = np.corrcoef(alarms.T)[~np.eye(4, dtype=bool)]
    assert np.abs(correlation).max() < 4 / math.sqrt(3000)


def test_chance_goes_on_from_a_saved_state_and_answers_again_the_same() -> None:
    first, second = chance(), chance()
    said(first, range(100))
    states = [first.state(robot) for robot in range(4)]
    rest = said(first, range(100, 400))
    times_s = np.arange(100, 400) / 30
    for robot, state in enumerate(states):
        np.testing.assert_array_equal(first.replay(state, IMAGES, times_s, np.zeros(300, bool)), rest[:, robot])
        second.set_state(robot, state)
    np.testing.assert_array_equal(said(second, range(100, 400)), rest)


@pytest.mark.parametrize("rate", [-1, math.nan, math.inf])
def test_a_rate_is_a_number_from_nothing_up(rate: float) -> None:
    with pytest.raises(ParameterError, match="rate_per_min"):
        RandomTurn(rate)
