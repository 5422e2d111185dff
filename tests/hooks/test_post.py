"""Whatever a hook does, the run goes on, nothing grows without bound, and every message is accounted for."""

from __future__ import annotations

import socket
import threading

import numpy as np
import pytest

from lobula.errors import OutputError
from lobula.hooks import Hook, RefusedError

from .office import SUMMARY, Hanging, Scripted, delivered, event, opened, reading, wait_until

GONE = ConnectionResetError("gone")


@pytest.fixture
def hanging():
    hook = Hanging()
    yield hook
    hook.go.set()


def test_everything_arrives_in_order_and_is_counted():
    hook = Scripted()
    office = opened(hook)
    for number in range(50):
        office.frame(number, reading(number / 30), None)
        office.event(event(number))
    office.close(SUMMARY)
    kinds = [m.kind for m in hook.got]
    assert kinds[-1] == "summary"
    assert [m.record["frame"] for m in hook.got if m.kind == "event"] == list(range(50))
    # 5 readings a second of 30: every sixth frame
    assert [m.record["frame"] for m in hook.got if m.kind == "reading"] == list(range(0, 50, 6))
    assert kinds.index("reading") < kinds.index("event")
    assert office.tallies() == [{"hook": "scripted", "sent": 50 + 9 + 1, "dropped": 0, "failures": 0}]
    assert office.news() == []
    assert (hook.calls[0], hook.calls[-1]) == ("connect", "disconnect")


def test_ten_thousand_events_into_a_hook_that_hangs(hanging):
    office = opened(hanging, close_s=0.05)
    office.event(event(-1))
    assert hanging.inside.wait(30)
    for number in range(10_000):  # not one of these calls can have waited: the hook never came back
        office.event(event(number))
        office.frame(number, reading(number / 5), None)
    (post,) = office._posts
    assert len(post._mailbox) == hanging.events_kept + hanging.readings_kept
    assert [r["phase"] for r in office.news()] == ["start"]
    office.close(SUMMARY)
    assert hanging.aborted
    assert hanging.got == []
    (tally,) = office.tallies()
    assert (tally["sent"], tally["dropped"]) == (0, 20_002)


def test_ten_thousand_events_into_a_hook_that_is_dead():
    hook = Scripted()
    hook.connect = lambda header: (_ for _ in ()).throw(ConnectionRefusedError(111, "Connection refused"))
    office = opened(hook)
    for number in range(10_000):
        office.event(event(number))
    office.close(SUMMARY)
    (tally,) = office.tallies()
    assert (tally["sent"], tally["dropped"]) == (0, 10_001)
    assert tally["failures"] >= 1
    assert tally["problem"] == "Connection refused"  # the cause, not what follows from it
    assert len(office.news()) == 1


def test_the_newest_are_kept_and_readings_never_push_out_an_event(hanging):
    office = opened(hanging)
    office.event(event(-1))
    assert hanging.inside.wait(30)
    for number in range(hanging.events_kept):
        office.event(event(number))
    for number in range(5 * hanging.readings_kept):
        office.frame(number, reading(float(number)), None)
    hanging.go.set()
    office.close(SUMMARY)
    events = [m.record["frame"] for m in hanging.got if m.kind == "event"]
    assert events == [-1, *range(1, 1000)]  # the summary took the room of number 0
    frames = [m.record["frame"] for m in hanging.got if m.kind == "reading"]
    assert frames == list(range(400, 500))
    assert office.tallies()[0]["dropped"] == 1 + 400


def test_a_lost_link_is_made_anew_and_the_message_sent_again():
    hook = Scripted(plan=[None, GONE, GONE, None])
    office = opened(hook)
    for number in range(3):
        office.event(event(number))
    wait_until(lambda: len(hook.got) == 3)
    office.close(SUMMARY)
    assert hook.frames == [0, 1, 2, None]
    calls = [
        "connect",
        "send",
        "send",
        "disconnect",
        "connect",
        "send",
        "disconnect",
        "connect",
        "send",
        "send",
        "send",
    ]
    assert hook.calls == [*calls, "disconnect"]
    start, end = office.news()
    assert start == {"type": "hook", "hook": "scripted", "phase": "start", "problem": "gone"}
    assert end == {"type": "hook", "hook": "scripted", "phase": "end", "failures": 2, "dropped": 0}
    assert office.tallies()[0] == {"hook": "scripted", "sent": 4, "dropped": 0, "failures": 2, "problem": "gone"}


