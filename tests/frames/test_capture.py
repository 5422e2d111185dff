"""When a picture of a live source was captured: a driver's own stamps, or arrival; without a stamp it follows by it.

No camera is at hand: a driver's packets are stood in for by their stamps.
"""

from __future__ import annotations

import time
from types import SimpleNamespace

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError
from lobula.frames import clock as clocks
from lobula.frames.clock import Clock

from .clips import moving_bar
from .rtsp_camera import RtspCamera
from .web_camera import WebCamera

V4L2 = "video4linux2,v4l2"  # what FFmpeg calls the format


class Now:
    now = 0.0

    def monotonic(self):
        return self.now


@pytest.fixture
def now(monkeypatch):
    now = Now()
    monkeypatch.setattr(clocks, "time", now)
    return now


def data(stamp):
    return SimpleNamespace(pts=stamp, dts=stamp, is_discard=False)


def decoded(clock, stamp):
    """Give a packet to ``clock`` and take its picture."""
    clock.packet(data(stamp))
    moment = clock.read(data(stamp))
    clock.opened()
    return moment


def test_a_driver_that_keeps_our_clock_tells_the_capture(now):
    clock = Clock("camera 0", V4L2, 1e-6, None, True)
    now.now = 5000.02
    first = decoded(clock, 5_000_000_000)
    now.now = 5000.08
    second = decoded(clock, 5_000_033_000)
    assert first == (0.0, 0, 5000.02, pytest.approx(5000.0))
    assert second == (pytest.approx(0.033), 1, 5000.08, pytest.approx(5000.033))


@pytest.mark.parametrize("stamp_s", [1_700_000_000.0, 4900.0, 5000.5])  # wall clock; long ago; in the future
def test_a_driver_that_keeps_another_clock_does_not(now, stamp_s):
    now.now = 5000.0
    moment = decoded(Clock("camera 0", V4L2, 1e-6, None, True), round(stamp_s * 1e6))
    assert (moment.time_s, moment.captured_s) == (0.0, None)


def test_a_picture_arrived_with_its_packet_not_with_the_last_one_that_went_in(now):
    clock = Clock("rtsp", "rtsp", 1 / 90_000, None, True)
    for stamp, arrival_s in ((0, 1.0), (3000, 1.1), (6000, 1.2)):  # a decoder that holds two pictures back
        now.now = arrival_s
        clock.packet(data(stamp))
    assert clock.read(data(0)).arrived_s == 1.0
    assert clock.read(data(3000)).arrived_s == 1.1


def test_a_first_picture_without_a_stamp_is_where_time_begins(now):
    clock = Clock("rtsp", "rtsp", 1 / 90_000, None, True)
    now.now = 7.0
    assert decoded(clock, None).time_s == 0.0
    now.now = 7.04
    assert decoded(clock, 93_600).time_s == pytest.approx(0.04)
    assert decoded(clock, 97_200).time_s == pytest.approx(0.08)  # by its stamp, 40 ms later, whenever it came


def test_a_recording_must_have_stamps():
    with pytest.raises(FrameSourceError, match="frame 0: no time stamp: must have one"):
        decoded(Clock("clip.mkv", "matroska,webm", 1e-3, None, False), None)


def test_packets_that_no_picture_comes_of_are_forgotten(now):
    clock = Clock("rtsp", "rtsp", 1 / 90_000, None, True)
    for stamp in range(10_000):
        clock.packet(data(stamp))
    assert len(clock._arrivals) <= 64


@pytest.mark.parametrize("kind", [WebCamera, RtspCamera])
def test_frames_of_a_stream_say_when_they_were_captured(kind):
    bars, begun_s = moving_bar(40), time.monotonic()
    with kind(lambda n: bars[n % 40]) as camera, lobula.frames.open(camera.address, timeout_s=5) as frames:
        got = [next(frames) for _ in range(4)]
    captured_s = [f.captured_s for f in got]
    assert begun_s < captured_s[0] < captured_s[1] < captured_s[2] < captured_s[3] < time.monotonic()


def test_frames_of_a_recording_do_not():
    with lobula.frames.open(np.stack(moving_bar(3))) as frames:
        assert next(frames).captured_s is None
