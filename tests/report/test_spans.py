"""Stretches and thinning, by hand."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lobula.report.spans import Span, collision_spans, frame_ends_s, state_spans, thinned
from lobula.runtime.events import collisions_of
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


def test_alarms_half_a_second_apart_are_one_collision() -> None:
    trace = table()
    trace["collision"] = False
    trace["collision"][[2, 7, 13]] = True  # off at 0.3, on at 0.7; off at 0.8, on at 1.3: 0.5 s; off at 1.4
    assert [(s.start_s, round(s.end_s, 9)) for s in collision_spans(trace)] == [(0.2, 1.4)]
    trace["collision"][[13, 14]] = False, True
    assert [(s.start_s, round(s.end_s, 9)) for s in collision_spans(trace)] == [(0.2, 0.8), (1.4, 1.5)]


@given(st.lists(st.booleans(), min_size=1, max_size=60), st.sampled_from([10.0, 12.5, 30.0]))
def test_spans_are_the_events_of_the_run(alarms: list[bool], hz: float) -> None:
    trace = np.zeros(len(alarms), TRACE_DTYPE)
    trace["frame"], trace["time_s"] = np.arange(len(alarms)), np.arange(len(alarms)) / hz
    trace["collision"], trace["state"] = alarms, "ok"
    spans, told = collision_spans(trace), collisions_of(trace)
    assert [s.start_s for s in spans] == [c.start_s for c in told]
    if not alarms[-1]:  # a run that ends inside a collision ends it at its last frame; a span includes that frame
        assert [s.end_s for s in spans] == [c.end_s for c in told]


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
