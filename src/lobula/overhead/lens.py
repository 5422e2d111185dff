"""What a lens does to a picture: straight lines bend, more so far from the middle; here it is undone."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Lens(NamedTuple):
    """Takes pixels to where a lens without distortion would show them: r -> r (1 + a r^2 + b r^4).

    r is the distance from the picture's middle, 1 in its corners. ``Lens(width, height)`` leaves all as it is.
    """

    width: int
    height: int
    a: float = 0.0
    b: float = 0.0

    @property
    def middle_px(self) -> NDArray[np.float64]:
        """(2,) column, row of the picture's middle."""
        return np.array([(self.width - 1) / 2, (self.height - 1) / 2])

    def straight(self, px: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return (..., 2) pixels with the distortion undone, counted from the picture's middle."""
        offset = np.asarray(px, np.float64) - self.middle_px
        r2 = np.sum(offset**2, axis=-1, keepdims=True) / (math.hypot(self.width, self.height) / 2) ** 2
        return np.asarray(offset * (1 + self.a * r2 + self.b * r2 * r2))
