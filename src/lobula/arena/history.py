"""The last seconds of a run: what every robot saw, kept so that it can be rendered and judged again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


class Past(NamedTuple):
    """What one robot saw up to its last frame, oldest first; T frames, R robots.

    ``state`` is the controller's from before the first of these frames, None where it keeps none. ``poses`` are those
    the eye rendered: x, y in cm and heading in rad. ``turning`` is what the controllers were told. ``keys`` and
    ``light`` belong to this robot's frames; ``potentials`` of the four neurons, in the order of ``NEURONS``, are None
    where the controller has none. ``velocities_cm_s`` are those at the last frame, 0 for robots that stop or turn.
    """

    state: Any
    times_s: NDArray[np.float64]  # (T,)
    poses: NDArray[np.float64]  # (T, R, 3)
    turning: NDArray[np.bool_]  # (T, R)
    keys: NDArray[np.uint64]  # (T,)
    light: NDArray[np.float64]  # (T,)
    velocities_cm_s: NDArray[np.float64]  # (R, 2)
    potentials: NDArray[np.float64] | None  # (T, R, 4)
    first_tick: int


class Rows(NamedTuple):
    """Consecutive frames of all robots, oldest first."""

    poses: NDArray[np.float64]  # (T, R, 3)
    phases: NDArray[np.int8]  # (T, R)
    light: NDArray[np.float64]  # (T, R)
    potentials: NDArray[np.float64]  # (T, R, 4), NaN where the controller has none


class History:
    """Poses, phases, light and potentials of the last ``length`` ticks, side by side, and saved controller states.

    Each row is written to an array of twice the length; where its end is reached, the newest rows move to the front.
    """

    def __init__(self, length: int, robots: int) -> None:
        self.length = length
        self._poses = np.zeros((2 * length, robots, 3))
        self._phases = np.zeros((2 * length, robots), np.int8)
        self._light = np.ones((2 * length, robots))
        self._potentials = np.full((2 * length, robots, 4), np.nan)
        self._rows = 0
        self.last_tick = -1
        self.states: list[tuple[int, list[Any]]] = []
        """(tick, the state of each robot before the frame of that tick), oldest first."""

    def add(
        self, tick: int, poses: NDArray[np.float64], phases: NDArray[np.int8], light: NDArray[np.float64],
        potentials: NDArray[np.float64] | None,
    ) -> None:  # fmt: skip
        """Note the frame of ``tick``, the next one after the last."""
        row = self._rows
        if row == 2 * self.length:
            for kept in (self._poses, self._phases, self._light, self._potentials):
                kept[: self.length] = kept[self.length :]
            row = self.length
        self._poses[row] = poses
        self._phases[row] = phases
        self._light[row] = light
        if potentials is not None:
            self._potentials[row] = potentials
        self._rows, self.last_tick = row + 1, tick

    def has_saved(self, tick: int) -> bool:
        """Whether the states of ``tick`` are there."""
        return bool(self.states) and self.states[-1][0] == tick

    def save(self, tick: int, states: list[Any]) -> None:
        """Keep the controllers' ``states`` from before the frame of ``tick``; drop those the rows do not reach."""
        self.states = [(at, kept) for at, kept in self.states if at > tick - self.length]
        self.states.append((tick, states))

    def start_of(self, tick: int) -> tuple[int, list[Any] | None]:
        """Return the newest saved moment at or before ``tick`` and its states, or the oldest there is.

        Without saved states it is ``tick`` itself, or the oldest row.
        """
        oldest = self.last_tick - min(self._rows, self.length) + 1
        kept = [(at, states) for at, states in self.states if at >= oldest]
        if not kept:
            return max(tick, oldest), None
        return next((moment for moment in reversed(kept) if moment[0] <= tick), kept[0])

    def last(self) -> Rows:
        """Return the last frame alone, (R, ...); good until the next one comes."""
        row = self._rows - 1
        return Rows(self._poses[row], self._phases[row], self._light[row], self._potentials[row])

    def since(self, tick: int) -> Rows:
        """Return a copy of the frames from ``tick`` to the last."""
        rows = slice(self._rows - (self.last_tick - tick + 1), self._rows)
        return Rows(
            self._poses[rows].copy(),
            self._phases[rows].copy(),
            self._light[rows].copy(),
            self._potentials[rows].copy(),
        )

    def state(self) -> dict[str, Any]:
        """Return a copy of everything kept; the controllers' states are shared, they never change."""
        rows = self.since(self.last_tick - min(self._rows, self.length) + 1)
        states = [[tick, list(kept)] for tick, kept in self.states]
        return {**rows._asdict(), "last_tick": self.last_tick, "states": states}

    def set_state(self, state: Mapping[str, Any]) -> None:
        """Continue from ``state``, which ``state()`` gave."""
        rows = self._rows = len(state["poses"])
        self._poses[:rows], self._phases[:rows] = state["poses"], state["phases"]
        self._light[:rows], self._potentials[:rows] = state["light"], state["potentials"]
        self.last_tick = int(state["last_tick"])
        self.states = [(int(tick), list(kept)) for tick, kept in state["states"]]
