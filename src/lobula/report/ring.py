"""The last seconds of a run, encoded: what a clip of an alarm begins with."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from typing import NamedTuple

from ..types import Reading
from .h264 import Coded

MOST_BYTES = 64 * 2**20
"""The ring holds no more than this, however much changes in the picture. 10 s of pure noise, 640 x 480 at 30 Hz, take
26 MB; of a street, 2 or 3."""


_JITTER_S = 1e-6  # stamps are sums of rounded numbers


class Slot(NamedTuple):
    """One frame: its number in the source, what the network said of it, its picture."""

    number: int
    reading: Reading
    coded: Coded


class Ring:
    """Keeps the frames of the last ``before_s``, and up to a second more: it begins with a key frame."""

    def __init__(self, before_s: float, most_bytes: int = MOST_BYTES) -> None:
        self._before_s = before_s
        self._most_bytes = most_bytes
        self._groups: deque[list[Slot]] = deque()  # each begins with a key frame
        self._bytes = 0
        self._newest_s = self._cut_s = -math.inf

    def __iter__(self) -> Iterator[Slot]:
        for group in self._groups:
            yield from group

    @property
    def cut_short(self) -> bool:
        """True when what is kept is less than was asked for, because it would have been too large."""
        return self._newest_s - self._cut_s <= self._before_s + _JITTER_S

    @property
    def size_bytes(self) -> int:
        """What the encoded pictures take."""
        return self._bytes

    def add(self, slot: Slot) -> None:
        """Take in a frame and let go of what is older than asked for."""
        if slot.coded.key or not self._groups:
            self._groups.append([])
        self._groups[-1].append(slot)
        self._bytes += len(slot.coded.data)
        self._newest_s = slot.reading.time_s
        while len(self._groups) > 1 and self._newest_s - self._oldest_end_s() > self._before_s + _JITTER_S:
            self._drop()
        while len(self._groups) > 1 and self._bytes > self._most_bytes:
            self._cut_s = self._oldest_end_s()
            self._drop()

    def _oldest_end_s(self) -> float:
        return self._groups[0][-1].reading.time_s

    def _drop(self) -> None:
        self._bytes -= sum(len(slot.coded.data) for slot in self._groups.popleft())
