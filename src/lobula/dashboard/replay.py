"""A recording on the board: analysed once, and again whenever a setting changes, until the program is stopped."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

from numpy.typing import NDArray

from ..model.network import NetworkParams
from .analysis import Analysis, event_records
from .board import Board
from .live_settings import LiveSettings
from .rows import rows_of

_TELL_S = 0.05


class Replay:
    """Fills ``board`` from ``analysis`` with the settings as they are.

    ``on_change`` is called with the settings before and after a change, by the thread that works; ``say`` is told what
    is odd about the recording.
    """

    def __init__(
        self,
        analysis: Analysis,
        settings: LiveSettings,
        board: Board,
        on_change: Callable[[NetworkParams, NetworkParams], None],
        say: Callable[[str], None],
    ) -> None:
        self._analysis = analysis
        self._settings = settings
        self._board = board
        self._on_change = on_change
        self._say = say
        self._read = False
        self._changed = threading.Condition()
        self._told_s = 0.0
        settings.listen(self._notify)

    def work(self) -> None:
        """Analyse, wait for a change, analyse again; ends only by an exception, as of a signal.

        Raises
        ------
        LobulaError : the recording cannot be read, or its yaw file does not cover it
        """
        params = self._settings.params
        while True:
            self.analyse(params)
            with self._changed:
                while self._settings.params is params:
                    self._changed.wait()
            before, params = params, self._settings.params
            self._on_change(before, params)

    def analyse(self, params: NetworkParams) -> None:
        """Run the analysis with ``params`` until its end, or until other settings are wanted. Raises as ``work``."""
        board, recording = self._board, self._analysis.recording
        board.rows.restart()
        board.tell(complete=False)
        trace = self._analysis.run(params, self._put, lambda: self._settings.params is not params)
        if trace is not None:
            board.replace_events(event_records(trace))
            board.tell(complete=True, total=len(recording), problem=recording.problem)
            if not self._read:
                self._read = True
                for text in [*recording.source.notes, recording.problem]:
                    if text:
                        self._say(text)

    def _put(self, first: int, trace: NDArray[Any]) -> None:
        self._board.rows.put(first, rows_of(trace))
        now_s = time.monotonic()
        if now_s - self._told_s > _TELL_S:
            self._told_s = now_s
            recording = self._analysis.recording
            self._board.tell(total=len(recording) if recording.complete else recording.source.frame_count)

    def _notify(self) -> None:
        with self._changed:
            self._changed.notify_all()
