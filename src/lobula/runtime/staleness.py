"""A live source that gives nothing new: the same picture over and over, as some drivers do when unplugged."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

STALE_S = 1.0
"""Nothing new for longer than this is stale, s."""


class Staleness:
    """Watches the pictures of one live source. Times in seconds, of the frames' own stamps.

    A real sensor is never twice the same to the bit over a second, not even in the dark; noise sees to that.
    """

    def __init__(self) -> None:
        self._image: NDArray[Any] | None = None
        self._new_s = 0.0

    def is_stale(self, image: NDArray[Any], time_s: float) -> bool:
        """Take a frame and say whether the picture has been frozen for longer than ``STALE_S``."""
        if self._image is None or not np.array_equal(image, self._image):
            self._image, self._new_s = image, time_s
            return False
        return time_s - self._new_s > STALE_S
