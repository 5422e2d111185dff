"""The LGMDs: one branch from channels to spikes."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from oracles import lgmd as slow

from lobula.errors import ParameterError
from lobula.model.lamina import OnOff
from lobula.model.medulla.coarse import Coarse
from lobula.model.medulla.grouping import GroupingParams
from lobula.model.neurons.lgmd import Lgmd, LgmdParams
from lobula.model.neurons.sfa import SfaParams
from lobula.model.presets import preset

from ..pictures import CLOCK_MS, channels, few, noise

ONE = preset("published").lgmd1
TWO = preset("published").lgmd2
OPEN = replace(ONE, grouping=GroupingParams(threshold_grey=0.0))
SHAPE = (6, 7)
DARK = np.zeros(SHAPE, np.float32)
NOTHING = OnOff(DARK, DARK)
SILENT = Coarse(0.0, 0.0)


def uniform(value):
    return np.full(SHAPE, value, np.float32)


def run(lgmd, steps=5):
    potentials = []
    before = NOTHING
    for seed in range(steps):
        now = OnOff(noise(seed, SHAPE, high=20 + 40 * seed), noise(seed + 50, SHAPE, high=20 + 40 * seed))
        lgmd.step(now, before, Coarse(10.0 * seed, 90.0 * seed), 3.0 * seed, CLOCK_MS)
        potentials.append((lgmd.raw, lgmd.potential, lgmd.spikes()))
        before = now
    return potentials


def test_golden_uniform_flash_by_hand():
    # E = 0.5 everywhere, nothing before: I = 0.5 (0.357143 + 0.217391 + 0.078125) = 0.326330
    # S = 0.5 - 0.5 I = 0.336835;  Ce = S;  G = S^2 / (0.01 + S / 4) = 0.113458 / 0.0942088 = 1.204325
    # K = 1 / (1 + exp(-1.204325)) = 0.769293;  U = 0.96 K = 0.738521, one spike
    lgmd = Lgmd(OPEN, CLOCK_MS)
    maps = lgmd.step(OnOff(uniform(0.5), DARK), NOTHING, SILENT, 0.0, CLOCK_MS)
    assert maps["inhibition_on"] == pytest.approx(0.326330, rel=1e-5)
    assert maps["summation"] == pytest.approx(0.336835, rel=1e-5)
    assert maps["grouped"] == pytest.approx(1.204325, rel=1e-5)
    assert lgmd.raw == pytest.approx(0.769293, abs=1e-5)
    assert lgmd.potential == pytest.approx(0.738521, abs=1e-5)
    assert lgmd.spikes() == 1


def test_golden_arousal_raises_the_bias_by_hand():
    # a(10 ms) = 0.769231: w = 0.769231 * 20 / 20 > 0.5, then (0.769231 + 0.230769) * 20 / 20 = 1
    lgmd = Lgmd(OPEN, CLOCK_MS)
    for bias in (0.769231, 1.0):
        s = lgmd.step(OnOff(uniform(100.0), DARK), NOTHING, SILENT, 20.0, CLOCK_MS)["summation"]
        assert s == pytest.approx(100 - bias * 65.2659, rel=1e-4)


def test_golden_slow_arousal_of_lgmd2_by_hand():
    # a(90 ms) = 0.270270: w_off = 0.27027 * 20 / 20 < 0.5 at first, then 1
    lgmd = Lgmd(replace(TWO, grouping=GroupingParams(threshold_grey=0.0)), CLOCK_MS)
    for bias in (0.5, 1.0):
        s = lgmd.step(OnOff(DARK, uniform(100.0)), NOTHING, SILENT, 20.0, CLOCK_MS)["summation"]
        assert s == pytest.approx(100 - bias * 65.2659, rel=1e-4)


def test_golden_gains_and_product():
    # without inhibition S_on = 2, S_off = 3: 0.5 * 2 + 1 * 3 + 2 * 2 * 3 = 16
    free = replace(ONE.on, centre_weight=0.0, nearest_weight=0.0, diagonal_weight=0.0)
    p = replace(OPEN, on=free, off=free, on_gain=0.5, off_gain=1.0, product_gain=2.0)
    maps = Lgmd(p, CLOCK_MS).step(OnOff(uniform(2), uniform(3)), NOTHING, SILENT, 0.0, CLOCK_MS)
    assert (maps["summation"] == 16).all()


def test_golden_patches_by_hand():
    # 42 px; 2 * (33 - 3 * 4) = 42: K = 1 / (1 + exp(-1)) = 0.731059, U = 0.96 K = 0.701816, one spike
    lgmd = Lgmd(replace(ONE, coarse_gain=2.0, coarse_on_weight=3.0), CLOCK_MS)
    maps = lgmd.step(NOTHING, NOTHING, Coarse(on=4.0, off=33.0), 0.0, CLOCK_MS)
    assert lgmd.raw == pytest.approx(0.731059, abs=1e-6)
    assert lgmd.potential == pytest.approx(0.701816, abs=1e-6)
    assert lgmd.spikes() == 1
    assert not any(m.any() for m in maps.values())


def test_golden_patches_join_the_grouped_cells():
    # the uniform flash above is 1.204325 for each pixel; 21 / 42 px is 0.5 more: K = 1 / (1 + exp(-1.704325))
    lgmd = Lgmd(replace(OPEN, coarse_gain=1.0, coarse_on_weight=0.0), CLOCK_MS)
    lgmd.step(OnOff(uniform(0.5), DARK), NOTHING, Coarse(on=1000.0, off=21.0), 0.0, CLOCK_MS)
    assert lgmd.raw == pytest.approx(0.846099, abs=1e-5)


def test_golden_scale_of_the_patches():  # 42 / (42 * 4) = 0.25: K = 0.562177
    lgmd = Lgmd(replace(ONE, coarse_gain=2.0, sigmoid_grey=4.0), CLOCK_MS)
    lgmd.step(NOTHING, NOTHING, Coarse(on=0.0, off=21.0), 0.0, CLOCK_MS)
    assert lgmd.raw == pytest.approx(0.562177, abs=1e-6)


@pytest.mark.parametrize("on", [11.0, 12.0, 1e6])
def test_patches_that_brighten_never_take_off_more_than_there_is(on):  # 33 - 3 * 11 = 0
    lgmd = Lgmd(replace(OPEN, coarse_gain=100.0, coarse_on_weight=3.0), CLOCK_MS)
    lgmd.step(NOTHING, NOTHING, Coarse(on, off=33.0), 0.0, CLOCK_MS)
    assert lgmd.potential == 0.5
    lgmd.reset()
    lgmd.step(OnOff(uniform(0.5), DARK), NOTHING, Coarse(on, off=33.0), 0.0, CLOCK_MS)
    assert lgmd.raw == pytest.approx(0.769293, abs=1e-5)  # the cells keep what is theirs


def test_without_a_gain_nobody_hears_the_patches():
    lgmd = Lgmd(replace(ONE, coarse_gain=0.0), CLOCK_MS)
    lgmd.step(NOTHING, NOTHING, Coarse(on=0.0, off=1e6), 0.0, CLOCK_MS)
    assert lgmd.potential == 0.5


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("p", [ONE, TWO], ids=["lgmd1", "lgmd2"])
def test_agrees_with_the_oracle(seed, p):
    rings = [slow.Rings((i.centre_weight, i.nearest_weight, i.diagonal_weight),
                        (i.centre_ms, i.nearest_ms, i.diagonal_ms), i.bias) for i in (p.on, p.off)]  # fmt: skip
    now, before = (OnOff(noise(k, SHAPE), noise(k + 30, SHAPE)) for k in (seed, seed + 60))
    on, off = ((n.tolist(), b.tolist()) for n, b in zip(now, before, strict=True))
    arousal = CLOCK_MS / (CLOCK_MS + p.change_ms) * 12.0 / 20
    s_on, s_off = (slow.competition(e[0], slow.inhibition(*e, ring), max(ring.bias, arousal))
                   for e, ring in zip((on, off), rings, strict=True))  # fmt: skip
    s = slow.summation(s_on, s_off, (1.0, 1.0, p.product_gain))
    g = slow.grouping(s)
    raw = slow.sigmoid(g)
    lgmd = Lgmd(p, CLOCK_MS)
    maps = lgmd.step(now, before, SILENT, 12.0, CLOCK_MS)
    assert maps["summation"] == pytest.approx(np.array(s), rel=1e-4, abs=1e-3)
    assert maps["grouped"] == pytest.approx(np.array(g), rel=1e-4, abs=1e-3)
    assert lgmd.raw == pytest.approx(raw, abs=1e-6)
    assert lgmd.potential == pytest.approx(slow.adaptation(raw, 0.5, 0.5), abs=1e-6)


@few
@given(channels)
def test_lgmd2_is_deaf_to_brightening(pair):
    lgmd = Lgmd(replace(TWO, product_gain=8.0, grouping=GroupingParams(threshold_grey=0.0)), CLOCK_MS)
    now = OnOff(pair[0], np.zeros_like(pair[0]))
    maps = lgmd.step(now, OnOff(pair[1], now.off), SILENT, 0.0, CLOCK_MS)
    assert not maps["summation"].any()
    assert lgmd.potential == 0.5


@few
@given(channels)
def test_lgmd1_does_not_mind_polarity(pair):
    nothing = np.zeros_like(pair[0])
    potentials = []
    for swap in (slice(None), slice(None, None, -1)):
        lgmd = Lgmd(ONE, CLOCK_MS)
        lgmd.step(OnOff(*(pair[0], nothing)[swap]), OnOff(*(pair[1], nothing)[swap]), SILENT, 5.0, CLOCK_MS)
        potentials.append(lgmd.potential)
    assert potentials[0] == potentials[1]


@few
@given(channels)
def test_bounds_dtype_and_inputs(pair):
    copies = [m.copy() for m in pair]
    lgmd = Lgmd(replace(ONE, sfa=SfaParams(enabled=False), coarse_gain=100.0, sigmoid_grey=1e-6), CLOCK_MS)
    maps = lgmd.step(OnOff(*pair), OnOff(*pair[::-1]), Coarse(5.0, 1e6), 0.0, CLOCK_MS)
    assert 0.5 <= lgmd.potential < 1
    assert {m.dtype.name for m in maps.values()} == {"float32"}
    assert set(maps) == {"inhibition_on", "inhibition_off", "summation", "grouped"}
    assert all(np.array_equal(m, copy) for m, copy in zip(pair, copies, strict=True))


def test_saturated_potential_stays_below_one():
    lgmd = Lgmd(replace(ONE, sfa=SfaParams(enabled=False)), CLOCK_MS)
    lgmd.step(OnOff(uniform(255.0), DARK), NOTHING, SILENT, 0.0, CLOCK_MS)
    assert lgmd.potential == math.nextafter(1.0, 0.0)
    assert lgmd.spikes() == 3


def test_silence_on_nothing():
    lgmd = Lgmd(ONE, CLOCK_MS)
    maps = lgmd.step(NOTHING, NOTHING, SILENT, 0.0, CLOCK_MS)
    assert not any(m.any() for m in maps.values())
    assert (lgmd.raw, lgmd.potential, lgmd.spikes()) == (0.5, 0.5, 0)


def test_reset_really_resets():
    lgmd = Lgmd(replace(ONE, coarse_gain=0.01), CLOCK_MS)
    first = run(lgmd)
    assert len(set(first)) > 2
    assert run(lgmd) != first  # it does remember
    lgmd.reset()
    assert run(lgmd) == first


@pytest.mark.parametrize(
    ("name", "bad"),
    [("reads", "retina"), ("neighbour_px", 0), ("change_scale_grey", 0.0), ("change_ms", math.nan), ("on_gain", -1.0),
     ("off_gain", 9.0), ("product_gain", math.inf), ("coarse_gain", -1.0), ("coarse_gain", 101.0),
     ("coarse_on_weight", -0.5), ("coarse_on_weight", math.nan), ("sigmoid_grey", 0.0)],
)  # fmt: skip
def test_rejects(name, bad):
    with pytest.raises(ParameterError, match=rf"LgmdParams\.{name} = "):
        LgmdParams(**{name: bad})
