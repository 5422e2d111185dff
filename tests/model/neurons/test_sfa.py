"""Spike frequency adaptation."""

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.lgmd import adaptation

from lobula.errors import ParameterError
from lobula.model.neurons.sfa import SfaParams, adapt

from ..pictures import CLOCK_MS, few

P = SfaParams()
potentials = st.floats(0.5, 1)


def test_golden_a_rise_and_a_plateau_by_hand():
    # a = 800 / 833.333 = 0.96.  Rise to 0.9: 0.96 * 0.9 = 0.864.  Plateau: 0.96 * 0.864 = 0.82944, then 0.7962624.
    # Fall to 0.6: 0.96 * (0.7962624 - 0.3) = 0.476 < 0.5
    raw, u = [0.5, 0.9, 0.9, 0.9, 0.6], [0.5]
    for before, now in itertools.pairwise(raw):
        u.append(adapt(now, before, u[-1], P, CLOCK_MS, CLOCK_MS))
    assert u == pytest.approx([0.5, 0.864, 0.82944, 0.7962624, 0.5])


def test_golden_growth_at_the_limit_fades_and_above_it_does_not():
    # the limit is 0.003 a tick; 0.96 * (0.6 + 0.0029) = 0.578784 but 0.96 * 0.7031 = 0.674976
    assert adapt(0.7029, 0.7, 0.6, P, CLOCK_MS, CLOCK_MS) == pytest.approx(0.578784)
    assert adapt(0.7031, 0.7, 0.6, P, CLOCK_MS, CLOCK_MS) == pytest.approx(0.674976)


def test_golden_step_of_two_ticks_by_hand():
    # a = 800 / 866.667 = 0.923077 and the limit is 0.006: 0.923077 * (0.6 + 0.005) = 0.558462
    assert adapt(0.705, 0.7, 0.6, P, 2 * CLOCK_MS, CLOCK_MS) == pytest.approx(0.5584615)


@few
@given(potentials, potentials, potentials, st.floats(10, 400))
def test_agrees_with_the_oracle(raw, before, u, dt_ms):
    assert adapt(raw, before, u, P, dt_ms, CLOCK_MS) == pytest.approx(adaptation(raw, before, u, dt_ms), abs=1e-12)


@few
@given(potentials, potentials, potentials)
def test_never_above_the_ceiling_nor_below_rest(raw, before, u):
    assert 0.5 <= adapt(raw, before, u, P, CLOCK_MS, CLOCK_MS) <= max(0.96 * raw, 0.96 * u + 0.96 * 0.003, 0.5)


@few
@given(potentials)
def test_steady_drive_fades_to_rest(raw):
    u = raw
    for _ in range(30):
        faded = adapt(raw, raw, u, P, CLOCK_MS, CLOCK_MS)
        assert faded <= u
        u = faded
    assert u == 0.5  # 0.96^18 < 0.5


def test_switched_off_hands_the_potential_on():
    assert adapt(0.83, 0.9, 0.6, SfaParams(enabled=False), CLOCK_MS, CLOCK_MS) == 0.83


@pytest.mark.parametrize(
    ("name", "bad"), [("tau_ms", 0.0), ("tau_ms", math.nan), ("growth", -0.001), ("growth", 0.6), ("enabled", "yes")]
)
def test_rejects(name, bad):
    with pytest.raises(ParameterError, match=rf"SfaParams\.{name} = "):
        SfaParams(**{name: bad})
