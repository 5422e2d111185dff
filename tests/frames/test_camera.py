"""Cameras of this machine: what can be told without one."""

from __future__ import annotations

import sys

import av
import pytest

import lobula.frames
from lobula.errors import FrameSourceError, ParameterError
from lobula.frames import camera
from lobula.frames.inputs import InputOptions

linux_only = pytest.mark.skipif(sys.platform != "linux", reason="names the devices of Linux")


@linux_only
def test_no_such_camera():
    with pytest.raises(FrameSourceError, match=r"camera 97 \(/dev/video97\): No such file or directory: must") as e:
        lobula.frames.open(97)
    assert "\n" not in str(e.value)


@linux_only
def test_camera_that_may_not_be_used(monkeypatch):
    def refuse(*_, **__):
        raise av.error.PermissionError(13, "Permission denied", "/dev/video0")

    monkeypatch.setattr(av, "open", refuse)
    with pytest.raises(FrameSourceError, match=r"camera 0 \(/dev/video0\): Permission denied: must be a camera this"):
        lobula.frames.open("0")


@linux_only
def test_requests_reach_the_driver(monkeypatch):
    asked = {}

    def opened(url, mode, **how):
        asked.update(how, url=url, mode=mode)
        raise av.error.InvalidDataError(1, "stop here")

    monkeypatch.setattr(av, "open", opened)
    how = InputOptions(input_size=(640, 480), rate_hz=60.0, pixel_format="mjpeg", timeout_s=3)
    with pytest.raises(FrameSourceError):
        camera.open_camera(2, how)
    assert (asked["url"], asked["format"], asked["timeout"]) == ("/dev/video2", "v4l2", (3, 3))
    assert asked["options"] == {"video_size": "640x480", "framerate": "60", "input_format": "mjpeg"}


def test_other_systems_are_named(monkeypatch):
    monkeypatch.setattr(sys, "platform", "plan9")
    with pytest.raises(FrameSourceError, match="camera 0: cameras are read on Linux and macOS, not on plan9"):
        lobula.frames.open(0)


def test_times_are_not_for_cameras():
    with pytest.raises(ParameterError, match="times_s: 0 is a camera"):
        lobula.frames.open(0, times_s=[0.0])
