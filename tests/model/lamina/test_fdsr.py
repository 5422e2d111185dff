"""Fast-depolarising slow-repolarising adaptation."""

import math

import numpy as np
import pytest
from hypothesis import given
from oracles.lamina import fdsr as slow_fdsr

from lobula.errors import ParameterError
from lobula.model.lamina.fdsr import FdsrParams, fdsr

from ..pictures import CLOCK_MS, channel, channels, few, noise

P = FdsrParams()


def test_golden_one_row_by_hand():
    # a = 33.333 / 34.333 = 0.970874.  Rises 0 -> 10 and 5 -> 10 pass 0.029126 of the rise; a fall and a rest nothing
    now, before = (np.array([row], np.float32) for row in ([10, 10, 5, 7], [0, 5, 10, 7]))
    assert fdsr(now, before, P, CLOCK_MS) == pytest.approx(np.array([[0.29126, 0.14563, 0, 0]]), abs=1e-5)


@pytest.mark.parametrize("seed", range(3))
def test_agrees_with_the_oracle(seed):
    now, before = noise(seed), noise(seed + 10)
    slow = np.array(slow_fdsr(now.tolist(), before.tolist()))
    assert fdsr(now, before, P, CLOCK_MS) == pytest.approx(slow, abs=1e-5)


@few
@given(channel)
def test_still_channel_is_exactly_silent(now):
    assert not fdsr(now, now.copy(), P, CLOCK_MS).any()


@few
@given(channel)
def test_falling_channel_is_exactly_silent(before):
    assert not fdsr(before * np.float32(0.5), before, P, CLOCK_MS).any()


@few
@given(channels)
def test_bounds_dtype_and_inputs(pair):
    now, before = pair
    copies = now.copy(), before.copy()
    adapted = fdsr(now, before, P, CLOCK_MS)
    assert adapted.dtype == np.float32
    assert adapted.min() >= 0
    assert (adapted <= now).all()
    assert np.array_equal(now, copies[0])
    assert np.array_equal(before, copies[1])


@few
@given(channels)
def test_scales_with_the_light(pair):
    now, before = pair
    twice = fdsr(2 * now, 2 * before, P, CLOCK_MS)
    assert np.array_equal(twice, 2 * fdsr(now, before, P, CLOCK_MS))


def test_slower_rise_passes_more():
    now, before = np.full((3, 3), 10, np.float32), np.zeros((3, 3), np.float32)
    assert fdsr(now, before, FdsrParams(rise_ms=CLOCK_MS), CLOCK_MS) == pytest.approx(5)  # a = 1/2


def test_switched_off_hands_the_channel_on():
    now = noise(0)
    assert np.array_equal(fdsr(now, noise(1), FdsrParams(enabled=False), CLOCK_MS), now)


@pytest.mark.parametrize("bad", [0.0, -1.0, 101.0, math.nan])
def test_rejects(bad):
    with pytest.raises(ParameterError, match=r"FdsrParams\.rise_ms = .* in \[0\.1, 100\] ms"):
        FdsrParams(rise_ms=bad)
