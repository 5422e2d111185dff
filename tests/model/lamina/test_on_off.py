"""ON and OFF channels."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.lamina import on_off

from lobula.errors import ParameterError
from lobula.model.lamina.on_off import OnOffParams, split_on_off

from ..pictures import few, noise, signed

residuals = st.floats(0, 0.9)


def test_golden_one_row_by_hand():
    # x = 3, -4, 0 after ON = 10, 10, 0 and OFF = 0, 10, 20, a tenth of which stays
    signal, on, off = (np.array([row], np.float32) for row in ([3, -4, 0], [10, 10, 0], [0, 10, 20]))
    new_on, new_off = split_on_off(signal, on, off, 0.1)
    assert new_on == pytest.approx(np.array([[4.0, 1.0, 0.0]]))
    assert new_off == pytest.approx(np.array([[0.0, 5.0, 2.0]]))


@pytest.mark.parametrize("seed", range(3))
def test_agrees_with_the_oracle(seed):
    maps = noise(seed, low=-255), noise(seed + 10), noise(seed + 20)
    expected = on_off(*(m.tolist() for m in maps), 0.1)
    for channel, slow in zip(split_on_off(*maps, 0.1), expected, strict=True):
        assert channel == pytest.approx(np.array(slow), abs=1e-4)


@few
@given(signed, residuals)
def test_opposite_polarity_swaps_the_channels(signal, residual):
    before = np.abs(signal)
    on, off = split_on_off(signal, before, before * 0, residual)
    off_too, on_too = split_on_off(-signal, before * 0, before, residual)
    assert np.array_equal(on, on_too)
    assert np.array_equal(off, off_too)


@few
@given(signed)
def test_channels_add_up_to_the_signal(signal):
    nothing = np.zeros_like(signal)
    on, off = split_on_off(signal, nothing, nothing, 0.1)
    assert np.array_equal(on - off, signal)
    assert not (on * off).any()


@few
@given(signed, residuals)
def test_never_negative_and_float32_kept(signal, residual):
    before, original = np.abs(signal), signal.copy()
    for channel in split_on_off(signal, before, before, residual):
        assert channel.dtype == np.float32
        assert channel.min() >= 0
    assert np.array_equal(signal, original)
    assert np.array_equal(before, np.abs(original))


def test_silence_fades():
    on, off = np.full((3, 3), 100, np.float32), np.zeros((3, 3), np.float32)
    for _ in range(3):
        on, off = split_on_off(np.zeros_like(on), on, off, 0.1)
    assert on == pytest.approx(0.1)  # 100 * 0.1^3
    assert not off.any()


@pytest.mark.parametrize("bad", [-0.1, 0.95, math.nan, "0.1"])
def test_rejects(bad):
    with pytest.raises(ParameterError, match=r"OnOffParams\.residual = .* in \[0, 0\.9\]"):
        OnOffParams(residual=bad)
