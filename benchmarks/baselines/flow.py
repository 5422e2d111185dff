"""Dense optical flow, what a user would take instead: OpenCV's cheapest, DIS at its ultrafast preset."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray


class DisFlow:
    """Flow from each picture to the next; takes pictures as a network does."""

    def __init__(self) -> None:
        self.flow: Any = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_ULTRAFAST)
        self.before: NDArray[np.uint8] | None = None

    def step(self, image: NDArray[np.uint8], time_s: float) -> Any:
        """Return the flow (H, W, 2) from the picture before, px; None at the first one."""
        before, self.before = self.before, image
        return None if before is None else self.flow.calc(before, image, None)
