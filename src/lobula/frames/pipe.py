"""Pictures from a pipe on standard input: raw grey or YUV, or any stream that FFmpeg recognises."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from io import FileIO
from typing import Any

import av

from ..errors import FrameSourceError, ParameterError
from .selection import Picture
from .video import VideoReader, open_container

DEFAULT_RATE_HZ = 30.0

RAW_FORMATS = {"gray8": "gray", "grey": "gray", "grey8": "gray"}
"""Names a camera person uses, and FFmpeg's for the same; any other name is taken as FFmpeg's own."""


def open_pipe(
    pixel_format: str | None = None,
    input_size: tuple[int, int] | None = None,
    rate_hz: float | None = None,
    threads: int = 1,
    file: Any = None,
    *,
    live: bool = False,
) -> VideoReader:
    """Open standard input (or ``file``, opened for reading bytes).

    With ``pixel_format`` (gray8, yuv420p, nv12, yuyv422, rgb24, ...) and ``input_size`` (width, height) it holds raw
    pictures one after another, at ``rate_hz``; a last one that is cut short is noted and left out. Without them it
    must be a stream that says what it is, such as Matroska, MPEG-TS or YUV4MPEG. With ``live`` raw pictures and others
    without stamps of their own take the time at which they came.

    Raises
    ------
    ParameterError : a pixel format FFmpeg does not know, or only one of the two given
    FrameSourceError : nothing comes in, or it is no stream FFmpeg recognises
    """
    if (pixel_format is None) != (input_size is None):
        raise ParameterError("raw pictures from a pipe: must be given both pixel_format and input_size")
    # unbuffered: a read returns what has arrived, so a picture is not held back until the next one fills a buffer
    pipe = _Pipe(FileIO(sys.stdin.fileno(), closefd=False) if file is None else file)
    try:
        if pixel_format is None or input_size is None:
            allowed = "not a stream that FFmpeg recognises: raw pictures need pixel_format and input_size"
            return PipeReader(open_container("-", pipe, allowed), "-", threads=threads, rate_hz=rate_hz, live=live)
        how, picture_bytes = raw_options(pixel_format, input_size, rate_hz or DEFAULT_RATE_HZ)
        width, height = input_size
        allowed = f"no whole {width} x {height} {pixel_format} picture: must hold {picture_bytes} bytes each"
        container = open_container("-", pipe, allowed, format="rawvideo", options=how, buffer_size=picture_bytes)
        try:
            return PipeReader(container, "-", cut_tail_is_fine=True, live=live)
        except FrameSourceError as error:
            raise FrameSourceError(f"-: {allowed}") from error
    except _InterruptError as carried:
        raise carried.reason from None


class PipeReader(VideoReader):
    """Reads a pipe; an interrupt that arrives while it waits for data ends the wait."""

    def pictures(self, start_s: float | None = None) -> Iterator[Picture]:
        """Yield every picture in order, as ``VideoReader`` does."""
        try:
            yield from super().pictures(start_s)
        except _InterruptError as carried:
            raise carried.reason from None


class _InterruptError(Exception):
    """Takes a KeyboardInterrupt and its like through PyAV, which would swallow it and go on reading."""

    def __init__(self, reason: BaseException) -> None:
        super().__init__()
        self.reason = reason


class _Pipe:
    """The bytes of a pipe, as PyAV wants to read them."""

    def __init__(self, file: Any) -> None:
        self._file = file

    def read(self, size: int) -> bytes:
        try:
            data: bytes = self._file.read(size)
        except Exception:
            raise
        except BaseException as reason:
            raise _InterruptError(reason) from None
        return data


def raw_options(pixel_format: str, input_size: tuple[int, int], rate_hz: float) -> tuple[dict[str, str], int]:
    """Return FFmpeg's options for raw pictures and the bytes of one.

    Raises
    ------
    ParameterError : FFmpeg does not know the pixel format
    """
    name = RAW_FORMATS.get(pixel_format, pixel_format)
    width, height = input_size
    try:
        frame = av.VideoFrame(width, height, name)
    except ValueError as error:
        raise ParameterError(
            f"pixel_format = {pixel_format!r}: must be gray8, yuv420p, nv12, yuyv422 or another name of FFmpeg's"
        ) from error
    bits = frame.format.padded_bits_per_pixel * width * height
    options = {"pixel_format": name, "video_size": f"{width}x{height}", "framerate": f"{rate_hz:.6f}"}
    return options, max(1, bits // 8)
