"""Cameras and addresses: opened with time-outs, read as live sources."""

from __future__ import annotations

import errno
import sys
from collections.abc import Mapping
from pathlib import Path

from ..errors import FrameSourceError
from .inputs import InputOptions
from .video import VideoReader, open_container

_SYSTEMS = {"linux": "v4l2", "darwin": "avfoundation"}
_OURS = {
    "video_size": "input_size", "framerate": "rate_hz", "input_format": "pixel_format", "pixel_format": "pixel_format",
}  # fmt: skip
"""FFmpeg's name of a request -> ours."""


def open_camera(number: int, how: InputOptions) -> VideoReader:
    """Open camera ``number`` of this machine; size, rate and pixel format are requests the driver may refuse.

    Raises
    ------
    FrameSourceError : there is no such camera, it may not be used, is in use, or gives no picture of what was asked for
    """
    device = f"/dev/video{number}" if sys.platform == "linux" else str(number)
    name = f"camera {number}" + (f" ({device})" if sys.platform == "linux" else "")
    driver = _SYSTEMS.get(sys.platform)
    if driver is None:
        raise FrameSourceError(f"{name}: cameras are read on Linux and macOS, not on {sys.platform}")
    options = {}
    if how.input_size is not None:
        options["video_size"] = "{}x{}".format(*how.input_size)
    if how.rate_hz is not None:
        options["framerate"] = f"{how.rate_hz:g}"
    if how.pixel_format is not None:
        options["input_format" if driver == "v4l2" else "pixel_format"] = how.pixel_format
    timeout = (how.timeout_s, how.timeout_s)
    try:
        container = open_container(name, device, _cameras(), format=driver, options=options, timeout=timeout)
    except FrameSourceError as error:
        reason = _reason(getattr(error.__cause__, "errno", None), options)
        if reason is None:
            raise
        raise FrameSourceError(f"{name}: {reason}") from error
    return VideoReader(container, name, threads=how.threads, live=True)


def open_address(url: str, how: InputOptions) -> tuple[VideoReader, bool]:
    """Open an address; return its reader and whether it is live: a recording of known length is not.

    Raises
    ------
    FrameSourceError : no answer in time, or no video there
    """
    options = {"rtsp_flags": "prefer_tcp"} if url.startswith(("rtsp://", "rtsps://")) else {}
    name = _without_password(url)
    allowed = "must be the address of a video stream that answers"
    container = open_container(name, url, allowed, options=options, timeout=(how.timeout_s, how.timeout_s))
    recording = bool(container.duration) and url.startswith(("http://", "https://"))
    return VideoReader(container, name, threads=how.threads, live=not recording), not recording


def _reason(number: int | None, asked: Mapping[str, str]) -> str | None:
    """What a driver's error number means for the user, or None where its text says all there is to say."""
    if number in (errno.EACCES, errno.EPERM):
        return "permission denied: this user must be in the group that may use cameras, often called video"
    if number == errno.EBUSY:
        return "in use by another program: must be free"
    if number in (errno.ENOENT, errno.ENODEV, errno.ENXIO, errno.ENOTTY):
        return f"no camera there: {_cameras()}"
    if number == errno.EINVAL and asked:
        given = ", ".join(f"{_OURS[option]} {value}" for option, value in asked.items())
        return f"does not give {given}: must be what the camera offers, see `v4l2-ctl --list-formats-ext`"
    return None


def _cameras() -> str:
    if sys.platform != "linux":
        return "must be a camera this user may use"
    found = sorted(str(p) for p in Path("/dev").glob("video*"))
    return f"must be a camera this user may use; found {', '.join(found) or 'none'}"


def _without_password(url: str) -> str:
    scheme, _, rest = url.partition("://")
    host, slash, path = rest.partition("/")
    return f"{scheme}://{host.rpartition('@')[2]}{slash}{path}"
