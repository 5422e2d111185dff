"""The output that fills the board with what a robot decides: rows, events, what its line lost; no pictures."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

from ..runtime.robot import RobotStream
from ..runtime.sinks import Picture
from ..types import Reading
from .board import Board
from .pace import Pace

_TELL_S = 0.25  # figures that nobody could read faster


class RobotSink:
    """Hands over to the board what ``robot`` says; nothing here waits for a viewer."""

    def __init__(self, board: Board, robot: RobotStream) -> None:
        self._board = board
        self._robot = robot
        self._work = Pace()
        self._told_s = 0.0

    def open(self, header: Mapping[str, Any]) -> None:
        """Nothing is to be started."""

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Add a row, and now and then the figures."""
        board, last = self._board, self._robot.last
        board.rows.append(index, reading)
        if last is not None and last.step_s:
            self._work.add(last.step_s)
        board.tell(state=reading.state)
        now_s = time.monotonic()
        if now_s - self._told_s >= _TELL_S:
            self._told_s = now_s
            self._tell_figures()

    def event(self, record: Mapping[str, Any]) -> None:
        """Add an event; what the wheels do is a figure, and no event for the list."""
        if record["type"] == "motor":
            self._board.tell(motor=record["action"])
            return
        self._board.add_event(record)
        if record["type"] == "state":
            self._board.tell(state=record["state"] if record["phase"] == "start" else "ok")
        elif record["type"] == "source" and record["phase"] == "settings":
            self._board.tell(
                problem=f"The robot has other settings now, {record['settings_hash']} of preset {record['preset']}: "
                "the thresholds drawn are those it began with. Serve it again to see the new ones."
            )

    def silence(self, index: int, time_s: float) -> None:
        """Tell the figures: a line may bring damage and no reading."""
        self._tell_figures()

    def close(self, summary: Mapping[str, Any]) -> None:
        """Say how the run ended."""
        self._tell_figures()
        self._board.tell(ended={"status": summary["status"], "problems": list(summary.get("problems", ()))})

    def _tell_figures(self) -> None:
        robot = self._robot
        self._board.tell(dropped=robot.dropped, damaged=robot.damaged, work=self._work.told())
