"""Elementary motion detectors."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.emd import correlate
from oracles.emd import spans as spans_of

from lobula.errors import ParameterError
from lobula.model.medulla.emd import EmdParams, emd, stretched

from ..pictures import CLOCK_MS, channel, channels, few, noise, spot
from ..stamps import HABITS, steps_ms

P = EmdParams()
ONE = EmdParams(spans_px=(1,), delays_ms=(40.0,))


def test_golden_one_row_by_hand():
    # 2 at the left cell before, 3 at the right one now; 1 - a = 40 / 73.333 = 0.545455: R = 0.545455 * 2 * 3
    motion = emd(np.array([[0, 3.0]], np.float32), np.array([[2.0, 0]], np.float32), ONE, CLOCK_MS, 1.0)
    assert motion.image == pytest.approx(np.array([[3.272727, 0]]), rel=1e-6)
    assert motion.total == pytest.approx(3.272727, rel=1e-6)


def test_golden_each_span_has_its_delay_by_hand():
    # a spot of 10 that jumps d to the right: 100 tau_d / (33.333 + tau_d), tau = 40, 30, 20, 10
    for d, expected in ((1, 54.5455), (2, 47.3684), (3, 37.5), (4, 23.0769)):
        motion = emd(spot((3, 9), 1, 2 + d, 10.0), spot((3, 9), 1, 2, 10.0), P, CLOCK_MS, 1.0)
        assert motion.total == pytest.approx(expected, rel=1e-5)
        assert motion.image[1, 2] == pytest.approx(expected, rel=1e-5)


def test_golden_too_far_is_not_seen():
    assert emd(spot((3, 9), 1, 7, 10.0), spot((3, 9), 1, 2, 10.0), P, CLOCK_MS, 1.0).total == 0


@pytest.mark.parametrize(
    ("ticks", "spans"),
    [(1.0, (1, 2, 3, 4)), (2.0, (2, 4, 6, 8)), (1.2, (1, 3, 4, 5)), (3.0, (3, 6, 9, 12)), (4.0, (4, 8, 12, 16)),
     (7.0, (4, 8, 12, 16)), (1.55, (2, 3, 5, 6)), (0.3, (1, 1, 1, 1)), (0.05, (1, 1, 1, 1)), (2.5, (3, 5, 8, 10)),
     (1.09, (1, 2, 3, 4)), (1.11, (1, 3, 4, 5)), (1.34, (1, 3, 4, 5)), (1.36, (2, 3, 5, 6))],
)  # fmt: skip
def test_golden_spans_of_slow_steps(ticks, spans):  # of quarter ticks, to the nearest pixel; from 4 on no further
    assert stretched((1, 2, 3, 4), ticks) == spans


@pytest.mark.parametrize(
    "hz", [7.5, 8, 10, 12, 12.5, 15, 16, 18, 20, 23.976, 24, 25, 29.97, 30, 40, 48, 50, 60, 100, 120]
)
def test_a_steady_source_has_steady_spans(hz):
    """However its stamps are rounded, and at the largest picture that kernels grow with."""
    spans = {
        stretched((1, 2, 3, 4, 16, 64), dt_ms / CLOCK_MS) for habit in HABITS for dt_ms in steps_ms(hz, 200, habit)
    }
    assert len(spans) == 1


def test_long_step_prefers_the_same_speed():
    """A spot at 2 px a tick: the same answer after one tick, and after two in a step of two, by another delay."""
    once = emd(spot((3, 12), 1, 4, 10.0), spot((3, 12), 1, 2, 10.0), P, CLOCK_MS, 1.0)
    twice = emd(spot((3, 12), 1, 6, 10.0), spot((3, 12), 1, 2, 10.0), P, CLOCK_MS, 2.0)
    assert once.total == twice.total > 0


def test_golden_change_that_counts_half_halves_the_motion():
    """Both channels are half of what they would be, a quarter of the product; one half is given back."""
    whole = emd(spot((3, 12), 1, 4, 10.0), spot((3, 12), 1, 2, 10.0), P, CLOCK_MS, 1.0)
    half = emd(spot((3, 12), 1, 4, 5.0), spot((3, 12), 1, 2, 5.0), P, CLOCK_MS, 1.0, 0.5)
    assert half.total == whole.total / 2 > 0


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("ticks", [1.0, 1.2, 2.0])
def test_agrees_with_the_oracle(seed, ticks):
    now, before = noise(seed, high=3.0), noise(seed + 10, high=3.0)
    slow = np.array(correlate(now.tolist(), before.tolist(), spans_of(ticks), [40.0, 30.0, 20.0, 10.0]))
    motion = emd(now, before, P, CLOCK_MS, ticks)
    assert motion.image == pytest.approx(slow, abs=1e-4)
    assert motion.total == pytest.approx(slow.sum(), abs=1e-4)


@few
@given(channels)
def test_mirror_image_reverses_the_sign(pair):
    now, before = pair
    there = emd(now, before, P, CLOCK_MS, 1.0).total
    back = emd(now[:, ::-1], before[:, ::-1], P, CLOCK_MS, 1.0).total
    assert back == pytest.approx(-there, rel=1e-5, abs=1e-6 * (1 + float((now * now).sum() + (before * before).sum())))


@few
@given(channels)
def test_time_run_backwards_reverses_the_sign(pair):
    now, before = pair
    there, back = emd(now, before, P, CLOCK_MS, 1.0), emd(before, now, P, CLOCK_MS, 1.0)
    assert np.array_equal(back.image, -there.image)
    assert back.total == -there.total


@few
@given(channel, st.floats(0.5, 4))
def test_still_image_is_exactly_silent(now, ticks):
    motion = emd(now, now.copy(), P, CLOCK_MS, ticks)
    assert motion.total == 0
    assert not motion.image.any()


@few
@given(channel)
def test_flicker_of_the_whole_is_silent(now):
    """A channel that only scales has no direction."""
    motion = emd(now, now * np.float32(0.5), P, CLOCK_MS, 1.0)
    assert abs(motion.total) <= 1e-5 * (1 + float((now.astype(np.float64) ** 2).sum()))


@few
@given(channel)
def test_vertical_motion_is_not_seen(now):
    column = np.repeat(now[:, :1], now.shape[1], axis=1)  # the same in every column
    assert emd(column, np.roll(column, 1, axis=0), P, CLOCK_MS, 1.0).total == 0


@few
@given(channels)
def test_grows_with_the_square_of_the_light(pair):
    now, before = pair
    assert np.array_equal(
        emd(2 * now, 2 * before, P, CLOCK_MS, 1.0).image, 4 * emd(now, before, P, CLOCK_MS, 1.0).image
    )


@few
@given(channels)
def test_dtype_and_inputs(pair):
    copies = [m.copy() for m in pair]
    motion = emd(*pair, P, CLOCK_MS, 1.0)
    assert motion.image.dtype == np.float32
    assert motion.image.shape == pair[0].shape
    assert all(np.array_equal(m, copy) for m, copy in zip(pair, copies, strict=True))


def test_spans_wider_than_the_picture_are_left_out():
    now, before = spot((3, 3), 1, 2, 10.0), spot((3, 3), 1, 1, 10.0)
    assert emd(now, before, P, CLOCK_MS, 4.0).total == 0  # spans 4, 8, 12, 16 on three columns


@pytest.mark.parametrize(
    ("name", "bad"),
    [("spans_px", (0, 1, 2, 3)), ("spans_px", (1, 2, 3, 65)), ("spans_px", (1.0, 2.0, 3.0, 4.0)), ("spans_px", ()),
     ("spans_px", 3), ("delays_ms", (40.0, 30.0, 20.0, math.nan)), ("delays_ms", (40.0, 30.0, 20.0, 0.0))],
)  # fmt: skip
def test_rejects(name, bad):
    with pytest.raises(ParameterError, match=rf"EmdParams\.{name} = "):
        EmdParams(**{name: bad})


@pytest.mark.parametrize("count", [3, 9])
def test_rejects_spans_without_their_delays(count):
    with pytest.raises(ParameterError, match=rf"EmdParams\.spans_px has {count} entries, delays_ms .* at most 8"):
        EmdParams(spans_px=tuple(range(1, count + 1)), delays_ms=(10.0,) * (4 if count == 3 else 9))
