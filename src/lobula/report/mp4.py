"""H.264 in MP4: playable while it grows, fast to start when it is done, and looked at before it is called saved."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import av
import numpy as np
from av.error import FFmpegError
from numpy.typing import NDArray

from ..errors import OutputError
from ..landing import part_of, whole_file, writing
from .h264 import FRAGMENTED, TICK, Coded, H264Encoder

_FASTSTART = {"movflags": "+faststart"}


class Mp4File:
    """Puts the packets of one encoder into ``path``; the first one must be a key frame, and is shown at 0 s.

    None may come more than ``MOST_GAP_TICKS`` after the one before.

    While it grows the video is the fragmented ``NAME.part.mp4``, whole up to the last half second whatever happens to
    the process. ``finish`` copies it into a faststart ``path``, checks that file and removes the part. An older part is
    replaced: ``set_aside`` what cannot be made again.

    Raises
    ------
    OutputError : the file cannot be written
    """

    def __init__(self, path: str | Path, template: Any, about: Mapping[str, Any] | None = None) -> None:
        self.path = Path(path)
        self.part = part_of(self.path, ".mp4")
        self._about = json.dumps(about or {}, default=str)
        self._first_tick: int | None = None
        self._last_tick, self._gap = 0, round(1 / 30 / TICK)
        self._whole_bytes = 0  # of the part: up to here it holds complete fragments
        try:
            with writing(self.path, FFmpegError):
                self._container = av.open(str(self.part), "w", format="mp4", options=FRAGMENTED)
                self._container.metadata["comment"] = self._about
                self._stream = self._container.add_stream_from_template(template, opaque=True)
                self._stream.time_base = TICK
                self._container.start_encoding()
        except OutputError:
            with suppress(OSError):
                self.part.unlink()  # there is nothing in it
            raise

    def add(self, coded: Coded) -> None:
        """Append a packet; it is on its way to the disk within half a second of video."""
        if self._first_tick is None:
            self._first_tick = self._last_tick = coded.tick
        else:
            self._gap, self._last_tick = coded.tick - self._last_tick, coded.tick
        with writing(self.path, FFmpegError):
            packet = av.Packet(coded.data)
            packet.pts = packet.dts = coded.tick - self._first_tick
            packet.time_base, packet.is_keyframe = TICK, coded.key
            packet.stream = self._stream
            self._container.mux(packet)
            self._whole_bytes = self.part.stat().st_size

    def finish(self, frames: int) -> None:
        """Close the part, put the checked file of ``frames`` frames at ``path`` and remove the part.

        Raises
        ------
        OutputError : it cannot be written or does not read back as it should; ``part`` holds what there is
        """
        try:
            with writing(self.path, FFmpegError):
                self._container.close()
                self._whole_bytes = self.part.stat().st_size
            with whole_file(self.path, FFmpegError) as temporary:
                _faststart(self.part, temporary, self._about, self._gap)
                check_h264(temporary, frames, self._last_tick - (self._first_tick or 0))
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


class Mp4Writer:
    """Encodes RGB pictures with their own time stamps into ``path``, as ``Mp4File`` does with packets.

    Raises
    ------
    OutputError : PyAV was built without libx264, or the file cannot be written
    ShapeError : an odd width or height, which yuv420p cannot hold
    """

    def __init__(
        self,
        path: str | Path,
        width: int,
        height: int,
        fps: float = 30.0,
        about: Mapping[str, Any] | None = None,
        *,
        crf: int = 22,
        speed: str = "veryfast",
    ) -> None:
        self.path = Path(path)
        self.frames = 0
        self._encoder = H264Encoder(self.path, width, height, fps, crf=crf, speed=speed)
        self._file = Mp4File(self.path, self._encoder.template, about)
        self.part = self._file.part

    def write(self, picture: NDArray[np.uint8], time_s: float) -> None:
        """Add one (height, width, 3) RGB picture, to be shown from ``time_s`` on; the first one starts the video.

        In a pause of hours the picture before it is repeated.
        """
        for coded in self._encoder.repeats(time_s):
            self._add(coded)
        self._add(self._encoder.encode(picture, time_s))

    def finish(self) -> None:
        """Put the checked file at ``path``.

        Raises
        ------
        OutputError : it cannot be written or does not read back as it should; ``part`` holds what there is
        """
        self._encoder.close()
        self._file.finish(self.frames)

    def abandon(self) -> None:
        """Close ``part`` without making ``path``, for when writing has failed."""
        self._encoder.close()
        self._file.abandon()

    def _add(self, coded: Coded) -> None:
        self._file.add(coded)
        self.frames += 1


def check_h264(path: Path, frames: int, last_tick: int) -> None:
    """Open ``path`` again and check what is in it.

    It must be H.264, yuv420p, hold ``frames`` frames, the last one at ``last_tick``, and show the first one.

    Raises
    ------
    OutputError : it does not
    """
    with writing(path, FFmpegError, StopIteration, IndexError), av.open(str(path)) as container:
        stream = container.streams.video[0]
        first = next(container.decode(stream))
        container.seek(0)
        counted, last = 0, None
        for packet in container.demux(stream):
            if packet.size:
                counted, last = counted + 1, packet.pts
        found = (stream.codec_context.name, first.format.name, counted, last)
    wanted = ("h264", "yuv420p", frames, last_tick)
    if found != wanted:
        raise OutputError(f"{path} reads back as {found}, not as {wanted}")


def _faststart(part: Path, path: Path, about: str, last_gap: int) -> None:
    """Copy the packets of the fragmented ``part`` into a plain MP4 that has its index in front."""
    with av.open(str(part)) as source, av.open(str(path), "w", format="mp4", options=_FASTSTART) as target:
        target.metadata["comment"] = about
        video = source.streams.video[0]
        copy = target.add_stream_from_template(video, opaque=True)
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
