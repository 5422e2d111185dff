"""Two-tap shares."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lobula.model.filters import low_pass_share

from .pictures import CLOCK_MS, few


@pytest.mark.parametrize(
    ("tau_ms", "share"),
    [(15, 0.690), (30, 0.526), (45, 0.426), (60, 0.357), (120, 0.217), (180, 0.156), (1, 0.971)],
)
def test_golden_at_the_clock(tau_ms, share):  # a = 33.3 / (33.3 + tau)
    assert low_pass_share(CLOCK_MS, tau_ms) == pytest.approx(share, abs=5e-4)


@few
@given(st.floats(1, 1000), st.floats(0.1, 1000))
def test_is_a_share(dt_ms, tau_ms):
    assert 0 < low_pass_share(dt_ms, tau_ms) < 1


def test_equal_times_share_equally():
    assert low_pass_share(40.0, 40.0) == 0.5
