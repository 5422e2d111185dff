"""A live source that goes away: opened again, with waits, news and one run of time; or given up in one line."""

from __future__ import annotations

import math
from contextlib import contextmanager

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError, ParameterError
from lobula.frames import FrameStream, reconnect
from lobula.frames.geometry import View
from lobula.frames.reconnect import Reconnecting
from lobula.frames.selection import Picture, Selection

from .clips import as_frame
from .scripted_camera import ScriptedCamera, picture, wait_until

GONE = FrameSourceError("camera: unplugged", on_the_way=True)
REFUSED = FrameSourceError("camera: no such device")


class Socket:
    """Where cameras are plugged in: hands out, or raises, what the test lined up, one at a time."""

    def __init__(self, *things):
        self.things, self.tries = list(things), 0

    def __call__(self):
        self.tries += 1
        thing = self.things.pop(0) if len(self.things) > 1 else self.things[0]
        if isinstance(thing, Exception):
            raise thing
        return thing


@contextmanager
def stream(socket, patience_s=math.inf, view=None, **options):
    camera = ScriptedCamera()
    with FrameStream(camera, view or View(), Selection(), None, 10, socket, patience_s, **options) as frames:
        try:
            yield camera, frames
        finally:
            for each in (camera, *(t for t in socket.things if isinstance(t, ScriptedCamera))):
                each.give(None)
                each.close()


@pytest.fixture(autouse=True)
def no_long_waits(monkeypatch):
    monkeypatch.setattr(reconnect, "FIRST_WAIT_S", 0.001)
    monkeypatch.setattr(reconnect, "LONGEST_WAIT_S", 0.002)


def polled(frames):
    """The next frame, and the news up to it."""
    news = []
    for _ in range(1000):
        frame = frames.poll(0.02)
        news += frames.news()
        if frame is not None:
            return frame, news
    raise AssertionError("no frame")


def test_it_comes_back_numbered_on_and_later():
    second = ScriptedCamera()
    with stream(Socket(REFUSED, REFUSED, second)) as (camera, frames):
        camera.give(picture(0), picture(7), GONE)
        wait_until(lambda: frames._newest is not None and frames._newest.index == 7)
        before, news = polled(frames)
        assert (before.index, frames.breaks, news) == (7, 0, [])
        second.give(picture(0), picture(1))
        wait_until(lambda: frames._newest is not None and frames._newest.index == 9)
        after, news = polled(frames)
    assert after.index == 9  # 0 to 7 were eight
    assert after.time_s > before.time_s
    assert frames.breaks == 1
    assert [n.phase for n in news] == ["lost", "retry", "retry", "back"]
    assert news[0].facts == {"reason": "camera: unplugged"}
    assert news[1].facts == {"attempt": 1, "reason": "camera: no such device"}
    assert news[3].facts["attempt"] == 3
    assert news[3].facts["away_s"] >= 0
    assert camera.closed.is_set()


def test_news_come_with_the_frames_they_stand_between():
    second = ScriptedCamera()
    with stream(Socket(second)) as (camera, frames):
        camera.give(picture(3), GONE)
        wait_until(lambda: len(frames._link._news) == 2)  # lost and back, while frame 3 still waits to be taken
        frame = frames.poll(1)
        assert (frame.index, frames.news()) == (3, [])
        second.give(picture(0))
        frame, news = polled(frames)
        assert frame.index == 4
        assert [n.phase for n in news] == ["lost", "back"]


def test_a_stream_that_ends_is_lost_too():
    second = ScriptedCamera()
    with stream(Socket(second)) as (camera, frames):
        camera.give(picture(0), None)
        polled(frames)
        second.give(picture(0))
        _, news = polled(frames)
        assert news[0].facts["reason"] == "camera: the stream ended"


class Patient:
    """Stands in for the event that asks for an end and for the clock: a wait takes no time and is noted."""

    def __init__(self, most):
        self.most, self.waits, self.now = most, [], 0.0

    def is_set(self):
        return len(self.waits) > self.most

    def wait(self, seconds):
        self.waits.append(seconds)
        self.now += seconds
        return self.is_set()

    def monotonic(self):
        return self.now


def link_to(first, socket, patience_s, monkeypatch, most=99):
    patient = Patient(most)
    monkeypatch.setattr(reconnect, "FIRST_WAIT_S", 0.25)
    monkeypatch.setattr(reconnect, "LONGEST_WAIT_S", 10.0)
    monkeypatch.setattr(reconnect, "time", patient)
    link = Reconnecting(first, socket, patience_s)
    link._stopping = patient
    return link, patient


def given(*items):
    camera = ScriptedCamera()
    camera.give(*items)
    return camera


def test_waits_double_up_to_the_longest_and_begin_anew_after_a_connection_that_held(monkeypatch):
    socket = Socket(*[REFUSED] * 7, given(picture(0), None), REFUSED)
    link, patient = link_to(given(None), socket, math.inf, monkeypatch, most=11)
    pictures = link.pictures()
    assert next(pictures).connection == 2
    assert patient.waits == [0.25, 0.5, 1, 2, 4, 8, 10, 10]
    patient.now += 60.0
    assert list(pictures) == []
    assert patient.waits[8:] == [0.25, 0.5, 1, 2]


