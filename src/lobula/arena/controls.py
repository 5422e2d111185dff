"""Controllers that do not look: what a success rate is worth shows beside theirs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..params import Params, param
from .controller import Bools


class NeverTurn:
    """Drives on until it touches something."""

    def start(self, robots: int, rng: np.random.Generator) -> None:
        """Needs nothing."""

    def step(self, images: NDArray[np.uint8], time_s: float, turning: Bools) -> Bools:
        """Return no for every robot."""
        return np.zeros(len(turning), np.bool_)

    def state(self, robot: int) -> None:
        """Return nothing: it remembers nothing."""

    def set_state(self, robot: int, state: Any) -> None:
        """Do nothing."""

    def replay(self, state: Any, images: NDArray[np.uint8], times_s: NDArray[np.float64], turning: Bools) -> Bools:
        """Return no for every picture."""
        return np.zeros(len(times_s), np.bool_)


class AlwaysTurn(NeverTurn):
    """Turns as soon as it may, whatever it sees."""

    def step(self, images: NDArray[np.uint8], time_s: float, turning: Bools) -> Bools:
        """Return yes for every robot."""
        return np.ones(len(turning), np.bool_)

    def replay(self, state: Any, images: NDArray[np.uint8], times_s: NDArray[np.float64], turning: Bools) -> Bools:
        """Return yes for every picture."""
        return np.ones(len(times_s), np.bool_)


@dataclass(frozen=True, kw_only=True)
class RandomTurnParams(Params):
    """The setting of ``RandomTurn``."""

    rate_per_min: float = param(10.0, "1/min", "turns in a minute of driving", low=0, high=1e6, source="chosen")


class RandomTurn:
    """Turns by chance, ``rate_per_min`` times in a minute of driving on average (times at which it turns do not count).

    Each robot has its own chance, which goes on while it turns.

    Raises
    ------
    ParameterError : a rate that is no number, below 0 or above a million
    """

    def __init__(self, rate_per_min: float) -> None:
        self.params = RandomTurnParams(rate_per_min=rate_per_min)

    def start(self, robots: int, rng: np.random.Generator) -> None:
        """Give each robot its own chance."""
        self._own = rng.spawn(robots)
        self._last_s: list[float | None] = [None] * robots

    def step(self, images: NDArray[np.uint8], time_s: float, turning: Bools) -> Bools:
        """Return who turns, by chance."""
        draws = np.array([rng.random() for rng in self._own])
        rates = np.array([self._chance(last_s, time_s) for last_s in self._last_s])
        self._last_s = [time_s] * len(turning)
        return np.asarray(draws < rates, np.bool_)

    def state(self, robot: int) -> dict[str, Any]:
        """Return where the robot's chance stands."""
        return {"chance": self._own[robot].bit_generator.state, "last_s": self._last_s[robot]}

    def set_state(self, robot: int, state: Any) -> None:
        """Go on from ``state``."""
        self._own[robot].bit_generator.state = state["chance"]
        self._last_s[robot] = state["last_s"]

    def replay(self, state: Any, images: NDArray[np.uint8], times_s: NDArray[np.float64], turning: Bools) -> Bools:
        """Return what its chance says again: the same whatever the pictures show."""
        rng, last_s = np.random.default_rng(), state["last_s"]
        rng.bit_generator.state = state["chance"]
        said = np.zeros(len(times_s), np.bool_)
        for t, time_s in enumerate(times_s.tolist()):
            said[t] = rng.random() < self._chance(last_s, time_s)
            last_s = time_s
        return said

    def _chance(self, last_s: float | None, time_s: float) -> float:
        """Return the chance of a turn in the time since the last picture."""
        return 0.0 if last_s is None else -math.expm1(-self.params.rate_per_min * (time_s - last_s) / 60)
