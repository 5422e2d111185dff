"""The model clock: frames of any rate on ticks of 33.3 ms, worked out by hand."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lobula.errors import ParameterError
from lobula.model.clock import Beat, Clock, ClockParams, whole_quarters

from .pictures import few
from .stamps import HABITS, written

P = ClockParams()
MOVES, RESTS = (5.0, 60.0), (0.0, 0.0)
"""Mean and largest change of a picture that moved, and of one that repeats the one before."""


def walk(times_ms, changes=MOVES, p=P):
    """What each frame is: the length of its step in ms, or the name of what it does instead."""
    clock = Clock(p)
    told = []
    for k, t in enumerate(times_ms):
        beat = clock.beat(t / 1000)
        if beat is not Beat.TICK:
            told.append(beat.value)
            continue
        dt_ms = clock.advances(t / 1000, *(changes[k] if isinstance(changes, list) else changes))
        told.append("held" if dt_ms is None else round(dt_ms, 2))
    return told


def frames(hz, count):
    return [1000 / hz * k for k in range(count)]


def test_golden_30_hz_every_frame_is_a_tick():
    assert walk(frames(30, 4)) == ["start", 33.33, 33.33, 33.33]


def test_golden_30_hz_with_jitter():
    # intervals 26, 41, 24, 43, 33: each plus half of itself is past 33.3, so nothing waits and nothing is lost
    assert walk([0, 26, 67, 91, 134, 167]) == ["start", 26, 41, 24, 43, 33]


def test_golden_60_hz_every_second_frame():  # 16.7 + 8.3 = 25 < 33.3 waits; 33.3 + 8.3 does not
    assert walk(frames(60, 5)) == ["start", "wait", 33.33, "wait", 33.33]


def test_golden_120_hz_every_fourth_frame():  # 25 + 4.17 = 29.2 < 33.3 still waits
    assert walk(frames(120, 9)) == ["start", *(["wait"] * 3 + [33.33]) * 2]


def test_golden_50_hz_steps_of_40_ms():  # 20 is 13.3 ms short of the tick's end, 40 only 6.7 past it
    assert walk(frames(50, 5)) == ["start", "wait", 40, "wait", 40]


@pytest.mark.parametrize(("hz", "dt_ms"), [(25, 40.0), (15, 66.67), (10, 100.0), (2.5, 400.0)])
def test_golden_slow_sources_step_once_a_frame(hz, dt_ms):
    assert walk(frames(hz, 4)) == ["start", dt_ms, dt_ms, dt_ms]


def test_golden_dropped_frame_is_one_long_step():
    assert walk([0, 33.3, 66.7, 133.3, 166.7]) == ["start", 33.3, 33.4, 66.6, 33.4]


def test_golden_gap_starts_afresh():  # 500 ms, and one more for rounding, is a long step, 502 a new start
    assert walk([0, 33, 533, 566, 1068, 1101]) == ["start", 33, 500, 33, "start", 33]
    assert walk([0, 500.9, 1002]) == ["start", 500.9, "start"]


def test_golden_frame_that_comes_too_early_waits():  # 34 and then 5 ms: 5 + 2.5 < 33.3; then 33 since the tick
    assert walk([0, 34, 39, 67]) == ["start", 34, "wait", 33]


def test_golden_10_hz_in_a_30_hz_file():
    changes = [RESTS, RESTS, RESTS, MOVES, RESTS, RESTS, MOVES]
    assert walk(frames(30, 7), changes) == ["start", "held", "held", 100, "held", "held", 100]


def test_golden_10_hz_in_a_60_hz_file():
    changes = [RESTS] * 6 + [MOVES] + [RESTS] * 5 + [MOVES]
    assert walk(frames(60, 13), changes) == [
        "start", "wait", "held", "wait", "held", "wait", 100, "wait", "held", "wait", "held", "wait", 100,
    ]  # fmt: skip


def test_golden_two_frames_as_near_to_the_end_of_a_tick():
    # 45 Hz: 22.2 ms and 44.4 ms are each 11.1 off; 75 Hz: 26.7 and 40 are 6.7 off: the first of them is taken
    assert walk(frames(45, 4)) == ["start", 22.22, 22.22, 22.22]
    assert walk(frames(75, 7)) == ["start", "wait", 26.67, "wait", 26.67, "wait", 26.67]


@pytest.mark.parametrize("changes", [MOVES, RESTS])
@pytest.mark.parametrize("hz", [2, 5, 10, 12, 15, 20, 24, 25, 29.97, 30, 40, 45, 48, 50, 60, 75, 90, 100, 120])
def test_the_rounding_of_stamps_moves_no_step(hz, changes):
    """The same frames start, wait, are held and step, whatever wrote the stamps."""
    told = [walk([1000 * t for t in written(hz, 100, habit)], changes) for habit in HABITS]
    kinds = {tuple(x if isinstance(x, str) else "step" for x in seen) for seen in told}
    assert len(kinds) == 1


@pytest.mark.parametrize(
    ("ticks", "quarters"),
    [
        (1.0, 1.0),
        (0.999, 1.0),
        (1.02, 1.0),
        (1.099, 1.0),
        (1.101, 1.25),
        (1.2, 1.25),
        (2.5, 2.5),
        (0.09, 0.0),
        (7.9, 8),
    ],
)
def test_golden_quarters_of_ticks(ticks, quarters):
    assert whole_quarters(ticks) == quarters


def test_golden_still_scene_is_let_through():
    # repeats are held for 200 ms: 30 .. 180; at 210 the scene is still and from then on each frame steps
    assert walk([30 * k for k in range(10)], RESTS) == ["start", *["held"] * 6, 210, 30, 30]


def test_golden_motion_after_stillness_counts_one_step():
    changes = [RESTS] * 9 + [MOVES, RESTS, MOVES]
    assert walk([30 * k for k in range(12)], changes)[7:] == [210, 30, 30, "held", 60]


@pytest.mark.parametrize(("change", "held"), [((0.09, 7.9), True), ((0.1, 7.9), False), ((0.09, 8.0), False)])
def test_golden_what_repeats(change, held):  # mean under 0.1 and maximum under 8
    assert walk([0, 33], change)[1] == ("held" if held else 33)


def test_repeats_can_be_let_through():
    assert walk([0, 33, 66], RESTS, ClockParams(repeats=False)) == ["start", 33, 33]


@few
@given(st.lists(st.floats(4, 400), min_size=2, max_size=40))
def test_steps_cover_the_time_once(intervals):
    """However frames fall, the steps add up to the time from the start to the last step."""
    clock, t, covered = Clock(P), 0.0, 0.0
    assert clock.beat(t) is Beat.START
    for interval in intervals:
        t += interval / 1000
        if clock.beat(t) is Beat.TICK:
            covered += clock.advances(t, *MOVES) or 0.0
            assert covered == pytest.approx(t * 1000)
    assert t * 1000 - covered < P.period_ms


@few
@given(st.floats(4, 33.3))
def test_ticks_end_at_the_nearest_frame(interval_ms):
    """A steady fast source: within half an interval of 33.3 ms, and 3 % for two that are as near."""
    steps = [dt for dt in walk([interval_ms * k for k in range(40)]) if isinstance(dt, float)]
    assert steps
    assert max(abs(dt - P.period_ms) for dt in steps) <= 0.5 * interval_ms + 1.01


@pytest.mark.parametrize("hz", [15, 25, 30, 60, 120])
def test_a_later_start_is_the_same_clock(hz):
    assert walk([t + 7_654_321.0 for t in frames(hz, 30)]) == walk(frames(hz, 30))


def test_reset_really_resets():
    clock = Clock(P)
    told = []
    for _ in range(2):
        clock.reset()
        told.append([(clock.beat(t / 1000), clock.advances(t / 1000, *RESTS)) for t in (0, 33, 67, 250, 283)])
    assert told[0] == told[1]
    assert told[0][0][0] is Beat.START


@pytest.mark.parametrize(
    ("name", "bad"),
    [("period_ms", 4.9), ("period_ms", math.nan), ("change_exponent", 1.1), ("max_gap_ms", 50), ("repeats", 1),
     ("repeat_hold_ms", -1.0), ("repeat_mean_grey", 5.1), ("repeat_max_grey", math.inf)],
)  # fmt: skip
def test_rejects(name, bad):
    with pytest.raises(ParameterError, match=rf"ClockParams\.{name} = "):
        ClockParams(**{name: bad})