def test_a_connection_that_breaks_at_once_does_not_shorten_the_waits(monkeypatch):
    socket = Socket(*(given(picture(0), None) for _ in range(5)), REFUSED)
    link, patient = link_to(given(None), socket, math.inf, monkeypatch, most=5)
    assert len(list(link.pictures())) == 5
    assert patient.waits == [0.25, 0.5, 1, 2, 4, 8]


def test_given_up_in_one_line_when_patience_ends(monkeypatch):
    link, patient = link_to(given(GONE), Socket(REFUSED), 2.0, monkeypatch)
    with pytest.raises(FrameSourceError, match=r"^camera: no such device; given up after 2.0 s, tries: 4$") as caught:
        list(link.pictures())
    assert caught.value.on_the_way
    assert patient.waits == [0.25, 0.5, 1, 0.25]  # the last try is at the end of the two seconds


def test_without_patience_the_loss_is_final():
    socket = Socket(ScriptedCamera())
    with stream(socket, patience_s=0.0) as (camera, frames):
        camera.give(picture(0), GONE)
        wait_until(camera.closed.is_set)
        frames.poll(1)
        with pytest.raises(FrameSourceError, match=r"^camera: unplugged$"):
            frames.poll(1)
        assert (socket.tries, frames.news()) == (0, [])


def test_a_fault_of_ours_is_not_tried_again():
    socket = Socket(ZeroDivisionError("bug"))
    with stream(socket) as (camera, frames):
        camera.give(GONE)
        with pytest.raises(ZeroDivisionError):
            polled(frames)
        assert socket.tries == 1


def test_closing_ends_the_tries(monkeypatch):
    monkeypatch.setattr(reconnect, "FIRST_WAIT_S", 3600.0)
    with stream(Socket(REFUSED)) as (camera, frames):
        camera.give(GONE)
        wait_until(lambda: frames.away)
        frames.close()
        assert not frames._thread.is_alive()
        assert frames.ended


def test_iteration_waits_while_it_is_away():
    second = ScriptedCamera()
    with stream(Socket(*[REFUSED] * 20, second)) as (camera, frames):
        frames._timeout_s = 0.02  # shorter than twenty tries
        camera.give(picture(0))
        assert next(frames).index == 0
        camera.give(GONE)
        second.give(picture(0))
        wait_until(lambda: frames.away or frames._newest is not None)
        assert next(frames).index == 1


def test_what_was_damaged_and_noted_adds_up():
    first, second = ScriptedCamera(), ScriptedCamera()
    first.damaged, first.notes = 2, ["odd", "one"]
    second.damaged, second.notes = 3, ["odd", "two"]
    first.give(None)
    second.give(picture(0))
    link = Reconnecting(first, Socket(second), math.inf)
    next(link.pictures())
    assert (link.damaged, link.notes) == (5, ["odd", "one", "two"])


def grey(height, width, index):
    return Picture(np.full((height, width), index, np.uint8), index / 30, index)


def test_pictures_of_another_size_begin_anew():
    with stream(Socket(ScriptedCamera())) as (camera, frames):
        camera.give(picture(0))
        polled(frames)
        assert (frames.source_width, frames.source_height) == (99, 72)
        camera.give(grey(144, 198, 1))
        frame, news = polled(frames)
        assert (frames.source_width, frames.source_height, frames.breaks) == (198, 144, 1)
        assert [(n.phase, n.facts) for n in news] == [("resized", {"width": 198, "height": 144})]
        np.testing.assert_array_equal(frame.image, np.full((72, 99), 1))
        assert frames.picture().shape == (144, 198, 3)


def test_pictures_of_another_format_and_range_are_the_same_pictures():
    """As a camera gives them that was plugged in again and now sends JPEGs."""
    flat = np.full((72, 99), 126, np.uint8)
    limited = as_frame(flat, "yuv422p")  # 126 in 16 to 235 is 128.08 in 0 to 255
    with stream(Socket(ScriptedCamera())) as (camera, frames):
        camera.give(picture(0))
        polled(frames)
        for number, (data, grey) in enumerate([(limited, 128.08), (as_frame(flat, "yuvj420p"), 126)], 1):
            camera.give(Picture(data, number / 30, number))
            frame, news = polled(frames)
            assert (news, frames.breaks) == ([], 0)
            np.testing.assert_allclose(frame.image, grey, atol=0.01)


def test_a_region_that_has_no_place_in_them_is_refused_in_one_line():
    with stream(Socket(ScriptedCamera()), view=View(roi=(0, 0, 99, 72))) as (camera, frames):
        camera.give(picture(0))
        polled(frames)
        camera.give(grey(60, 80, 1))
        with pytest.raises(
            ParameterError, match=r"roi = \(0, 0, 99, 72\): .* inside the 80 x 60 px of camera"
        ) as caught:
            polled(frames)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize("patience", [-1, math.nan, "1", True])
def test_patience_that_is_none(patience):
    with pytest.raises(ParameterError, match=r"reconnect_s = .*: must be a number of seconds of 0 or more"):
        lobula.frames.open(np.zeros((2, 72, 99), np.uint8), reconnect_s=patience)
