"""A reader of a live run that may fall asleep: records are handed to it by a courier, and the run does not wait."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

from ..types import Reading
from .courier import PATIENCE_S, Courier
from .sinks import OutputLapseError, Picture, Sink


class Carried:
    """``sink`` behind a courier; ``name`` is what it writes to. Of the frames it gets the first one, without a picture.

    Raises
    ------
    OutputLapseError : with a frame or a silence, once, when records are lost because nobody reads; from ``close`` with
        their number
    OutputError : likewise, and from then on, what ``sink`` raised
    """

    def __init__(self, sink: Sink, name: str, patience_s: float = PATIENCE_S) -> None:
        self._sink = sink
        self._name = name
        self._patience_s = patience_s
        self._courier = Courier(name)
        self._begun = self._told = False

    def open(self, header: Mapping[str, Any]) -> None:
        """Have the sink opened."""
        self._courier.send(partial(self._sink.open, dict(header)))

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Hand on the first frame, and see how the sink fares."""
        if not self._begun:
            self._begun = True
            self._courier.send(partial(self._sink.frame, index, reading, None))
        self._look()

    def event(self, record: Mapping[str, Any]) -> None:
        """Hand on a record."""
        self._courier.send(partial(self._sink.event, dict(record)))

    def silence(self, index: int, time_s: float) -> None:
        """See how the sink fares, though no frame comes."""
        self._look()

    def close(self, summary: Mapping[str, Any]) -> None:
        """Hand on the summary, and wait a moment for all that is left to be taken."""
        self._courier.send(partial(self._sink.close, dict(summary)))
        self._courier.close(self._patience_s)
        if self._courier.error is not None:
            raise self._courier.error
        if self._courier.lost:
            raise OutputLapseError(f"{self._name}: nobody read all of it: {self._courier.lost} lines are lost")

    def _look(self) -> None:
        if self._courier.error is not None:
            raise self._courier.error
        if self._courier.lost and not self._told:
            self._told = True
            raise OutputLapseError(f"{self._name}: nobody reads it as fast as it comes: lines are lost")
