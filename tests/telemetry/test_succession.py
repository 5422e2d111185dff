"""Gaps, restarts, wraps: expected values by hand."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.telemetry import RobotReading, Succession
from lobula.types import Spikes


def told(sequence: int, frame: int, time_ms: int) -> RobotReading:
    return RobotReading(
        sequence % 2**16, frame % 2**32, time_ms % 2**32, (0.5, 0.5, 0.0, 0.0), Spikes(), False, "ok"
    )  # fmt: skip


def test_numbers_and_times_count_from_the_first_that_is_heard():
    succession = Succession()
    places = [succession.place(told(k, k, 33 * k)) for k in range(900, 903)]
    assert places == [(0, 0.0, False), (1, 0.033, False), (2, 0.066, False)]
    assert succession.lost == 0


def test_a_gap_is_lost_and_leaves_its_numbers_out():
    succession = Succession()
    succession.place(told(5, 50, 1000))
    assert succession.place(told(9, 54, 1132)) == (4, 0.132, False)
    assert succession.lost == 3


def test_a_robot_that_tells_of_every_second_picture_loses_nothing():
    succession = Succession()
    for k in range(5):
        place = succession.place(told(k, 2 * k, 66 * k))
    assert (place.number, succession.lost) == (8, 0)


def test_the_sequence_wraps():
    succession = Succession()
    succession.place(told(65534, 70000, 10))
    succession.place(told(65537, 70003, 110))
    assert succession.lost == 2


def test_the_clock_wraps_after_49_days():
    succession = Succession()
    succession.place(told(0, 10, 2**32 - 20))
    assert succession.place(told(1, 11, 2**32 + 13)) == (1, 0.033, False)


def test_a_restart_is_told_and_nothing_is_lost():
    succession = Succession()
    for k in range(100, 110):
        succession.place(told(k, k, 33 * k))
    number, stamp_s, restarted = succession.place(told(3, 3, 99))
    assert (number, restarted, succession.lost) == (10, True, 0)
    assert stamp_s == (99 - 3300) / 1000
    assert succession.place(told(4, 4, 132)).number == 11


def test_a_restart_that_only_the_clock_gives_away():
    succession = Succession()
    succession.place(told(0, 2, 90_000))
    assert succession.place(told(0, 5, 120)).restarted


def test_the_same_again_is_left_out():
    succession = Succession()
    succession.place(told(7, 7, 231))
    assert succession.place(told(7, 7, 231)) is None
    assert succession.place(told(8, 8, 264)) == (1, 0.033, False)
    assert succession.lost == 0


def test_what_was_missed_between_two_connections_is_not_counted():
    succession = Succession()
    succession.place(told(0, 0, 0))
    succession.connect()
    assert succession.place(told(300, 300, 10_000)) == (300, 10.0, False)
    succession.place(told(302, 302, 10_066))
    assert succession.lost == 1


def test_more_readings_than_pictures_cannot_be_lost():
    succession = Succession()
    succession.place(told(10, 10, 330))
    succession.place(told(9, 12, 396))  # 65534 readings of one picture
    assert succession.lost == 1


@settings(deadline=None)
@given(st.lists(st.tuples(st.integers(1, 500), st.integers(1, 10_000)), min_size=1, max_size=50))
def test_numbers_and_times_only_grow_without_a_restart(steps):
    succession, frame, time_ms = Succession(), 2**31, 2**32 - 5000
    last = succession.place(told(frame, frame, time_ms))
    for pictures, ms in steps:
        frame, time_ms = frame + pictures, time_ms + ms
        place = succession.place(told(frame, frame, time_ms))
        assert not place.restarted
        assert place.number == last.number + pictures
        assert abs(place.stamp_s - last.stamp_s - ms / 1000) < 1e-6
        last = place
    assert succession.lost == sum(pictures - 1 for pictures, _ in steps)
