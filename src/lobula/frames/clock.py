"""When each decoded picture was, and which number it has in its source."""

from __future__ import annotations

import heapq
import time
from typing import Any, NamedTuple

from ..errors import FrameSourceError, ParameterError
from .packets import stamp_of

UNSTAMPED = frozenset({"h261", "h263", "h264", "hevc", "m4v", "mjpeg", "mpegvideo", "obu", "vvc"})
"""Bare streams: they hold no time, and what a demuxer says of it is made up."""

_ARRIVAL = UNSTAMPED | {"mpjpeg", "rawvideo", "yuv4mpegpipe"}  # live, these take the time at which a picture came
_KERNEL = "v4l2"  # its stamps are the driver's, of the same clock as time.monotonic
_NEAR_S = 60.0  # a driver whose stamps lie further from now than this keeps another clock
_IN_DECODER = 64  # packets whose arrival is remembered; no decoder holds as many


class Moment(NamedTuple):
    """When a picture was: ``time_s`` and number in the source; live, also its arrival and its capture if known."""

    time_s: float
    number: int
    arrived_s: float | None = None
    captured_s: float | None = None


class Clock:
    """Times count from the first picture of the stream, in seconds; numbers from 0, damaged pictures included.

    Parameters
    ----------
    container_format : FFmpeg's name for it, such as "avi"
    tick_s : length of one unit of the stream's stamps
    rate_hz : pictures per second of a bare stream
    """

    def __init__(self, name: str, container_format: str, tick_s: float, rate_hz: float | None, live: bool) -> None:
        bare = container_format in UNSTAMPED
        if bare and not live and rate_hz is None:
            raise FrameSourceError(f"{name}: holds no time stamps: must be given its rate_hz (--rate)")
        if rate_hz is not None and not bare:
            raise ParameterError(f"rate_hz = {rate_hz:g}: must not be given for {name}, which has its own time stamps")
        self._name = name
        self._tick_s = tick_s
        self._rate_hz = rate_hz
        self._live = live
        self._by_arrival = live and container_format in _ARRIVAL
        self._by_kernel = live and _KERNEL in container_format.split(",")
        self._first_arrived_s: float | None = None
        self._arrived_s = 0.0  # of the newest packet
        self._before: tuple[float, float] | None = None  # time and arrival of the newest picture
        self._arrivals: dict[int, float] = {}  # by stamp, of the packets in the decoder
        # AVI stamps packets in the order of decoding: the n-th picture shown has the n-th smallest of those stamps
        self._by_decoding = container_format == "avi"
        self._untaken: list[int] = []
        self._lost: list[int] = []  # stamps of damaged packets not yet counted
        self._opening: list[int] = []  # stamps of the packets read until the source was open
        self._origin: int | None = None
        self._opened = False
        self._index = 0
        self._jump: tuple[float, int] | None = None

    def opened(self) -> None:
        """The first sound picture is there: where time begins is settled."""
        self._opened = True

    def packet(self, packet: Any) -> None:
        """Take note of a packet that goes to the decoder."""
        stamp = stamp_of(packet)
        if self._live:
            self._arrived_s = time.monotonic()
            if stamp is not None:
                self._arrivals[stamp] = self._arrived_s
            if len(self._arrivals) > _IN_DECODER:
                del self._arrivals[next(iter(self._arrivals))]
        if stamp is None or packet.is_discard:
            return
        if self._by_decoding:
            heapq.heappush(self._untaken, stamp)
        if not self._opened:
            self._opening.append(stamp)
            self._origin = stamp if self._origin is None else min(stamp, self._origin)

    def lost(self, packet: Any) -> None:
        """Take note that a packet was damaged: its picture has a number, but will not come."""
        stamp = None if packet is None else stamp_of(packet)
        if stamp is None:
            self._index += 1
            return
        self._lost.append(stamp)
        if stamp in self._untaken:
            self._untaken.remove(stamp)
            heapq.heapify(self._untaken)

    def stamp_at(self, time_s: float, reordered: bool) -> float | None:
        """Return the stamp that ``time_s`` falls on, or None where packets cannot be told apart by theirs.

        ``reordered`` says that pictures are shown in another order than they are stored.
        """
        if self._origin is None or self._rate_hz or self._by_arrival or (self._by_decoding and reordered):
            return None
        return self._origin + time_s / self._tick_s

    def jump(self, start: float, passed: int) -> None:
        """Go on after packets were left out: ``passed`` more than those read so far are shown before ``start``."""
        self._untaken.clear()
        self._lost.clear()
        self._jump = start, passed + sum(stamp < start for stamp in self._opening)

    def read(self, frame: Any) -> Moment:
        """Return when the next decoded picture was.

        Raises
        ------
        FrameSourceError : it has no time stamp
        """
        stamp = stamp_of(frame)
        if self._by_decoding:
            stamp = heapq.heappop(self._untaken) if self._untaken else None
        if self._jump is not None and stamp is not None and stamp >= self._jump[0]:
            self._index, self._jump = self._jump[1], None
        elif self._lost and stamp is not None:
            later = [lost for lost in self._lost if lost >= stamp]
            self._index += len(self._lost) - len(later)
            self._lost = later
        index, self._index = self._index, self._index + 1
        arrived_s = self._arrival(stamp) if self._live else None
        if self._by_arrival and arrived_s is not None:
            self._first_arrived_s = arrived_s if self._first_arrived_s is None else self._first_arrived_s
            return Moment(arrived_s - self._first_arrived_s, index, arrived_s)
        if self._rate_hz is not None:
            return Moment(index / self._rate_hz, index)
        if arrived_s is not None:
            return self._live_moment(stamp, index, arrived_s)
        if stamp is None or self._origin is None:
            raise FrameSourceError(f"{self._name}: frame {index}: no time stamp: must have one", on_the_way=index > 0)
        return Moment((stamp - self._origin) * self._tick_s, index)

    def _live_moment(self, stamp: int | None, number: int, arrived_s: float) -> Moment:
        """The moment of a picture that may have no stamp, as RTSP's first one often has none: it follows by arrival."""
        before_s, before_arrived_s = self._before or (0.0, arrived_s)
        time_s = before_s + arrived_s - before_arrived_s
        if stamp is not None:
            self._origin = stamp - round(time_s / self._tick_s) if self._origin is None else self._origin
            time_s = (stamp - self._origin) * self._tick_s
        self._before = time_s, arrived_s
        return Moment(time_s, number, arrived_s, None if stamp is None else self._capture(stamp))

    def _arrival(self, stamp: int | None) -> float:
        """When the packet of a picture came, before it was decoded."""
        return self._arrived_s if stamp is None else self._arrivals.pop(stamp, self._arrived_s)

    def _capture(self, stamp: int) -> float | None:
        """When the driver says that a picture was captured, if it keeps the clock that we do."""
        captured_s = stamp * self._tick_s
        near = self._by_kernel and 0.0 <= time.monotonic() - captured_s < _NEAR_S
        return captured_s if near else None
