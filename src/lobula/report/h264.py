"""Pictures become H.264 packets, each at once, with a key frame every second: whatever is cut off loses little."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import av
import numpy as np
from av.error import FFmpegError
from av.video.frame import PictureType
from av.video.reformatter import ColorRange, Colorspace, VideoReformatter
from numpy.typing import NDArray

from ..errors import OutputError, ShapeError
from ..landing import writing

TICK = Fraction(1, 90_000)
"""Time base of the video, s: the usual one, exact for 24, 25, 30 and 60 Hz, 11 us at worst elsewhere."""

KEY_TICKS = round(1 / TICK)
"""A key frame this often at least, by the pictures' own times: a stream can be entered at each of them."""

MOST_GAP_TICKS = 2**30
"""Pictures of a file lie no further apart, 3.3 h: from 2^31 - 1 ticks on FFmpeg puts a stamp of its own in the place of
the one it is given, in either kind of MP4."""

MOST_REPEATS = 1000
"""A pause that would take more pictures to bridge, 138 days, is taken for a broken clock."""

FRAGMENTED = {
    "movflags": "frag_keyframe+empty_moov+default_base_moof",
    "frag_duration": "500000",  # us; a fragment is on the disk when the next one begins
    "flush_packets": "1",
}
"""How an MP4 is written that is readable while it grows."""


_START_CODE = re.compile(rb"\x00\x00\x00?\x01")  # nothing else in the stream looks like it: H.264, annex B


class Coded(NamedTuple):
    """One encoded picture: its bytes as an MP4 holds them, when it is shown, whether a decoder can begin with it."""

    data: bytes
    tick: int
    key: bool


class H264Encoder:
    """Encodes RGB pictures of one size. ``template`` is what a file needs to know to hold the packets.

    Parameters
    ----------
    path : what the packets are for, for messages
    fps : roughly, for the rate control
    crf : quality, lower is better and larger
    speed : x264's preset

    Raises
    ------
    OutputError : PyAV was built without libx264
    ShapeError : an odd width or height, which yuv420p cannot hold
    """

    def __init__(
        self, path: Path, width: int, height: int, fps: float = 30.0, *, crf: int = 22, speed: str = "veryfast"
    ) -> None:
        require_h264(path)
        if width % 2 or height % 2:
            raise ShapeError(f"video {path}: {width} x {height} px: width and height must be even")
        self.width, self.height = width, height
        self._path = path
        self._to_yuv = VideoReformatter()  # one for all frames: setting one up costs as much as using it
        self._last_tick, self._key_tick = -1, -KEY_TICKS
        self._start_s: float | None = None
        self._newest: av.VideoFrame | None = None
        header = io.BytesIO()
        with writing(path, FFmpegError):
            self._container = av.open(header, "w", format="mp4", options=FRAGMENTED)
            self._stream = self._container.add_stream("libx264", rate=Fraction(fps).limit_denominator(1000))
            self._stream.width, self._stream.height, self._stream.pix_fmt = width, height, "yuv420p"
            context = self._stream.codec_context
            context.time_base = TICK
            context.color_range, context.colorspace = 1, 6  # limited range, BT.601: what the conversion below writes
            context.color_primaries, context.color_trc = 6, 6
            context.options = {
                "preset": speed,
                "tune": "zerolatency",  # no picture waits in the encoder for later ones, nor is lost there
                "crf": str(crf),
                "g": "100000",  # key frames come by time, below, and not by what is in the picture
                "sc_threshold": "0",
                "forced-idr": "1",
                "threads": "2",
            }
            self._container.start_encoding()
            # an output stream is no template for another one in every PyAV; one that was read is
            self._header = av.open(io.BytesIO(header.getvalue()))
        self.template: Any = self._header.streams.video[0]

    def encode(self, picture: NDArray[np.uint8], time_s: float) -> Coded:
        """Return one (height, width, 3) RGB picture encoded, shown from ``time_s`` on; the first one is at tick 0."""
        self._start_s = time_s if self._start_s is None else self._start_s
        with writing(self._path, FFmpegError):
            frame = av.VideoFrame.from_numpy_buffer(np.ascontiguousarray(picture), format="rgb24")
            self._newest = self._to_yuv.reformat(
                frame, format="yuv420p", dst_colorspace=Colorspace.ITU601, dst_color_range=ColorRange.MPEG
            )
        return self._encoded(self._newest, self._tick_at(time_s))

    def repeats(self, time_s: float) -> Iterator[Coded]:
        """Yield the newest picture again, as often as the one that is to follow at ``time_s`` is too far from it.

        Raises
        ------
        OutputError : that is more than ``MOST_REPEATS`` times
        """
        if self._newest is None:
            return
        tick = self._tick_at(time_s)
        if tick - self._last_tick > MOST_REPEATS * MOST_GAP_TICKS:
            days = (tick - self._last_tick) * TICK / 86_400
            raise OutputError(f"cannot write {self._path}: a picture comes {float(days):.0f} days after the one before")
        while tick - self._last_tick > MOST_GAP_TICKS:
            yield self._encoded(self._newest, self._last_tick + MOST_GAP_TICKS)

    def _tick_at(self, time_s: float) -> int:
        assert self._start_s is not None
        return max(round((time_s - self._start_s) / TICK), self._last_tick + 1)

    def _encoded(self, frame: av.VideoFrame, tick: int) -> Coded:
        with writing(self._path, FFmpegError):
            frame.pts, frame.time_base = tick, TICK
            if tick - self._key_tick >= KEY_TICKS:
                frame.pict_type = PictureType.I
            (packet,) = self._stream.encode(frame)
        if packet.is_keyframe:
            self._key_tick = tick
        self._last_tick = tick
        return Coded(_with_lengths(bytes(packet)), tick, bool(packet.is_keyframe))

    def close(self) -> None:
        """Let go of the encoder."""
        self._header.close()
        self._container.close()


def _with_lengths(data: bytes) -> bytes:
    """Take a packet from start codes, as the encoder writes it, to lengths, as ``template`` says that it is."""
    units = _START_CODE.split(data)[1:]
    return b"".join(len(unit).to_bytes(4, "big") + unit for unit in units)


def require_h264(path: Path) -> None:
    """Check that this PyAV can encode H.264.

    Raises
    ------
    OutputError : it cannot
    """
    if "libx264" not in av.codecs_available:
        raise OutputError(f"cannot write {path}: this PyAV has no libx264 encoder; the `pip install av` wheel has")
