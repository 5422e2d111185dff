"""Stretches and thinning, by hand."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lobula.report.spans import Span, collision_spans, frame_ends_s, state_spans, thinned
from lobula.types import TRACE_DTYPE

from .approach import table


def test_spans_of_the_hand_made_run() -> None:
    assert collision_spans(table()) == [Span("collision", 1.8, 2.4)]  # frames 18 to 23, until frame 24 comes
    assert state_spans(table()) == [Span("warming_up", 0.0, 0.3)]
    assert [s.name for s in state_spans(table(), without=())] == ["warming_up", "ok"]


def test_a_span_at_the_end_lasts_one_median_gap() -> None:
    trace = table()[:20]
    assert collision_spans(trace) == [Span("collision", 1.8, 1.9 + 0.1)]
    assert frame_ends_s(np.array([1.0])).tolist() == [1.0]


def test_nothing_has_no_spans() -> None:
    assert collision_spans(np.zeros(0, TRACE_DTYPE)) == state_spans(np.zeros(0, TRACE_DTYPE)) == []


@given(arrays(np.float64, st.integers(1, 300), elements=st.floats(-1, 1)), st.integers(2, 40))
def test_thinning_keeps_order_and_extremes(values: np.ndarray, most: int) -> None:
    time_s = np.arange(len(values), dtype=float)
    t, v = thinned(time_s, values, most)
    assert len(t) == len(v) <= max(most, 2)
    assert (np.diff(t) > 0).all()
    assert v.min() == values.min()
    assert v.max() == values.max()
    assert np.array_equal(values[t.astype(int)], v)
