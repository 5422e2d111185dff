"""Spikes: Eq. (4)."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.decision import spike_count as slow_count

from lobula.errors import ParameterError
from lobula.model.neurons.spiking import SpikingParams, spike_count

from ..pictures import few

LGMD, LPTC = SpikingParams(), SpikingParams(threshold=0.2)


@pytest.mark.parametrize(
    ("potential", "count"),
    # one more spike at 0.7 + ln(n) / 4: 0.7, 0.87329, 0.97465
    [(0.5, 0), (0.69, 0), (0.7, 1), (0.8732, 1), (0.8734, 2), (0.9746, 2), (0.9747, 3), (math.nextafter(1, 0), 3)],
)
def test_golden_lgmd_by_hand(potential, count):
    assert spike_count(potential, LGMD) == count


@pytest.mark.parametrize(
    ("potential", "count"),
    # exp(4 * 0.8) = 24.5 at the top
    [(0.0, 0), (0.19, 0), (0.2, 1), (0.374, 2), (0.5, 3), (math.nextafter(1, 0), 24)],
)
def test_golden_lptc_by_hand_either_way(potential, count):
    assert spike_count(potential, LPTC) == spike_count(-potential, LPTC) == count


@few
@given(st.floats(-1, 1))
def test_agrees_with_the_oracle(potential):
    assert spike_count(potential, LGMD) == slow_count(potential, 0.7)
    assert spike_count(potential, LPTC) == slow_count(potential, 0.2)


@few
@given(st.floats(0, 1), st.floats(0, 1))
def test_more_potential_never_fewer_spikes(one, other):
    low, high = sorted((one, other))
    assert 0 <= spike_count(low, LGMD) <= spike_count(high, LGMD)


@pytest.mark.parametrize(("name", "bad"), [("gain", 0.0), ("gain", math.nan), ("threshold", 1.0), ("threshold", -0.7)])
def test_rejects(name, bad):
    with pytest.raises(ParameterError, match=rf"SpikingParams\.{name} = .* must be float in \["):
        SpikingParams(**{name: bad})
