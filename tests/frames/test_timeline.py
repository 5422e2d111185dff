"""One run of time over every count of stamps, and what of a picture's way is seen as latency."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lobula.frames.timeline import AHEAD_S, BACK_S, WINDOW_S, Timeline, Transit

times = st.floats(-1e6, 1e6, allow_nan=False)


def placed(pairs, connect_before=()):
    line = Timeline()
    out = []
    for number, (stamp_s, arrived_s) in enumerate(pairs):
        if number in connect_before:
            line.connect()
        out.append(line.place(stamp_s, arrived_s))
    return out, line


def test_stamps_in_order_are_left_as_they_are():
    stamps = [0.5, 0.6, 0.75, 2.0]
    out, line = placed([(s, 10 + s) for s in stamps])
    assert out == stamps
    assert line.breaks == 0


def test_a_hiccup_of_the_network_changes_no_time():
    arrivals = [0, 0.04, 9.0, 9.001, 9.002, 9.1]  # nine seconds late, then a burst
    out, line = placed([(0.04 * i, a) for i, a in enumerate(arrivals)])
    assert out == pytest.approx([0.04 * i for i in range(6)])
    assert line.breaks == 0


def test_pictures_out_of_order_have_no_place():
    out, _ = placed([(1.0, 0), (1.0, 0.1), (0.5, 0.2), (1.1, 0.3)])
    assert out == [1.0, None, None, 1.1]


@pytest.mark.parametrize("jump_s", [-BACK_S - 0.1, -3600.0, AHEAD_S + 0.1, 86400.0])
def test_a_clock_that_was_set_begins_a_new_count(jump_s):
    out, line = placed([(1.0, 1.0), (1.1, 1.1), (1.2 + jump_s, 1.2), (1.3 + jump_s, 1.3)])
    assert out == pytest.approx([1.0, 1.1, 1.2, 1.3])
    assert line.breaks == 1


def test_another_connection_counts_from_anywhere_and_the_time_away_counts():
    out, line = placed([(0.0, 5.0), (0.1, 5.1), (0.0, 65.1), (0.1, 65.2), (7.0, 70.0), (7.1, 70.1)], {2, 4})
    assert out == pytest.approx([0.0, 0.1, 60.1, 60.2, 65.0, 65.1])
    assert line.breaks == 2


def test_connecting_before_the_first_picture_is_no_break():
    out, line = placed([(3.0, 0.0), (3.1, 0.1)], {0})
    assert out == [3.0, 3.1]
    assert line.breaks == 0


@given(st.lists(st.tuples(times, st.floats(0, 1e3)), max_size=30), st.sets(st.integers(0, 29)))
def test_time_always_increases(steps, connections):
    arrived_s, pairs = 0.0, []
    for stamp_s, waited_s in steps:
        arrived_s += waited_s
        pairs.append((stamp_s, arrived_s))
    out, _ = placed(pairs, connections)
    there = [t for t in out if t is not None]
    assert all(a < b for a, b in itertools.pairwise(there))


def latencies(pairs):
    transit = Transit()
    return [arrived_s - transit.captured(time_s, arrived_s) for time_s, arrived_s in pairs]


def test_the_fastest_way_counts_as_none_and_a_queue_in_full():
    ways_s = [0.3, 0.2, 0.2, 0.9, 0.2]  # of pictures a tenth of a second apart
    pairs = [(0.1 * i, 100 + 0.1 * i + way_s) for i, way_s in enumerate(ways_s)]
    assert latencies(pairs) == pytest.approx([0, 0, 0, 0.7, 0])  # of the first nobody knows yet that it was slow


def test_a_camera_whose_clock_drifts_is_no_queue():
    # 200 ppm slow: after an hour its stamps lag 0.72 s behind, but the fastest way is one of the last minute
    pairs = [(t, t * 1.0002) for t in range(3600)]
    assert max(latencies(pairs)) <= 2 * WINDOW_S * 0.0002 + 1e-9


def test_after_a_break_the_way_is_measured_afresh():
    transit = Transit()
    transit.captured(0.0, 10.0)
    transit.restart()
    assert transit.captured(1.0, 12.0) == 12.0