def test_a_link_that_broke_unseen_is_made_anew_at_the_end_but_a_dead_peer_is_not_waited_for():
    hook = Scripted(plan=[None, GONE])
    office = opened(hook)
    office.event(event(0))
    wait_until(lambda: hook.got)
    office.close(SUMMARY)
    assert hook.frames == [0, None]
    dead = Scripted(plan=[None, *[GONE] * 99])
    office = opened(dead)
    office.event(event(0))
    wait_until(lambda: dead.got)
    office.close(SUMMARY)
    assert dead.calls.count("send") == 3
    assert office.tallies()[0]["dropped"] == 1


def test_a_peer_that_is_not_there_yet_gets_everything_once_it_is():
    hook = Scripted(connects=[GONE] * 5)
    office = opened(hook)
    office.event(event(7))
    wait_until(lambda: hook.got)
    office.close(SUMMARY)
    assert hook.frames == [7, None]
    assert office.tallies()[0]["failures"] == 5


def test_a_message_that_is_refused_is_not_sent_again_and_the_link_stays():
    hook = Scripted(plan=[RefusedError("no such topic"), None])
    tally = delivered(hook, event(0), event(1))
    assert hook.frames == [1, None]
    assert hook.calls.count("connect") == 1
    assert tally == {"hook": "scripted", "sent": 2, "dropped": 1, "failures": 1, "problem": "no such topic"}


def test_a_fault_of_a_hook_costs_one_message():
    hook = Scripted(plan=[ZeroDivisionError("by\nzero"), None])
    tally = delivered(hook, event(0), event(1))
    assert hook.frames == [1, None]
    assert hook.calls.count("connect") == 2
    assert (tally["dropped"], tally["problem"]) == (1, "ZeroDivisionError: by")


def test_a_fault_in_connect_and_disconnect_is_only_a_failure():
    hook = Scripted(connects=[ValueError("odd")])
    hook.disconnect = lambda: 1 / 0
    tally = delivered(hook, event(0))
    assert (tally["sent"], tally["failures"], tally["problem"]) == (2, 1, "ValueError: odd")


def test_trouble_is_told_once_however_often_it_fails():
    hook = Scripted(plan=[RefusedError("no")] * 100)
    office = opened(hook)
    for number in range(100):
        office.event(event(number))
    office.close(SUMMARY)
    assert [r["phase"] for r in office.news()] == ["start", "end"]
    assert office.tallies()[0]["failures"] == 100


def test_a_hook_that_wants_no_readings_gets_none():
    class EventsOnly(Scripted):
        kinds = frozenset({"event"})

    hook = EventsOnly()
    delivered(hook, event(0), readings=[reading(0.0), reading(1.0)])
    assert [m.kind for m in hook.got] == ["event"]


@pytest.mark.parametrize(("hz", "frames"), [(0, []), (10, list(range(0, 30, 3))), (float("inf"), list(range(30)))])
def test_the_rate_of_readings_is_counted_in_the_time_of_the_frames(hz, frames):
    hook = Scripted()
    office = opened(hook, readings_hz=hz)
    for number in range(30):
        office.frame(number, reading(number / 30), None)
    office.close(SUMMARY)
    assert hook.frames[:-1] == frames


def test_a_picture_is_a_copy_and_comes_at_its_own_rate():
    class WithPictures(Scripted):
        readings_hz, pictures_hz = float("inf"), 10.0

    hook, shown = WithPictures(), np.zeros((4, 4, 3), np.uint8)
    office = opened(hook)

    def picture():
        return shown

    for number in range(6):
        shown[:] = number
        office.frame(number, reading(number / 30), picture)
    office.close(SUMMARY)
    got = [None if m.picture is None else int(m.picture.max()) for m in hook.got[:-1]]
    assert got == [0, None, None, 3, None, None]


