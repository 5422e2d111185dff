"""A detector written for one camera, set on every robot; what a score by true causes needs comes with it."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from .controller import Bools


class Detector(Protocol):
    """What watches one camera. All it remembers must be numbers, texts, arrays, lists and dictionaries of them."""

    def step(self, image: NDArray[np.uint8], time_s: float, turning: bool) -> Any:
        """Return whether to avoid now, from ``image`` (H, W); ``turning``: it is about to stop or turn anyway."""


class EachRobot:
    """A controller that gives each robot a detector of its own.

        arena.run(controller=arena.EachRobot(MyDetector))

    Its runs can be resumed, and the cause of each avoidance is found by asking the detector again without that cause.

    Parameters
    ----------
    make : called without arguments, makes a detector in its first state; a class will do
    """

    def __init__(self, make: Callable[[], Detector]) -> None:
        self._make = make
        self.name = f"EachRobot {getattr(make, '__name__', 'detector')}"

    def start(self, robots: int, rng: np.random.Generator) -> None:
        """Make a detector for each robot."""
        self._detectors = [self._make() for _ in range(robots)]

    def step(self, images: NDArray[np.uint8], time_s: float, turning: Bools) -> list[Any]:
        """Return whose detector says so."""
        return [
            detector.step(image, time_s, turns)
            for detector, image, turns in zip(self._detectors, images, turning.tolist(), strict=True)
        ]

    def state(self, robot: int) -> dict[str, Any]:
        """Return a copy of everything the robot's detector remembers."""
        return copy.deepcopy(vars(self._detectors[robot]))

    def set_state(self, robot: int, state: Any) -> None:
        """Go on from ``state``."""
        self._detectors[robot] = self._at(state)

    def replay(self, state: Any, images: NDArray[np.uint8], times_s: NDArray[np.float64], turning: Bools) -> Bools:
        """Return what a detector says (T,) to ``images`` (T, H, W), from ``state`` on."""
        detector = self._at(state)
        said = [
            detector.step(image, time_s, turns)
            for image, time_s, turns in zip(images, times_s.tolist(), turning.tolist(), strict=True)
        ]
        return np.array(said, np.bool_)

    def _at(self, state: dict[str, Any]) -> Detector:
        detector = self._make()
        vars(detector).clear()
        vars(detector).update(copy.deepcopy(state))
        return detector
