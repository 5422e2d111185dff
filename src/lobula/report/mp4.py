"""H.264 in MP4: playable while it grows, fast to start when it is done, and looked at before it is called saved."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from contextlib import suppress
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
from av.error import FFmpegError
from av.video.reformatter import ColorRange, Colorspace, VideoReformatter
from numpy.typing import NDArray

from ..errors import OutputError, ShapeError
from .landing import part_of, whole_file, writing

TICK = Fraction(1, 90_000)
"""Time base of the video, s: the usual one, exact for 24, 25, 30 and 60 Hz, 11 us at worst elsewhere."""

_FRAGMENTED = {"movflags": "frag_keyframe+empty_moov+default_base_moof", "flush_packets": "1"}
_FASTSTART = {"movflags": "+faststart"}


class Mp4Writer:
    """Encodes RGB pictures with their own time stamps into ``path``.

    While it runs the video is the fragmented ``NAME.part.mp4``, whole up to about the last second whatever happens to
    the process. ``finish`` copies it into a faststart ``path``, checks that file and removes the part.

    Raises
    ------
    OutputError : PyAV was built without libx264, or the file cannot be written
    ShapeError : an odd width or height, which yuv420p cannot hold
    """

    def __init__(
        self, path: str | Path, width: int, height: int, fps: float = 30.0, about: Mapping[str, Any] | None = None
    ) -> None:
        self.path = Path(path)
        self.part = part_of(self.path, ".mp4")
        self.frames = 0
        self._to_yuv = VideoReformatter()  # one for all frames: setting one up costs as much as using it
        self._about = json.dumps(about or {}, default=str)
        self._start_s = 0.0
        self._last_tick, self._gap = -1, round(1 / fps / TICK)
        self._whole_bytes = 0  # of the part: up to here it holds complete fragments
        require_h264(self.path)
        if width % 2 or height % 2:
            raise ShapeError(f"video {self.path}: {width} x {height} px: width and height must be even")
        with writing(self.path, FFmpegError):
            self._container = av.open(str(self.part), "w", format="mp4", options=_FRAGMENTED)
            self._container.metadata["comment"] = self._about
            self._stream = self._container.add_stream("libx264", rate=Fraction(fps).limit_denominator(1000))
            self._stream.width, self._stream.height, self._stream.pix_fmt = width, height, "yuv420p"
            context = self._stream.codec_context
            context.time_base = TICK
            context.color_range, context.colorspace = 1, 6  # limited range, BT.601: what the conversion below writes
            context.color_primaries, context.color_trc = 6, 6
            # A key frame a second, no B frames, a short look-ahead: at most about a second is lost with the process.
            key_every = str(min(max(round(fps), 5), 120))
            context.options = {
                "preset": "veryfast",
                "crf": "22",
                "bf": "0",
                "g": key_every,
                "rc-lookahead": "5",
                "threads": "2",
            }
            self._container.start_encoding()

    def write(self, picture: NDArray[np.uint8], time_s: float) -> None:
        """Add one (height, width, 3) RGB picture, to be shown from ``time_s`` on; the first one starts the video."""
        if self.frames == 0:
            self._start_s = time_s
        tick = max(round((time_s - self._start_s) / TICK), self._last_tick + 1)
        if self.frames:
            self._gap = tick - self._last_tick
        with writing(self.path, FFmpegError):
            frame = av.VideoFrame.from_numpy_buffer(np.ascontiguousarray(picture), format="rgb24")
            frame = self._to_yuv.reformat(
                frame, format="yuv420p", dst_colorspace=Colorspace.ITU601, dst_color_range=ColorRange.MPEG
            )
            frame.pts, frame.time_base = tick, TICK
            self._container.mux(self._stream.encode(frame))
            self._whole_bytes = self.part.stat().st_size
        self._last_tick = tick
        self.frames += 1

    def finish(self) -> None:
        """Write what is still in the encoder, then put the checked file at ``path``.

        Raises
        ------
        OutputError : it cannot be written or does not read back as it should; ``part`` holds what there is
        """
        try:
            with writing(self.path, FFmpegError):
                self._container.mux(self._stream.encode(None))
                self._container.close()
                self._whole_bytes = self.part.stat().st_size
            with whole_file(self.path, FFmpegError) as temporary:
                _faststart(self.part, temporary, self._about, self._gap)
                check_h264(temporary, self.frames)
        except OutputError as error:
            self.abandon()
            raise OutputError(f"{error}; {self.part} holds what was encoded") from error
        self.part.unlink()

    def abandon(self) -> None:
        """Close ``part`` without making ``path``, for when writing has failed: what was torn is cut off its end."""
        with suppress(OSError, FFmpegError, ValueError):
            self._container.close()
        with suppress(OSError):
            if self.part.stat().st_size > self._whole_bytes:
                os.truncate(self.part, self._whole_bytes)


def require_h264(path: Path) -> None:
    """Check that this PyAV can encode H.264.

    Raises
    ------
    OutputError : it cannot
    """
    if "libx264" not in av.codecs_available:
        raise OutputError(f"cannot write {path}: this PyAV has no libx264 encoder; the `pip install av` wheel has")


def check_h264(path: Path, frames: int) -> None:
    """Open ``path`` again and check that it is H.264, yuv420p, holds ``frames`` frames and shows the first one.

    Raises
    ------
    OutputError : it does not
    """
    with writing(path, FFmpegError, StopIteration, IndexError), av.open(str(path)) as container:
        stream = container.streams.video[0]
        first = next(container.decode(stream))
        container.seek(0)
        counted = sum(1 for packet in container.demux(stream) if packet.size)
        found = (stream.codec_context.name, first.format.name, counted)
    if found != ("h264", "yuv420p", frames):
        raise OutputError(f"{path} reads back as {found}, not as ('h264', 'yuv420p', {frames})")


def _faststart(part: Path, path: Path, about: str, last_gap: int) -> None:
    """Copy the packets of the fragmented ``part`` into a plain MP4 that has its index in front."""
    with av.open(str(part)) as source, av.open(str(path), "w", format="mp4", options=_FASTSTART) as target:
        target.metadata["comment"] = about
        video = source.streams.video[0]
        copy = target.add_stream_from_template(video)
        copy.time_base = TICK
        held = None
        for packet in source.demux(video):
            if not packet.size:
                continue
            if held is not None:
                target.mux(held)
            packet.stream = copy
            held = packet
        if held is not None:
            held.duration = last_gap  # nothing follows it to say how long it shows
            target.mux(held)
