"""Lateral inhibition and competition."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.lgmd import Rings
from oracles.lgmd import inhibition as slow_inhibition

from lobula.errors import ParameterError
from lobula.model.medulla.lateral_inhibition import InhibitionParams, compete, lateral_inhibition, ring_sum

from ..pictures import CLOCK_MS, channel, channels, few, noise, spot

SLOW = InhibitionParams()
FAST = InhibitionParams(
    centre_weight=2.0, nearest_weight=0.5, diagonal_weight=0.25, centre_ms=15.0, nearest_ms=30.0, diagonal_ms=45.0
)
"""The ON channel of LGMD-2."""
NOTHING = np.zeros((5, 5), np.float32)


def test_golden_one_bright_pixel_now_by_hand():
    # a = 0.357143, 0.217391, 0.15625: 100 * 1 * 0.357143 and 25 * 0.217391 and 12.5 * 0.15625
    i = lateral_inhibition(spot((5, 5), 2, 2, 100.0), NOTHING, SLOW, 1, CLOCK_MS)
    assert i[2, 1:4] == pytest.approx([5.434783, 35.714286, 5.434783], rel=1e-5)
    assert i[1, 1:4] == pytest.approx([1.953125, 5.434783, 1.953125], rel=1e-5)
    assert np.count_nonzero(i) == 9


def test_golden_one_bright_pixel_before_by_hand():
    # what the delays kept back: 100 * 0.642857 and 25 * 0.782609 and 12.5 * 0.84375
    i = lateral_inhibition(NOTHING, spot((5, 5), 2, 2, 100.0), SLOW, 1, CLOCK_MS)
    assert i[1, 1:4] == pytest.approx([10.546875, 19.565217, 10.546875], rel=1e-5)
    assert i[2, 2] == pytest.approx(64.285714, rel=1e-5)


def test_golden_corner_repeats_outwards():
    # outside the corner lie copies of it: one centre, two nearest, one diagonal
    total = ring_sum(spot((5, 5), 0, 0, 1.0), (100.0, 10.0, 1.0), 1)
    assert total[0, 0] == 100 + 2 * 10 + 1
    assert total[0, 1] == 10 + 1  # beside it; the copy above is diagonal
    assert total[1, 1] == 1


def test_golden_neighbours_two_pixels_off():
    total = ring_sum(spot((7, 7), 3, 3, 1.0), (100.0, 10.0, 1.0), 2)
    assert total[3].tolist() == [0, 10, 0, 100, 0, 10, 0]
    assert total[1].tolist() == [0, 1, 0, 10, 0, 1, 0]
    assert not total[2].any()


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("p", "rings"), [
    (SLOW, Rings((1.0, 0.25, 0.125), (60.0, 120.0, 180.0), 0.5)),
    (FAST, Rings((2.0, 0.5, 0.25), (15.0, 30.0, 45.0), 1.0)),
])  # fmt: skip
def test_agrees_with_the_oracle(seed, p, rings):
    now, before = noise(seed), noise(seed + 10)
    slow = slow_inhibition(now.tolist(), before.tolist(), rings)
    assert lateral_inhibition(now, before, p, 1, CLOCK_MS) == pytest.approx(np.array(slow), rel=1e-5)


@few
@given(st.floats(0, 255, width=32))
def test_steady_light_is_weighed_whole(value):
    """The shares of now and before add up to 1: I = (1 + 4 * 0.25 + 4 * 0.125) E."""
    steady = np.full((5, 6), value, np.float32)
    assert lateral_inhibition(steady, steady, SLOW, 1, CLOCK_MS) == pytest.approx(2.5 * value, rel=1e-5)


@few
@given(channels)
def test_mirrored_and_turned_pictures(pair):
    i = lateral_inhibition(*pair, SLOW, 1, CLOCK_MS)
    for turned in (np.fliplr, np.flipud, np.transpose):
        other = lateral_inhibition(*map(turned, pair), SLOW, 1, CLOCK_MS)
        assert other == pytest.approx(turned(i), rel=1e-5, abs=1e-5)


@few
@given(channels)
def test_bounds_dtype_and_inputs(pair):
    copies = [m.copy() for m in pair]
    i = lateral_inhibition(*pair, SLOW, 1, CLOCK_MS)
    assert i.dtype == np.float32
    assert i.min() >= 0
    assert i.max() <= 2.5001 * max(m.max() for m in pair)
    assert all(np.array_equal(m, copy) for m, copy in zip(pair, copies, strict=True))


def test_silence_on_nothing():
    assert not lateral_inhibition(NOTHING, NOTHING, SLOW, 1, CLOCK_MS).any()


def test_golden_competition_by_hand():  # 10 - 0.5 * 8 = 6;  10 - 0.5 * 30 < 0
    s = compete(np.array([[10, 10]], np.float32), np.array([[8, 30]], np.float32), 0.5)
    assert s.tolist() == [[6, 0]]


@few
@given(channels, st.floats(0, 8))
def test_competition_only_takes_away(pair, bias):
    s = compete(*pair, bias)
    assert s.dtype == np.float32
    assert s.min() >= 0
    assert (s <= pair[0]).all()


@few
@given(channel)
def test_fast_inhibition_wins_everywhere(now):
    """Why LGMD-2 is deaf to brightening: 2 * 0.69 of a cell's own excitation comes back at once."""
    i = lateral_inhibition(now, np.zeros_like(now), FAST, 1, CLOCK_MS)
    assert not compete(now, i, FAST.bias + 0.5).any()


@pytest.mark.parametrize(
    ("name", "bad"),
    [("centre_weight", -1.0), ("nearest_weight", 5.0), ("diagonal_weight", math.nan), ("centre_ms", 0.0),
     ("nearest_ms", 1e9), ("diagonal_ms", -1.0), ("bias", math.inf)],
)  # fmt: skip
def test_rejects(name, bad):
    with pytest.raises(ParameterError, match=rf"InhibitionParams\.{name} = .* must be float in \["):
        InhibitionParams(**{name: bad})
