"""So many a second by the frames' own stamps."""

from __future__ import annotations

import math
from itertools import pairwise

from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.hooks.pace import Pace


@settings(max_examples=50)
@given(st.floats(0.1, 1000), st.lists(st.floats(1e-4, 1), min_size=2, max_size=100))
def test_never_more_than_the_rate_and_the_first_at_once(rate_hz, gaps):
    pace, time_s, due = Pace(rate_hz), 5.0, []
    for gap in gaps:
        if pace.due(time_s):
            due.append(time_s)
        time_s += gap
    assert due[0] == 5.0
    assert all(b - a >= 1 / rate_hz - 2e-6 for a, b in pairwise(due))


def test_none_and_all():
    never, always = Pace(0), Pace(math.inf)
    times_s = [i / 120 for i in range(10)]
    assert not any(map(never.due, times_s))
    assert all(map(always.due, times_s))


def test_stamps_that_are_sums_of_rounded_numbers():
    pace, time_s = Pace(10), 0.0
    due = []
    for i in range(31):
        if pace.due(time_s):
            due.append(i)
        time_s += 0.1 / 3
    assert due == list(range(0, 31, 3))
