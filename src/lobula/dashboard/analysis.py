"""What the network says of a whole recording, said anew for other settings, and its maps at any row."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..engine.network import Network
from ..model.network import NetworkParams
from ..model.state import StateDict
from ..runtime.events import EventLog, Record, reading_of
from ..types import TRACE_DTYPE
from .recording import BLOCK, Recording

CHECK_ROWS = 4 * BLOCK
"""Rows between two states of the network that are kept, so that any row can be reached from one of them."""

_CHECK_BYTES = 64 << 20

YawRate = Callable[[float], float]


class Pass:
    """One way through a recording: its settings, and the states of the network kept on the way."""

    def __init__(self, number: int, params: NetworkParams) -> None:
        self.number = number
        self.params = params
        self.rows = 0
        self._every = CHECK_ROWS
        self._checkpoints: list[tuple[int, StateDict]] = []

    def keep(self, row: int, network: Network) -> None:
        """Keep the state before ``row`` if it is time; with too many, every second one goes."""
        if row % self._every:
            return
        snapshot = network.snapshot()
        kept = [*self._checkpoints, (row, snapshot)]
        if len(kept) * sum(np.asarray(part).nbytes for part in snapshot.values()) > _CHECK_BYTES:
            self._every *= 2
            kept = [(at, state) for at, state in kept if at % self._every == 0]
        self._checkpoints = kept  # replaced as a whole: another thread reads it

    def before(self, row: int) -> tuple[int, StateDict]:
        """Return the last state kept at or before ``row``, and its row."""
        kept = self._checkpoints
        return kept[bisect_right(kept, row, key=lambda one: one[0]) - 1]


class Analysis:
    """Runs the network over a recording. One thread runs it, another may look at ``current``.

    ``yaw_rate_deg_s`` gives the rate at which the camera itself turned at a frame's time, s.
    """

    def __init__(self, recording: Recording, *, engine: str = "auto", yaw_rate_deg_s: YawRate | None = None) -> None:
        self.recording = recording
        self.engine = engine
        self.current = Pass(0, NetworkParams())
        self._yaw_rate_deg_s = yaw_rate_deg_s

    def run(
        self, params: NetworkParams, on_rows: Callable[[int, NDArray[Any]], None], stop: Callable[[], bool]
    ) -> NDArray[Any] | None:
        """Run the whole recording with ``params`` and return its trace; None where ``stop()`` said so on the way.

        ``on_rows`` is given each block as it is done: number of its first row, TRACE_DTYPE (n,).
        """
        self.current = now = Pass(self.current.number + 1, params)
        network = Network(params, engine=self.engine)
        pieces: list[NDArray[Any]] = [np.empty(0, TRACE_DTYPE)]
        number = 0
        while not stop():
            block = self.recording.block(number)
            if block is None:
                return np.concatenate(pieces)
            now.keep(block.first, network)
            rows = network.run(block.images, block.times_s, turning=self.turning(block.times_s, params))
            rows["frame"] = block.frames
            now.rows = block.first + len(rows)
            pieces.append(rows)
            on_rows(block.first, rows)
            number += 1
        return None

    def turning(self, times_s: NDArray[np.float64], params: NetworkParams) -> NDArray[np.bool_] | None:
        """Return whether the camera turned too fast at each of the times; None where nobody knows.

        Raises
        ------
        ParameterError : a time the yaw file says nothing of
        """
        if self._yaw_rate_deg_s is None:
            return None
        rates = np.array([self._yaw_rate_deg_s(time_s) for time_s in times_s.tolist()])
        fast: NDArray[np.bool_] = np.abs(rates) > params.decision.turning_deg_s
        return fast


def event_records(trace: NDArray[Any]) -> list[Record]:
    """Return the records of the events of a whole trace, as ``EventLog`` gives them reading by reading.

    Between two changes of alarm or state nothing begins or ends, so only the rows of alarms and changes are read.
    """
    if len(trace) == 0:
        return []
    alarm, state = trace["collision"], trace["state"]
    telling = alarm.copy()
    telling[1:] |= alarm[:-1] | (state[1:] != state[:-1])
    telling[[0, -1]] = True
    log = EventLog()
    records: list[Record] = []
    for row in trace[telling]:
        records += log.step(int(row["frame"]), reading_of(row))
    return records + log.finish()
