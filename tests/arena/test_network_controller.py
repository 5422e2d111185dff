"""A network for each robot: the same as networks run by hand; it can be asked again from any saved state."""

import numpy as np
import pytest

from lobula import Network, preset
from lobula.arena.network_controller import NetworkController
from lobula.types import NEURONS

RNG = np.random.default_rng(2)
TICKS = 90
TIMES_S = np.arange(TICKS) / 30
TURNING = np.zeros((TICKS, 2), bool)
TURNING[20:35, 1] = True


def growing_squares() -> np.ndarray:
    """Two robots' films (T, 2, H, W): a dark square that grows from frame 30 on, and one that stays."""
    images = np.clip(180 + RNG.normal(0, 1.5, (TICKS, 2, 72, 99)), 0, 255)
    for t in range(TICKS):
        half = 4 if t < 30 else min(36, int(4 / (1 - (t - 30) / 66)))
        images[t, 0, 36 - half : 36 + half, 49 - half : 49 + half] = 45
        images[t, 1, 32:40, 45:53] = 45
    return images.astype(np.uint8)


FILM = growing_squares()


def run(controller: NetworkController, ticks: range) -> np.ndarray:
    return np.array([controller.step(FILM[t], float(TIMES_S[t]), TURNING[t]) for t in ticks])


def started() -> NetworkController:
    controller = NetworkController(preset("published"), engine="auto")
    controller.start(2, np.random.default_rng(0))
    return controller


def test_it_says_what_the_networks_say() -> None:
    controller = started()
    said = run(controller, range(TICKS))
    for robot in range(2):
        trace = Network(preset("published")).run(FILM[:, robot], TIMES_S, turning=TURNING[:, robot])
        np.testing.assert_array_equal(said[:, robot], trace["collision"])
        assert controller.potentials is not None
        assert controller.potentials[robot].tolist() == [trace[name][-1] for name in NEURONS]
    assert said[:, 0].any()  # the film holds something to be said
    assert not said[:, 1].any()


@pytest.mark.parametrize("start", [0, 1, 25, 50])
def test_it_answers_again_from_a_saved_state_and_goes_on_untouched(start: int) -> None:
    controller = started()
    run(controller, range(start))
    states = [controller.state(robot) for robot in range(2)]
    said = run(controller, range(start, 60))
    for robot in (0, 1, 0):
        again = controller.replay(states[robot], FILM[start:60, robot], TIMES_S[start:60], TURNING[start:60, robot])
        np.testing.assert_array_equal(again, said[:, robot])
    other = started()
    for robot, state in enumerate(states):
        other.set_state(robot, state)
    np.testing.assert_array_equal(run(other, range(start, 60)), said)
    np.testing.assert_array_equal(run(controller, range(60, TICKS)), run(other, range(60, TICKS)))


def test_no_potentials_before_the_first_frame() -> None:
    assert started().potentials is None


def test_another_run_begins_anew() -> None:
    controller = started()
    first = run(controller, range(TICKS))
    controller.start(2, np.random.default_rng(0))
    np.testing.assert_array_equal(run(controller, range(TICKS)), first)
