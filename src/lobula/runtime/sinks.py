"""What the runtime asks of an output: a few calls, the same for a trace, a video, a page or a hook."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from ..errors import OutputError
from ..types import Reading

Picture = Callable[[], NDArray[np.uint8]]
"""Gives the (h, w, 3) RGB picture a frame was made from; decoded when asked for, so ask only if it is drawn."""


class OutputLapseError(OutputError):
    """Something was not written, but the output goes on with what comes next and is to be called again."""


class Sink(Protocol):
    """An output of a run. The cli makes it, the runtime calls it, and neither knows what it writes.

    The order of calls is ``open``, then ``frame`` and ``event`` as they come, then ``close``. ``close`` is called
    exactly once after ``open`` was tried, also when ``open``, ``frame`` or the source failed, and must leave a
    readable file. Sinks are closed in the order they were given and opened in the opposite one.

    Raises
    ------
    OutputError : from any of the calls, when the file cannot be written; but for ``OutputLapseError`` the sink is only
        closed after that
    """

    def open(self, header: Mapping[str, Any]) -> None:
        """Start. ``header`` is the NDJSON header, with ``thresholds`` (by neuron) and ``settings`` (rows) added."""

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Take one frame's reading; ``picture`` is valid during this call and until the next ``frame``."""

    def event(self, record: Mapping[str, Any]) -> None:
        """Take one state, collision or source record; it may come before or after the ``frame`` it names."""

    def close(self, summary: Mapping[str, Any]) -> None:
        """Finish. ``summary`` is the NDJSON summary record."""


@runtime_checkable
class WakefulSink(Protocol):
    """A sink that has something to do while no frame comes, too."""

    def silence(self, index: int, time_s: float) -> None:
        """No frame has come since frame ``index``, and it is ``time_s`` in the time of the source."""


@runtime_checkable
class NotingSink(Protocol):
    """A sink that has something to say once it is open, and no failure: it is told, one line each."""

    notes: list[str]
