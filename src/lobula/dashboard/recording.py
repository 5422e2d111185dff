"""A recording that is read as often as needed: its working images in memory as far as they fit, its pictures by row."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import FrameSourceError
from ..frames.source import Decoded, FrameSource
from ..types import Frame

BLOCK = 64
"""Frames read, and run through the network, in one go."""

MEMORY_BYTES = 256 << 20
"""Working images kept; of a longer recording the rest is decoded again when it is needed."""

_LEAP_S = 2.0  # further ahead than this, opening the file anew at that time is quicker than decoding all between

OpenAt = Callable[[float], FrameSource]
"""Opens the recording at a time, s."""


class Block(NamedTuple):
    """Frames in a row: the number of the first, images (n, H, W), stamps and frame numbers (n,)."""

    first: int
    images: NDArray[Any]
    times_s: NDArray[np.float64]
    frames: NDArray[np.int64]


class Recording:
    """The frames of ``source`` by row, 0 for the first that is wanted. Read on by one thread only, see ``block``.

    ``problem`` says why it ended before its end, ``complete`` whether all of it has been read.
    """

    def __init__(self, source: FrameSource, open_at: OpenAt, memory_bytes: int = MEMORY_BYTES) -> None:
        self.source = source
        self.open_at = open_at
        self.problem: str | None = None
        self.complete = False
        self._memory_left = memory_bytes
        self._blocks: list[Block] = []
        self._again = Cursor(self)

    def __len__(self) -> int:
        """Rows read so far."""
        return self._blocks[-1].first + len(self._blocks[-1].times_s) if self._blocks else 0

    def block(self, number: int) -> Block | None:
        """Return block ``number``, reading on as far as needed; None after the last.

        Raises
        ------
        FrameSourceError : the recording holds no frame that can be read
        """
        while number >= len(self._blocks) and not self.complete:
            block = self._read_block()
            if block is None:
                break
            self._blocks.append(self._fitting(block))
            if number == block.first // BLOCK:
                return block
        return self._again.block(number) if number < len(self._blocks) else None

    def kept(self, number: int) -> Block:
        """Return block ``number`` of those read so far as it was kept: without images where there was no room."""
        return self._blocks[number]

    def stamp(self, row: int) -> tuple[float, int]:
        """Return time and frame number of ``row``."""
        block = self._blocks[row // BLOCK]
        return float(block.times_s[row - block.first]), int(block.frames[row - block.first])

    def close(self) -> None:
        """Let go of the files."""
        self.source.close()
        self._again.close()

    def _read_block(self) -> Block | None:
        frames: list[Frame] = []
        try:
            while len(frames) < BLOCK and (frame := next(self.source, None)) is not None:
                frames.append(frame)
        except FrameSourceError as error:
            if not frames and not self._blocks:
                raise
            self.problem = str(error)
        if len(frames) < BLOCK:
            self.complete = True
            self.source.close()
        if not frames:
            return None
        return Block(
            len(self),
            np.stack([frame.image for frame in frames]),
            np.array([frame.time_s for frame in frames]),
            np.array([frame.index for frame in frames]),
        )

    def _fitting(self, block: Block) -> Block:
        """The block, without its images where they no longer fit."""
        if block.images.nbytes > self._memory_left:
            self._memory_left = 0
            return block._replace(images=block.images[:0])
        self._memory_left -= block.images.nbytes
        return block


class Cursor:
    """Goes to any row of a recording and reads on from there; one for each thread that reads."""

    def __init__(self, recording: Recording) -> None:
        self._recording = recording
        self._source: FrameSource | None = None
        self._index, self._time_s = -1, 0.0
        self._frame: Frame | None = None
        self._block: Block | None = None

    def block(self, number: int) -> Block:
        """Return block ``number`` with its images; the last one is kept at hand. Raises as ``frame``."""
        block = self._recording.kept(number)
        if len(block.images):
            return block
        if self._block is None or self._block.first != block.first:
            images = [self.frame(block.first + i).image for i in range(len(block.times_s))]
            self._block = block._replace(images=np.stack(images))
        return self._block

    def frame(self, row: int) -> Frame:
        """Return the frame of ``row``.

        Raises
        ------
        FrameSourceError : it can no longer be read
        """
        time_s, index = self._recording.stamp(row)
        if self._frame is not None and self._frame.index == index:
            return self._frame
        if self._source is None or not (self._index < index and time_s - self._time_s < _LEAP_S):
            self.close()
            self._source = self._recording.open_at(max(0.0, time_s - 1e-6))  # stamps are sums of rounded numbers
        for frame in self._source:
            self._index, self._time_s = frame.index, frame.time_s
            if frame.index >= index:
                self._frame = frame
                return frame
        raise FrameSourceError(f"{self._recording.source.name}: frame {index} can no longer be read", on_the_way=True)

    def decoded(self, row: int) -> Decoded:
        """Return the whole picture of ``row``. Raises as ``frame``."""
        self.frame(row)
        assert self._source is not None
        return self._source.decoded()

    def close(self) -> None:
        """Let go of the file."""
        if self._source is not None:
            self._source.close()
        self._source = self._frame = None
