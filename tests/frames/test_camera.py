"""Cameras, with a stand-in for the driver: no test here had a real V4L2 camera."""

from __future__ import annotations

import errno
import os
import sys

import av
import pytest

import lobula.frames
from lobula.errors import FrameSourceError, ParameterError
from lobula.frames import camera, reconnect
from lobula.frames.inputs import InputOptions

from .clips import moving_bar, write_clip

linux_only = pytest.mark.skipif(sys.platform != "linux", reason="names the devices of Linux")


class Device:
    """Stands in for the driver: each opening of a camera raises or opens what the test lined up, the last for ever."""

    def __init__(self, monkeypatch, *script):
        self.script, self.opened, self._open = list(script), 0, av.open
        monkeypatch.setattr(av, "open", self)

    def __call__(self, url, *mode, **how):
        if not str(url).startswith("/dev/"):
            return self._open(url, *mode, **how)
        self.opened += 1
        thing = self.script.pop(0) if len(self.script) > 1 else self.script[0]
        if isinstance(thing, OSError):
            raise thing
        return self._open(str(thing))


def trouble(number):
    return OSError(number, os.strerror(number), "/dev/video0")


@linux_only
def test_no_such_camera():
    says = r"camera 97 \(/dev/video97\): no camera there: must be a camera this user may use; found "
    with pytest.raises(FrameSourceError, match=says) as caught:
        lobula.frames.open(97)
    assert "\n" not in str(caught.value)


@linux_only
@pytest.mark.parametrize(
    ("error", "says"),
    [
        (
            av.error.PermissionError(13, "Permission denied"),
            "permission denied: this user must be in the group",
        ),
        (trouble(errno.EPERM), "permission denied: this user must be in the group"),
        (trouble(errno.EBUSY), "in use by another program: must be free"),
        (trouble(errno.ENODEV), "no camera there: must be a camera this user may use; found"),
        (trouble(errno.ENOTTY), "no camera there: must be a camera this user may use; found"),
        (trouble(errno.EIO), "Input/output error: must be a camera this user may use; found"),
    ],
)
def test_what_a_driver_refuses_is_said_in_one_line(monkeypatch, error, says):
    Device(monkeypatch, error)
    with pytest.raises(FrameSourceError, match=rf"^camera 0 \(/dev/video0\): {says}") as caught:
        lobula.frames.open("0")
    assert "\n" not in str(caught.value)


@linux_only
def test_a_wrong_pixel_format_is_named(monkeypatch):
    Device(monkeypatch, trouble(errno.EINVAL))
    says = r"does not give input_size 640x480, rate_hz 90, pixel_format yuyv: must be what the camera offers"
    with pytest.raises(FrameSourceError, match=says):
        lobula.frames.open(0, input_size=(640, 480), rate_hz=90, pixel_format="yuyv")


@linux_only
def test_unplugged_and_plugged_in_again(monkeypatch, tmp_path):
    monkeypatch.setattr(reconnect, "FIRST_WAIT_S", 0.001)
    clip = write_clip(tmp_path / "clip.mkv", moving_bar(8))
    device = Device(monkeypatch, clip, trouble(errno.ENODEV), trouble(errno.EACCES), clip)
    with lobula.frames.open(0, reconnect_s=60) as frames:
        frame, news = None, []
        while frame is None or frame.index < 8:
            frame = frames.poll(1)
            news += frames.news()
    assert [n.phase for n in news][:4] == ["lost", "retry", "retry", "back"]
    assert "no camera there" in news[1].facts["reason"]
    assert "permission denied" in news[2].facts["reason"]  # until the system has made the device anew
    assert device.opened >= 4


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
