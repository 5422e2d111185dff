"""The LPTCs: net motion, right against left."""

import math

import numpy as np
import pytest
from hypothesis import given
from oracles.emd import correlate, potentials

from lobula.errors import ParameterError
from lobula.model.lamina import OnOff
from lobula.model.medulla.emd import EmdParams
from lobula.model.neurons.lptc import Lptc, LptcParams

from ..pictures import CLOCK_MS, channel, channels, few, noise, spot

P = LptcParams()
SHAPE = (4, 9)
DARK = np.zeros(SHAPE, np.float32)
NOTHING = OnOff(DARK, DARK)


def read(now, before, p=P, ticks=1.0):
    lptc = Lptc(p, CLOCK_MS)
    motion = lptc.step(now, before, ticks)
    return lptc, motion


def test_golden_one_spot_by_hand():
    # one span: R = 0.545455 for a spot of 1; n K = 36 * 0.1 = 3.6; V = tanh(0.545455 / 3.6 / 2) = 0.0756130
    p = LptcParams(emd=EmdParams(spans_px=(1,), delays_ms=(40.0,)), sigmoid_grey2=0.1)
    lptc, motion = read(OnOff(spot(SHAPE, 2, 4, 1.0), DARK), OnOff(spot(SHAPE, 2, 3, 1.0), DARK), p)
    assert motion.sum() == pytest.approx(0.545455, rel=1e-5)
    assert lptc.rightward == pytest.approx(math.tanh(0.0757576), rel=1e-5)
    assert lptc.leftward == 0


def test_golden_threshold_equivalent():
    # |U| = 0.2 at HS / n = 0.405465 K = 0.00405: 0.145967 over 36 pixels, a spot of sqrt(x / 0.545455)
    p = LptcParams(emd=EmdParams(spans_px=(1,), delays_ms=(40.0,)))
    for value, spikes in ((0.5171, 0), (0.5175, 1)):  # 0.517305 exactly
        lptc, _ = read(OnOff(spot(SHAPE, 2, 4, value), DARK), OnOff(spot(SHAPE, 2, 3, value), DARK), p)
        assert lptc.spikes() == (spikes, 0)


def test_on_and_off_add_up():
    now, before = spot(SHAPE, 2, 4, 0.3), spot(SHAPE, 2, 3, 0.3)
    on = read(OnOff(now, DARK), OnOff(before, DARK))[1]
    off = read(OnOff(DARK, now), OnOff(DARK, before))[1]
    both = read(OnOff(now, now), OnOff(before, before))[1]
    assert np.array_equal(on, off)
    assert np.array_equal(both, 2 * on)


def test_channels_do_not_meet():
    """A bright spot that comes where a dark one was is no motion."""
    lptc, motion = read(OnOff(spot(SHAPE, 2, 4, 9.0), DARK), OnOff(DARK, spot(SHAPE, 2, 3, 9.0)))
    assert not motion.any()
    assert (lptc.rightward, lptc.leftward) == (0, 0)


@pytest.mark.parametrize("seed", range(3))
def test_agrees_with_the_oracle(seed):
    now, before = (OnOff(noise(k, SHAPE, high=0.4), noise(k + 9, SHAPE, high=0.4)) for k in (seed, seed + 30))
    maps = [correlate(n.tolist(), b.tolist(), [1, 2, 3, 4], [40.0, 30.0, 20.0, 10.0])
            for n, b in zip(now, before, strict=True)]  # fmt: skip
    slow = np.array(maps).sum(axis=0)
    lptc, motion = read(now, before)
    assert motion == pytest.approx(slow, abs=1e-6)
    assert (lptc.rightward, lptc.leftward) == pytest.approx(potentials(slow.sum(), slow.size, 0.01), abs=1e-5)


@few
@given(channels)
def test_one_speaks_at_a_time_within_its_range(pair):
    now, before = pair
    lptc, _ = read(OnOff(now, before), OnOff(before, now))
    assert 0 <= lptc.rightward < 1
    assert -1 < lptc.leftward <= 0
    assert lptc.rightward * lptc.leftward == 0


@few
@given(channels)
def test_mirror_image_swaps_them(pair):
    now, before = (OnOff(m, np.zeros_like(m)) for m in pair)
    there = read(now, before)[0]
    back = read(*(OnOff(*(m[:, ::-1] for m in maps)) for maps in (now, before)))[0]
    net = sum(float((m.astype(np.float64) ** 2).sum()) for m in pair)
    if abs(read(now, before)[1].sum(dtype=np.float64)) > 1e-5 * net:  # otherwise rounding chooses the side
        assert back.rightward == pytest.approx(-there.leftward, abs=1e-3)
        assert back.leftward == pytest.approx(-there.rightward, abs=1e-3)


@few
@given(channel)
def test_still_image_is_exactly_silent(now):
    lptc, motion = read(OnOff(now, now), OnOff(now, now))
    assert (lptc.rightward, lptc.leftward, lptc.spikes()) == (0, 0, (0, 0))
    assert not motion.any()


def test_saturated_potentials_stay_inside_their_ranges():
    right, left = (spot(SHAPE, 2, k, 255.0) for k in (4, 3))
    assert read(OnOff(right, DARK), OnOff(left, DARK))[0].rightward == math.nextafter(1.0, 0.0)
    lptc, _ = read(OnOff(left, DARK), OnOff(right, DARK))
    assert lptc.leftward == -math.nextafter(1.0, 0.0)
    assert lptc.spikes() == (0, 24)


def test_reset_really_resets():
    lptc = Lptc(P, CLOCK_MS)
    now, before = OnOff(spot(SHAPE, 2, 4, 1.0), DARK), OnOff(spot(SHAPE, 2, 3, 1.0), DARK)
    lptc.step(now, before, 1.0)
    first = lptc.rightward
    lptc.reset()
    assert (lptc.rightward, lptc.leftward) == (0, 0)
    lptc.step(now, before, 1.0)
    assert lptc.rightward == first > 0


def test_keeps_float32_and_the_inputs():
    now, before = OnOff(noise(0, SHAPE), noise(1, SHAPE)), OnOff(noise(2, SHAPE), noise(3, SHAPE))
    copies = [m.copy() for m in (*now, *before)]
    assert read(now, before)[1].dtype == np.float32
    assert all(np.array_equal(m, copy) for m, copy in zip((*now, *before), copies, strict=True))


@pytest.mark.parametrize("bad", [0.0, -0.01, 1001.0, math.nan])
def test_rejects(bad):
    with pytest.raises(ParameterError, match=r"LptcParams\.sigmoid_grey2 = .* grey\^2"):
        LptcParams(sigmoid_grey2=bad)