def test_pictures_that_cannot_be_made_are_told_once_and_stop_neither_run_nor_hook():
    class WithPictures(Scripted):
        readings_hz = pictures_hz = float("inf")

    def picture():
        raise ValueError("no way from bayer to rgb24")

    hook = WithPictures()
    office = opened(hook)
    for number in range(5):
        office.frame(number, reading(number / 30), picture)
    office.close(SUMMARY)
    assert hook.frames == [0, 1, 2, 3, 4, None]
    tally = office.tallies()[0]
    assert (tally["sent"], tally["failures"]) == (6, 1)
    assert tally["problem"] == "no pictures: ValueError('no way from bayer to rgb24')"


@pytest.mark.parametrize(("width", "kept"), [(640, 640), (1279, 1279), (1920, 640), (3840, 640)])
def test_a_wide_picture_is_thinned_out_before_it_waits(width, kept):
    """Forty of them may wait: of a 4K camera they would be a gigabyte."""

    class WithPictures(Scripted):
        pictures_hz = 10.0

    hook, shown = WithPictures(), np.zeros((width // 2, width, 3), np.uint8)
    shown[:] = np.arange(width, dtype=np.uint32)[:, None] * 255 // width
    office = opened(hook)
    office.frame(0, reading(0.0), lambda: shown)
    office.close(SUMMARY)
    picture = hook.got[0].picture
    assert picture.shape[1] == kept
    assert picture.nbytes <= 3 * kept * kept
    np.testing.assert_array_equal(picture, shown[:: width // kept, :: width // kept])


def test_a_request_that_is_refused_reaches_nobody():
    hook = Scripted()
    office = opened(hook)
    office.close({"type": "summary", "status": "refused", "frames": 0})
    assert hook.calls == ["disconnect"]  # for what its check may have opened
    assert office.tallies() == [{"hook": "scripted", "sent": 0, "dropped": 0, "failures": 0}]


def test_a_hook_that_can_never_work_says_so_when_it_is_opened():
    class Impossible(Hook):
        def check(self):
            raise OutputError("cannot write /there")

    with pytest.raises(OutputError, match="cannot write /there"):
        opened(Impossible("impossible"))


def test_hooks_do_not_wait_for_each_other(hanging):
    hook = Scripted()
    office = opened(hanging, hook, close_s=0.05)
    office.event(event(0))
    assert hanging.inside.wait(30)
    wait_until(lambda: hook.got)
    office.close(SUMMARY)
    assert [t["sent"] for t in office.tallies()] == [0, 2]


def test_what_arrives_after_the_end_is_not_counted_twice(hanging):
    office = opened(hanging, close_s=0.01)
    office.event(event(0))
    assert hanging.inside.wait(30)
    office.close(SUMMARY)
    hanging.go.set()
    wait_until(lambda: not [t for t in threading.enumerate() if t.name == "lobula hook hanging"])
    (tally,) = office.tallies()
    assert (tally["sent"], tally["dropped"]) == (0, 2)


def test_every_message_is_stamped_by_the_clock(monkeypatch):
    monkeypatch.setattr("time.time", lambda: 1_790_000_000.1239)
    hook = Scripted()
    delivered(hook, event(0), readings=[reading(0.0)])
    assert {m.record["unix_s"] for m in hook.got} == {1_790_000_000.124}


def test_a_reading_has_the_columns_of_a_trace():
    hook = Scripted()
    delivered(hook, readings=[reading(0.1234567891, np.float32(0.5))])
    record = dict(hook.got[0].record)
    del record["unix_s"]
    assert record == {
        "type": "reading", "frame": 0, "time_s": 0.123457, "lgmd1": 0.5, "lgmd2": 0.6, "lptc_r": 0.25, "lptc_l": -0.125,
        "spikes_lgmd1": 1, "spikes_lgmd2": 2, "spikes_lptc_r": 3, "spikes_lptc_l": 4, "collision": False, "state": "ok",
    }  # fmt: skip
    assert {type(v) for v in record.values()} == {str, int, float, bool}


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (OSError(28, "No space left on device"), "No space left on device"),
        (TimeoutError("timed out"), "timed out"),
        (TimeoutError("_ssl.c:989: The handshake operation timed out"), "The handshake operation timed out"),
        (socket.gaierror(-2, "Name or service not known"), "Name or service not known"),
        (OSError(), "OSError"),
    ],
)
def test_the_reason_of_a_failure_in_a_few_words(error, says):
    assert delivered(Scripted(plan=[error]), event(0))["problem"] == says
