"""How bright pictures come out: the light of the room, and the automatic gain of each camera."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .world import World

GAIN_RANGE = (0.125, 8.0)
"""Of a camera's automatic gain."""


class Exposure:
    """The factor on all luminance in each robot's picture; the automatic gain follows the pictures it made.

    Attributes
    ----------
    now : (R,) the factor in the last pictures
    """

    def __init__(self, world: World, robots: int) -> None:
        self._light, self._camera = world.light, world.camera
        self._constant = world.light.course == "steady" and not world.camera.auto_gain
        tau_s = world.camera.auto_gain_ms / 1000
        self._share = world.tick_s / (world.tick_s + tau_s)
        self.gains = np.ones(robots)
        self.now = np.ones(robots)

    def at(self, time_s: float) -> NDArray[np.float64]:
        """Return the factor (R,) for pictures taken at ``time_s``."""
        if not self._constant:
            self.now = self.gains * self._light.gain(np.full(len(self.gains), time_s))
        return self.now

    def follow(self, images: NDArray[np.uint8]) -> None:
        """Let each gain go some way towards pictures of mean ``auto_gain_grey``: a first-order filter of its log."""
        if self._camera.auto_gain:
            means = np.maximum(images.mean(axis=(1, 2)), 1.0)
            gains = self.gains * (self._camera.auto_gain_grey / means) ** self._share
            self.gains = gains.clip(*GAIN_RANGE)
