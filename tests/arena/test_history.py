"""The ring keeps the last frames whole and in order, and the states from which they can be judged again."""

import numpy as np
import pytest

from lobula.arena.history import History

LENGTH = 10


def filled(ticks: int, save_every: int = 4) -> History:
    history = History(LENGTH, 2)
    for tick in range(ticks):
        if save_every and tick % save_every == 0:
            history.save(tick, [f"{tick}-{robot}" for robot in range(2)])
        history.add(tick, np.full((2, 3), tick), np.array([tick % 3, 0]), np.full(2, tick / 2), None)
    return history


@pytest.mark.parametrize("ticks", [1, 9, 10, 11, 19, 20, 21, 57])
def test_rows_are_the_last_ones_in_order(ticks: int) -> None:
    history = filled(ticks)
    for first in range(max(0, ticks - LENGTH), ticks):
        rows = history.since(first)
        expected = np.arange(first, ticks)
        np.testing.assert_array_equal(rows.poses[:, 1, 2], expected)
        np.testing.assert_array_equal(rows.phases[:, 0], expected % 3)
        np.testing.assert_array_equal(rows.light[:, 1], expected / 2)
        assert np.isnan(rows.potentials).all()


def test_the_newest_state_that_is_old_enough() -> None:
    history = filled(27)
    assert history.start_of(22) == (20, ["20-0", "20-1"])
    assert history.start_of(20)[0] == 20
    assert history.start_of(19)[0] == 20  # of 16 the rows are gone
    assert history.start_of(26)[0] == 24


def test_at_the_start_there_is_only_the_start() -> None:
    assert filled(3).start_of(-20) == (0, ["0-0", "0-1"])


def test_without_states_it_is_the_frame_itself_or_the_oldest() -> None:
    history = filled(27, save_every=0)
    assert history.start_of(22) == (22, None)
    assert history.start_of(3) == (17, None)


def test_it_goes_on_from_a_saved_state() -> None:
    first, second = filled(25), History(LENGTH, 2)
    second.set_state(first.state())
    for history in (first, second):
        history.add(25, np.zeros((2, 3)), np.zeros(2, np.int8), np.ones(2), np.full((2, 4), 0.5))
    for first_rows, second_rows in zip(first.since(16), second.since(16), strict=True):
        np.testing.assert_array_equal(first_rows, second_rows)
    assert first.start_of(24) == second.start_of(24)
