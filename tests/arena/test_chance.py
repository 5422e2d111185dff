"""Every use has its own source of chance, the same for the same seed, whatever else the run has."""

import numpy as np
import pytest

from lobula.arena.chance import BLOCK, Chance
from lobula.errors import ParameterError


def test_the_same_seed_is_the_same_chance_and_another_is_not() -> None:
    first, again, other = Chance(3, 4), Chance(3, 4), Chance(4, 4)
    assert first.placement.random() == again.placement.random() != other.placement.random()
    assert first.texture == again.texture != other.texture
    np.testing.assert_array_equal(first.keys(7), again.keys(7))
    assert (first.keys(7) != other.keys(7)).all()


def test_a_robots_chance_does_not_depend_on_how_many_there_are() -> None:
    few, many = Chance(3, 4), Chance(3, 7)
    assert [rng.random() for rng in few.robots] == [rng.random() for rng in many.robots[:4]]
    assert few.controller.random() == many.controller.random()
    np.testing.assert_array_equal(few.keys(5), many.keys(5)[:4])


def test_sources_differ_from_each_other() -> None:
    chance = Chance(3, 5)
    draws = [rng.random() for rng in (chance.placement, chance.motors, chance.controller, *chance.robots)]
    assert len(set(draws)) == len(draws)


def test_keys_are_all_different_and_their_bits_even() -> None:
    keys = Chance(0, 7).keys_of(np.arange(4000))
    assert keys.shape == (4000, 7)
    assert len(np.unique(keys)) == keys.size
    bits = np.unpackbits(keys.view(np.uint8)).reshape(-1, 64)
    assert np.abs(bits.mean(axis=0) - 0.5).max() < 5 * 0.5 / np.sqrt(keys.size)
    flips = np.unpackbits((keys[1:] ^ keys[:-1]).view(np.uint8)).reshape(-1, 64)  # of neighbouring ticks
    assert flips.sum(axis=1).mean() == pytest.approx(32, abs=5 * 4 / np.sqrt(len(flips)))


def test_one_tick_at_a_time_gives_the_same_keys() -> None:
    chance = Chance(0, 3)
    ticks = np.array([0, 1, BLOCK - 1, BLOCK, 5 * BLOCK + 3, 2])
    np.testing.assert_array_equal([chance.keys(int(tick)) for tick in ticks], chance.keys_of(ticks))


@pytest.mark.parametrize("seed", [-1, 1.5, "3", True, None])
def test_a_seed_is_a_whole_number(seed: object) -> None:
    with pytest.raises(ParameterError, match=r"seed = .*: must be a whole number of at least 0"):
        Chance(seed, 4)  # type: ignore[arg-type]
