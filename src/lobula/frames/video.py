"""Pictures of anything FFmpeg opens as a video, decoded by PyAV: every one, with the container's own stamps."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterator
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import av

from ..errors import FrameSourceError
from .clock import Clock
from .packets import Packets
from .selection import Picture

_DAMAGED_PICTURE = "its last picture is damaged"
_REORDERED = 16  # pictures a decoder may hold back to show them in order (H.264's most); damage can upset that order
_CUT_S = 0.5  # a stream that ends this much before the end its header names is worth a word


def open_container(name: str, url: Any, allowed: str, **how: Any) -> Any:
    """Open ``url`` with PyAV, turning its errors into one line that names the source and what is allowed.

    Raises
    ------
    FrameSourceError : it cannot be opened
    """
    try:
        return av.open(url, "r", **how)
    except (av.error.InvalidDataError, av.error.EOFError) as error:
        raise FrameSourceError(f"{name}: {allowed}") from error
    except av.error.ExitError as error:
        raise FrameSourceError(f"{name}: no answer in time: {allowed}") from error
    except (av.FFmpegError, OSError, ValueError) as error:
        raise FrameSourceError(f"{name}: {getattr(error, 'strerror', None) or error}: {allowed}") from error


def open_file(path: str | PathLike[str], threads: int = 1, rate_hz: float | None = None) -> VideoReader:
    """Open a video or image file.

    Raises
    ------
    FrameSourceError : it is not a video, or holds no picture
    """
    name = fspath(path)
    if Path(name).is_file() and not Path(name).stat().st_size:
        raise FrameSourceError(f"{name}: is empty: must be a file that FFmpeg decodes")
    if Path(name).is_file() and not os.access(name, os.R_OK):
        raise FrameSourceError(f"{name}: no permission to read it")
    allowed = "not a video: must be a file that FFmpeg decodes, not cut off before its index"
    # "file:" keeps a ":" in the name from being read as a protocol
    return VideoReader(open_container(name, f"file:{name}", allowed), name, threads=threads, rate_hz=rate_hz)


class VideoReader:
    """Decodes one video stream; ``time_s`` counts from the first picture of the stream.

    Parameters
    ----------
    threads : decoder threads; 0 lets FFmpeg choose
    rate_hz : pictures per second of a bare stream that holds no time stamps
    live : formats that hold no time stamps take the time of arrival
    cut_tail_is_fine : a last picture cut short is noted and left out, rather than being an error

    Raises
    ------
    FrameSourceError : there is no video stream, or no picture in it
    """

    def __init__(
        self,
        container: Any,
        name: str,
        *,
        threads: int = 1,
        rate_hz: float | None = None,
        live: bool = False,
        cut_tail_is_fine: bool = False,
    ) -> None:
        self.name = name
        self.damaged = 0
        self.notes: list[str] = []
        self._container = container
        self._cut_tail_is_fine = cut_tail_is_fine
        self._ready: deque[Picture] = deque()  # decoded and not yet delivered
        self._broken: str | None = None  # what is wrong with the newest data
        self._upset = 0  # pictures for which the order may still be wrong, after damage
        self._latest_s = -1.0
        try:
            self._stream = _video_stream(container, name)
            self._codec = self._stream.codec_context
            self._codec.thread_type = "SLICE" if threads == 1 else "AUTO"
            self._codec.thread_count = threads
            base = self._stream.time_base
            self._clock = Clock(name, container.format.name, base.numerator / base.denominator, rate_hz, live)
            self._packets = Packets(container, self._stream, name, try_again=not live)
            if not self._fill():
                reason = self._packets.failure or self._broken or "must hold at least one"
                raise FrameSourceError(f"{name}: no picture could be decoded: {reason}")
        except BaseException:
            container.close()
            raise
        self._clock.opened()
        self.first = self._ready[0].data
        # PyAV tells it counter-clockwise
        self.rotation = round(-self.first.rotation / 90) * 90 % 360
        self.fps = rate_hz or float(self._stream.average_rate or self._stream.guessed_rate or 0.0)
        self.frame_count = self._announced_count()

    def pictures(self, start_s: float | None = None) -> Iterator[Picture]:
        """Yield every picture in order; with ``start_s``, what lies well before it is not decoded.

        Raises
        ------
        FrameSourceError : the data is damaged up to its end, or the source fails on the way
        """
        if start_s:
            self._skip(start_s)
        last: Picture | None = None
        while self._ready or self._fill():
            last = self._ready.popleft()
            yield last
        self._finish(last)

    def close(self) -> None:
        """Close the container."""
        self._container.close()

    def _announced_count(self) -> int | None:
        if self._stream.frames > 0:
            return int(self._stream.frames)
        duration_us = self._container.duration
        return round(duration_us / 1e6 * self.fps) if duration_us and self.fps else None

    def _skip(self, start_s: float) -> None:
        start = self._clock.stamp_at(start_s, bool(self._codec.has_b_frames))
        if start is None or self._ready[0].time_s >= start_s:
            return
        jumped, passed = self._packets.skip(start)
        if jumped:
            self._codec.flush_buffers()
            self._ready.clear()
            self._latest_s = -1.0
            self._clock.jump(start, passed)

    def _fill(self) -> bool:
        """Decode until a picture is ready; False at the end."""
        while not self._ready:
            try:
                packet = next(self._packets)
            except StopIteration:
                return False
            self._decode(packet)
        return True

    def _decode(self, packet: Any) -> None:
        """Give one packet to the decoder and keep the pictures that come out."""
        holds_data = packet is not None and packet.size > 0
        if holds_data:
            self._clock.packet(packet)
        try:
            frames = self._codec.decode(packet)
        except av.error.EOFError:
            return
        except av.FFmpegError as error:
            self.damaged += 1
            self._clock.lost(packet)
            self._broken = error.strerror or str(error)
            self._upset = _REORDERED
            return
        if holds_data:
            self._broken = None
        for frame in frames:
            self._keep(frame)

    def _keep(self, frame: Any) -> None:
        """Make a decoded picture ready, unless the decoder guessed parts of it or gave it too late."""
        moment = self._clock.read(frame)
        if frame.is_corrupt:
            self.damaged += 1
            self._broken = _DAMAGED_PICTURE
            self._upset = _REORDERED
            return
        if self._broken == _DAMAGED_PICTURE:
            self._broken = None
        if self._upset and moment.time_s <= self._latest_s:
            self.damaged += 1
            return
        self._upset = max(0, self._upset - 1)
        self._latest_s = moment.time_s
        self._ready.append(Picture(frame, *moment))

    def _finish(self, last: Picture | None) -> None:
        """Say what there is to say about the end of the stream."""
        if self._packets.failure is not None:
            raise self._packets.failure
        where = f"after {last.time_s:.3f} s (frame {last.index})" if last else "at its beginning"
        if self._broken and self._cut_tail_is_fine:
            self.damaged -= 1
            self.notes.append(f"{self.name}: the last picture is cut short: left out; check input_size (--input-size)")
        elif self._broken:
            raise FrameSourceError(f"{self.name}: damaged or cut off {where}: {self._broken}", on_the_way=True)
        elif last is not None and (missing_s := self._missing_s(last)) > _CUT_S:
            self.notes.append(f"{self.name}: ends {where}, {missing_s:.1f} s before the end its header names")

    def _missing_s(self, last: Picture) -> float:
        """How much earlier than announced the stream ended; 0 where nothing reliable was announced."""
        if self._stream.duration is not None:
            announced_s = float(self._stream.duration * self._stream.time_base)
        elif self._container.duration is not None and len(self._container.streams) == 1:
            announced_s = self._container.duration / 1e6
        else:
            return 0.0
        return announced_s - last.time_s - (1 / self.fps if self.fps else 0.0)


def _video_stream(container: Any, name: str) -> Any:
    stream = container.streams.best("video")
    # FFmpeg would draw any text file as a picture of its characters
    if stream is None or container.format.name == "tty":
        raise FrameSourceError(f"{name}: not a video: must hold a picture stream that FFmpeg decodes")
    if stream.codec_context is None:
        raise FrameSourceError(f"{name}: no decoder for its picture stream in this build of FFmpeg")
    return stream
