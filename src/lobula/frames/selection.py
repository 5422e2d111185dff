"""Which frames of a source are wanted: a stretch of time, every n-th, at most so many."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from ..errors import FrameSourceError, ParameterError


@dataclass(frozen=True, slots=True)
class Picture:
    """One decoded picture before it is sampled: a PyAV video frame or an (H, W) array, its stamp and its number.

    Of live sources also when it came in and when it was captured, on the clock of ``time.monotonic``, the number of its
    connection from 1, and how often the thread of pictures had broken off before it.
    """

    data: Any
    time_s: float
    index: int
    arrived_s: float | None = None
    captured_s: float | None = None
    connection: int = 1
    breaks: int = 0


@dataclass(frozen=True, kw_only=True)
class Selection:
    """Frames with ``start_s <= time < end_s``, every ``stride``-th of them, at most ``max_frames``."""

    start_s: float | None = None
    end_s: float | None = None
    stride: int = 1
    max_frames: int | None = None

    def __post_init__(self) -> None:
        for name in ("start_s", "end_s"):
            value = getattr(self, name)
            if value is not None and not (_is_number(value) and math.isfinite(value) and value >= 0):
                raise ParameterError(f"{name} = {value!r}: must be a time of 0 s or more")
        if self.start_s is not None and self.end_s is not None and self.end_s <= self.start_s:
            raise ParameterError(f"end_s = {self.end_s:g}: must be after start_s = {self.start_s:g}")
        for name in ("stride", "max_frames"):
            value = getattr(self, name)
            if value is None and name == "max_frames":
                continue
            if isinstance(value, bool) or not isinstance(value, int) or value < 1:
                raise ParameterError(f"{name} = {value!r}: must be a whole number of 1 or more")

    def within(self, pictures: Iterator[Picture]) -> Iterator[Picture]:
        """Yield the pictures of the stretch of time, every ``stride``-th of them."""
        wanted = 0
        for picture in pictures:
            if self.start_s is not None and picture.time_s < self.start_s:
                continue
            if self.end_s is not None and picture.time_s >= self.end_s:
                return
            if wanted % self.stride == 0:
                yield picture
            wanted += 1

    def expected(self, count: int | None, fps: float) -> int | None:
        """Estimate how many of ``count`` frames at ``fps`` are wanted; None when it cannot be told."""
        if count is not None and fps > 0:
            first = math.ceil((self.start_s or 0.0) * fps)
            last = count if self.end_s is None else min(count, math.ceil(self.end_s * fps))
            count = math.ceil(max(0, last - first) / self.stride)
        elif count is None and self.end_s is not None and fps > 0:
            count = math.ceil((self.end_s - (self.start_s or 0.0)) * fps / self.stride)
        if self.max_frames is not None:
            count = self.max_frames if count is None else min(count, self.max_frames)
        return count


def increasing(pictures: Iterator[Picture], name: str) -> Iterator[Picture]:
    """Yield ``pictures``, each stamp finite and after the one before it.

    Raises
    ------
    FrameSourceError : a stamp stands still, runs backwards or is not finite
    """
    previous_s: float | None = None
    for picture in pictures:
        time_s = picture.time_s
        if not math.isfinite(time_s) or (previous_s is not None and time_s <= previous_s):
            word = "stands still" if time_s == previous_s else "runs backwards"
            raise FrameSourceError(
                f"{name}: frame {picture.index}: time {word}: {time_s:.6f} s after {previous_s or 0.0:.6f} s: "
                "must increase",
                on_the_way=True,
            )
        previous_s = time_s
        yield picture


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
