"""Streams over loopback that stop, fall silent, come back and change: what a consumer sees of it."""

from __future__ import annotations

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError, ParameterError
from lobula.frames import reconnect

from .clips import moving_bar
from .rtsp_camera import RtspCamera
from .web_camera import WebCamera

BARS = moving_bar(40, 128, 96)
KINDS = pytest.mark.parametrize("kind", [WebCamera, RtspCamera])


@pytest.fixture(autouse=True)
def short_waits(monkeypatch):
    monkeypatch.setattr(reconnect, "FIRST_WAIT_S", 0.05)


def bars(number):
    return BARS[number % 40]


def until(frames, holds):
    """Poll until ``holds(frame, news)``; return that frame and all news."""
    news = []
    for _ in range(3000):
        frame = frames.poll(0.02)
        news += frames.news()
        if holds(frame, news):
            return frame, news
    raise AssertionError([n.phase for n in news])


def phases(news):
    return [n.phase for n in news if n.phase != "retry"]


@KINDS
def test_cut_off_and_back(kind):
    with kind(bars) as camera, lobula.frames.open(camera.address, timeout_s=5, reconnect_s=60) as frames:
        before, _ = until(frames, lambda f, _: f is not None)
        camera.unplug()
        until(frames, lambda _, n: "retry" in [x.phase for x in n])
        assert frames.away
        camera.mode = "run"
        after, news = until(frames, lambda f, _: f is not None)
        assert phases(news) == ["back"]
        assert after.index > before.index
        assert after.time_s > before.time_s
        assert frames.breaks == 1


@KINDS
def test_silence_is_a_loss_after_the_timeout(kind):
    with kind(bars) as camera, lobula.frames.open(camera.address, timeout_s=0.4, reconnect_s=60) as frames:
        until(frames, lambda f, _: f is not None)
        camera.mode = "silent"
        _, news = until(frames, lambda _, n: "lost" in [x.phase for x in n])
        assert "nothing came in time" in news[0].facts["reason"]
        camera.mode = "run"
        until(frames, lambda f, n: f is not None and "back" in [x.phase for x in n])


@KINDS
def test_back_with_pictures_of_another_size(kind):
    size = {"now": BARS}
    with (
        kind(lambda n: size["now"][n % 40]) as camera,
        lobula.frames.open(camera.address, timeout_s=5, reconnect_s=60) as frames,
    ):
        until(frames, lambda f, _: f is not None)
        camera.unplug()
        size["now"] = moving_bar(40, 192, 144)
        camera.mode = "run"
        frame, news = until(frames, lambda f, n: f is not None and "back" in [x.phase for x in n])
        if "resized" not in phases(news):  # a last frame of the first connection can still have been waiting
            frame, news = until(frames, lambda _, n: "resized" in [x.phase for x in n])
        assert frame.image.shape == (72, 99)
        assert frames.picture().shape == (144, 192, 3)


def test_another_size_in_the_middle_of_a_stream():
    def image(number):
        return moving_bar(1, 96, 64)[0] if number < 5 else moving_bar(1, 128, 96)[0]

    with WebCamera(image) as camera, lobula.frames.open(camera.address, timeout_s=5) as frames:
        _, news = until(frames, lambda _, n: n)
        assert news[0].facts == {"width": 128, "height": 96}
        assert frames.breaks == 1


def test_another_size_that_the_region_does_not_fit_is_refused_in_one_line():
    size = {"now": BARS}
    with (
        WebCamera(lambda n: size["now"][n % 40]) as camera,
        lobula.frames.open(camera.address, timeout_s=5, reconnect_s=60, roi=(20, 10, 100, 80)) as frames,
    ):
        until(frames, lambda f, _: f is not None)
        camera.unplug()
        size["now"] = moving_bar(40, 96, 64)
        camera.mode = "run"
        with pytest.raises(ParameterError, match=r"roi = .*: must be .* inside the 96 x 64 px of http") as caught:
            until(frames, lambda *_: False)
        assert "\n" not in str(caught.value)


def test_a_stream_that_always_ends_at_once_is_tried_with_waits_and_never_hangs():
    with WebCamera(bars) as camera:
        camera.mode = "end"
        with lobula.frames.open(camera.address, timeout_s=5, reconnect_s=60) as frames:
            _, news = until(frames, lambda _, n: len(n) >= 6)
            assert phases(news)[:6] == ["lost", "back"] * 3
            assert frames._link._wait_s >= 4 * reconnect.FIRST_WAIT_S


def test_given_up_in_one_line():
    with WebCamera(bars) as camera, lobula.frames.open(camera.address, timeout_s=5, reconnect_s=0.3) as frames:
        until(frames, lambda f, _: f is not None)
        camera.unplug()
        with pytest.raises(FrameSourceError, match=r"^http.*Server returned 5XX.*; given up after \S+ s, tries: \d+$"):
            until(frames, lambda *_: False)


def test_pictures_are_those_of_the_camera():
    with RtspCamera(lambda n: np.full((96, 128), 40 + 8 * (n % 20), np.uint8)) as camera:
        with lobula.frames.open(camera.address, timeout_s=5) as frames:
            frame, _ = until(frames, lambda f, _: f is not None)
        grey = 16 + float(frame.image.mean()) * 219 / 255  # the stream's luma runs from 16 to 235
        assert min(abs(grey - (40 + 8 * k)) for k in range(20)) < 1.5
        assert float(frame.image.std()) < 1
