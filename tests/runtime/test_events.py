"""Events by hand: what starts and ends when, at 10 frames a second so that the times can be read."""

from __future__ import annotations

from lobula.runtime.events import EventLog, collisions_of

from .readings import reading, trace


def feed(log, index, **how):
    return log.step(index, reading(index / 10, **how))


def test_a_collision_starts_at_once_and_ends_half_a_second_late():
    log = EventLog()
    assert feed(log, 0) == []
    (start,) = feed(log, 1, collision=True, lgmd1=0.9, lgmd2=0.8)
    assert start == {"type": "collision", "phase": "start", "id": 1, "frame": 1, "time_s": 0.1,
                     "lgmd1": 0.9, "lgmd2": 0.8, "lptc_r": 0.0, "lptc_l": 0.0}  # fmt: skip
    assert feed(log, 2, collision=True) == []
    for index in range(3, 9):  # it ended at 0.3 s; until 0.8 s it may start again
        assert feed(log, index) == []
    (end,) = feed(log, 9)
    assert end == {"type": "collision", "phase": "end", "id": 1, "frame": 3, "time_s": 0.3, "peak_frame": 1}


def test_a_restart_within_half_a_second_is_the_same_event():
    log = EventLog()
    feed(log, 0, collision=True)
    feed(log, 1)
    assert feed(log, 6, collision=True) == []  # 0.5 s after the end at 0.1 s: just within
    assert feed(log, 7) == []
    assert [r["frame"] for r in log.finish()] == [7]
    assert log.count == 1


def test_a_later_restart_is_another_event():
    log = EventLog()
    feed(log, 0, collision=True)
    feed(log, 1)
    end, start = feed(log, 7, collision=True)
    assert (end["phase"], end["id"], end["frame"]) == ("end", 1, 1)
    assert (start["phase"], start["id"], start["frame"]) == ("start", 2, 7)


def test_rounded_stamps_do_not_part_an_event():
    log = EventLog()
    log.step(0, reading(2.1, collision=True))
    log.step(1, reading(2.2))
    assert log.step(2, reading(2.7, collision=True)) == []  # 2.7 - 2.2 is 0.5000000000000004


def test_the_peak_is_where_the_weaker_lgmd_is_strongest():
    log = EventLog()
    feed(log, 0, collision=True, lgmd1=0.9, lgmd2=0.6)
    feed(log, 1, collision=True, lgmd1=0.8, lgmd2=0.7)
    feed(log, 2, collision=True, lgmd1=0.7, lgmd2=0.95)  # as strong as frame 1, so the first of them
    feed(log, 3, lgmd1=0.99, lgmd2=0.99)  # no alarm: not part of it
    (end,) = log.finish()
    assert end["peak_frame"] == 1


def test_an_alarm_that_lasts_to_the_end_is_ended_by_the_last_frame():
    log = EventLog()
    feed(log, 4, collision=True)
    feed(log, 5, collision=True)
    (end,) = log.finish()
    assert (end["frame"], end["time_s"]) == (5, 0.5)
    assert log.finish() == []


def test_time_that_passes_without_frames_ends_it_too():
    log = EventLog()
    feed(log, 0, collision=True)
    feed(log, 1)
    assert log.elapse(0.6) == []
    assert [r["phase"] for r in log.elapse(0.7)] == ["end"]


def test_states_start_and_end_and_ok_is_none():
    log = EventLog()
    states = ["warming_up", "warming_up", "ok", "flash", "turning", "turning"]
    records = [r for i, state in enumerate(states) for r in feed(log, i, state=state)] + log.finish()
    assert [(r["state"], r["phase"], r["frame"]) for r in records] == [
        ("warming_up", "start", 0), ("warming_up", "end", 2), ("flash", "start", 3), ("flash", "end", 4),
        ("turning", "start", 4), ("turning", "end", 5),
    ]  # fmt: skip
    assert {"type", "state", "phase", "frame", "time_s"} == set(records[0])


def test_no_frames_no_records():
    assert EventLog().finish() == []


def test_a_whole_trace():
    # 30 Hz: alarms in frames 10..12 and 20..21 are one event (8 frames apart), 60 is another (38 frames)
    events = collisions_of(trace({10, 11, 12, 20, 21, 60}, 90))
    assert [(e.id, e.start_frame, e.end_frame) for e in events] == [(1, 10, 22), (2, 60, 61)]


def test_a_loss_ends_what_is_under_way_and_is_stale_until_a_frame_comes():
    log = EventLog()
    feed(log, 0, collision=True)
    end, stale = log.lose(0, 0.4)
    assert (end["phase"], end["frame"], end["time_s"]) == ("end", 0, 0.4)
    assert (stale["state"], stale["phase"], stale["time_s"]) == ("stale", "start", 0.4)
    assert log.lose(0, 0.5) == []
    (over,) = feed(log, 9)
    assert (over["state"], over["phase"], over["frame"]) == ("stale", "end", 9)


def test_an_alarm_that_was_over_before_the_loss_ends_where_it_did():
    log = EventLog()
    feed(log, 0, collision=True)
    feed(log, 1)
    end, _ = log.lose(1, 0.2)
    assert (end["frame"], end["time_s"]) == (1, 0.1)


def test_no_state_ends_before_it_started():
    log = EventLog()
    feed(log, 0)
    log.lose(0, 3.0)  # by the clock here
    (over,) = feed(log, 1)  # a frame that was under way all the time
    assert over["time_s"] == 3.0
