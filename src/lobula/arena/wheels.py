"""Robots whose wheels somebody else commands: no motor queue, no turns of their own."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from .motion import Motion
from .world import World


class WheelMotion(Motion):
    """Places and headings of robots that go where ``command`` sends them; what they touch stops them.

    Attributes
    ----------
    wheels_cm_s : (R, 2), the speeds of each robot's left and right wheel; 0 at the start
    """

    def __init__(
        self, world: World, poses: NDArray[np.float64], own: list[np.random.Generator], noise: np.random.Generator
    ) -> None:
        super().__init__(world, poses, own, noise)
        self.wheels_cm_s = np.zeros((len(poses), 2))
        self._straight = False  # on an arc no two ticks have the same chord

    def command(self, wheels_cm_s: NDArray[np.float64]) -> None:
        """Set the speeds (R, 2) that hold from the coming tick on."""
        self.wheels_cm_s = wheels_cm_s

    def avoid(self, robots: Iterable[int]) -> None:
        """Do nothing: whoever commands the wheels turns the robots too."""

    def _plan(self) -> None:
        speeds = self.wheels_cm_s
        if self._wheels.motor_noise:
            speeds = speeds * (1 + self._wheels.motor_noise * self._noise.standard_normal(speeds.shape))
        for r, (left, right) in enumerate((speeds * self._tick_s).tolist()):
            length, bent = (left + right) / 2, (right - left) / self._wheels.track_cm
            straightness = math.sin(bent / 2) / (bent / 2) if bent else 1.0
            self._chords[r] = cmath.rect(length * straightness, self.headings_rad[r] + bent / 2)
            self._lengths[r] = abs(length)
            self._spins[r] = bent
