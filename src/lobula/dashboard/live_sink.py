"""The output of the live loop that fills the board: every row, and the newest moment as often as a page shows it."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

from ..frames.source import FrameSource
from ..runtime.sinks import Picture
from ..types import Image, Reading
from .board import Board
from .darkroom import Darkroom, Shot
from .tunable_network import TunableNetwork

SHOTS_HZ = 40.0
"""A page is shown no more moments a second than this; every row of a faster camera is in its traces all the same."""

_HOLD_S = 0.07  # a frame that did not move the network on has empty maps: the ones before stay that long, two ticks
_TELL_S = 0.25  # figures that nobody could read faster


class LiveSink:
    """Hands over to the board what the detector says; nothing here waits for a viewer.

    Parameters
    ----------
    source : whose pictures are shown and whose drops are told
    network : the one that is run: says why it did or did not alarm, and how long it takes
    """

    def __init__(self, board: Board, source: FrameSource, network: TunableNetwork) -> None:
        self._board = board
        self._source = source
        self._network = network
        self._darkroom = Darkroom((source.width, source.height), board.show, lambda text: board.tell(problem=text))
        self._shown_s = self._told_s = 0.0
        self._maps: Mapping[str, Image] = {}
        self._maps_s = 0.0

    def open(self, header: Mapping[str, Any]) -> None:
        """Start the darkroom."""
        self._darkroom.__enter__()

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Add a row; if somebody watches and it is time, hand the moment to the darkroom."""
        board = self._board
        board.rows.append(index, reading)
        if not board.watched:
            return
        now_s = time.monotonic()
        if reading.taps:
            self._keep_maps(reading, now_s)
        if now_s - self._shown_s < 1.0 / SHOTS_HZ:
            return
        self._shown_s = now_s
        maps = self._maps if reading.taps else {}
        why = self._network.why(reading.time_s)
        self._darkroom.hand(Shot(reading.time_s, self._source.decoded(), maps, why))
        board.tell(state=reading.state)
        if now_s - self._told_s >= _TELL_S:
            self._told_s = now_s
            board.tell(
                dropped=self._source.dropped, damaged=self._source.damaged, work=self._network.work.told(),
                latency=self._network.latency.told(),
            )  # fmt: skip

    def event(self, record: Mapping[str, Any]) -> None:
        """Add an event; a state also becomes the status, since a silent camera gives no rows."""
        self._board.add_event(record)
        if record["type"] == "state":
            self._board.tell(state=record["state"] if record["phase"] == "start" else "ok")

    def close(self, summary: Mapping[str, Any]) -> None:
        """Say how the run ended, and stop the darkroom."""
        self._board.tell(ended={"status": summary["status"], "problems": list(summary.get("problems", ()))})
        self._darkroom.__exit__()

    def _keep_maps(self, reading: Reading, now_s: float) -> None:
        if any(image.any() for image in reading.taps.values()) or now_s - self._maps_s > _HOLD_S:
            self._maps, self._maps_s = reading.taps, now_s
