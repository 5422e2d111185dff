"""Where frames come from: a file, a folder, a pattern, a pipe, a camera, an address, an array.

Every source gives the same: full-range luma at the working size, each frame with its own time stamp.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from os import PathLike
from typing import Any

from numpy.typing import NDArray

from .geometry import Fit, Flip, View
from .inputs import InputOptions, open_reader
from .live import FrameStream
from .resize import AreaAverage, Rect, Resize, Resizer
from .selection import Selection
from .source import FrameSequence, FrameSource, Reader

__all__ = ["AreaAverage", "FrameSequence", "FrameSource", "FrameStream", "Rect", "Resize", "Resizer", "open"]


def open(
    source: str | PathLike[str] | int | NDArray[Any] | Any,
    *,
    size: tuple[int, int] = (99, 72),
    fit: Fit = "crop",
    roi: tuple[int, int, int, int] | None = None,
    mask: str | PathLike[str] | NDArray[Any] | None = None,
    flip: Flip | None = None,
    rotate: int = 0,
    start_s: float | None = None,
    end_s: float | None = None,
    stride: int = 1,
    max_frames: int | None = None,
    rate_hz: float | None = None,
    times_s: Sequence[float] | NDArray[Any] | None = None,
    pixel_format: str | None = None,
    input_size: tuple[int, int] | None = None,
    topic: str | None = None,
    live: bool | None = None,
    threads: int = 1,
    timeout_s: float = 10.0,
    reconnect_s: float = 0.0,
    resizer: Resizer | None = None,
) -> FrameSequence | FrameStream:
    """Return an open source of frames: a context manager and an iterator of ``Frame``.

    Parameters
    ----------
    source : a video or image file; a folder of images; a pattern such as "shots/*.png"; a ROS bag; a ``.npz`` with
        ``images`` and ``times_s``; "-" for standard input; a camera number (0 or "0"); an address (rtsp://, http://,
        ...); (T, H, W) images, uint8 or float luma 0..255; or an object with ``images`` and ``times_s``
    size : (width, height) of the working image
    fit : how a picture of another shape is brought to it: "crop" the middle, "squeeze", or "pad" with grey
    roi : (x, y, width, height), pixels of the picture after rotation and flip
    mask : an image, white where the picture counts; what its black touches is held at grey 128
    flip : "h" mirrors left and right, "v" top and bottom, "hv" both
    rotate : 0, 90, 180 or 270 degrees clockwise, on top of what the container says
    start_s, end_s : frames with start_s <= time < end_s; time counts from the first picture (arrays: as given)
    stride, max_frames : every stride-th frame; at most so many
    rate_hz : pictures per second of a folder without times.csv, a raw pipe, a bare stream, an array or a ``.npz``
        without times; a request to a camera
    times_s : (T,) stamps of an array, seconds
    pixel_format, input_size : layout and (width, height) of a raw pipe's pictures; a request to a camera
    topic : which pictures of a ROS bag; may be left out if it holds one topic with pictures
    live : a pipe's newest frame instead of every one, with silence and latency looked at
    threads : decoder threads; 0 lets FFmpeg choose
    timeout_s : how long a camera or an address may stay silent
    reconnect_s : how long a camera or an address that went away is tried again; 0 not at all, infinity for ever
    resizer : makes the crop-and-average step for uint8 planes; by default ``AreaAverage``

    Returns
    -------
    FrameSequence : every frame, in order
    FrameStream : the newest frame; for cameras, addresses that are not recordings of known length, a live pipe

    Raises
    ------
    ParameterError : an argument out of range, or one that does not belong to this kind of source
    ShapeError, TimeError : an array or its times are not what the network reads
    FrameSourceError : the source cannot be opened
    """
    view = View(size=size, fit=fit, roi=roi, mask=mask, flip=flip, rotate=rotate)
    selection = Selection(start_s=start_s, end_s=end_s, stride=stride, max_frames=max_frames)
    options = InputOptions(
        rate_hz=rate_hz,
        times_s=times_s,
        pixel_format=pixel_format,
        input_size=input_size,
        topic=topic,
        live=live,
        threads=threads,
        timeout_s=timeout_s,
        reconnect_s=reconnect_s,
    )
    reader, live = open_reader(source, options)
    try:
        if live:
            again = None if reader.name == "-" else partial(_reopen, source, options)
            return FrameStream(reader, view, selection, resizer, timeout_s, again, reconnect_s)
        return FrameSequence(reader, view, selection, resizer)
    except BaseException:
        reader.close()
        raise


def _reopen(source: Any, options: InputOptions) -> Reader:
    return open_reader(source, options)[0]
