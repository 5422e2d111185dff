"""The plan of a room as seen from above: a box or a circle, in cm from its lower left corner."""

from __future__ import annotations

import math
import re
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError

_LEAST_CM, _MOST_CM = 8.0, 4000.0


class Room(NamedTuple):
    """The floor: ``width_cm`` along x, ``depth_cm`` along y; for a circle both are its diameter."""

    width_cm: float = 70.0
    depth_cm: float = 55.0
    shape: Literal["box", "circle"] = "box"

    def __str__(self) -> str:
        return f"{self.width_cm:g}x{self.depth_cm:g}" if self.shape == "box" else f"circle:{self.width_cm / 2:g}"

    @property
    def corners_cm(self) -> NDArray[np.float64]:
        """(4, 2) corners of the room, or of the square around a circle: from the origin along x, then round."""
        w, d = self.width_cm, self.depth_cm
        return np.array([(0, 0), (w, 0), (w, d), (0, d)], np.float64)

    def outside_cm(self, x_cm: NDArray[np.float64], y_cm: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return how far beyond the wall points lie; negative inside, where it is the distance to the nearest wall."""
        w, d = self.width_cm, self.depth_cm
        if self.shape == "circle":
            return np.asarray(np.hypot(x_cm - w / 2, y_cm - d / 2) - w / 2)
        return np.maximum(np.maximum(-x_cm, x_cm - w), np.maximum(-y_cm, y_cm - d))

    def along_cm(self, x_cm: NDArray[np.float64], y_cm: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return where along the wall the point nearest to each point lies, counter-clockwise from the origin."""
        w, d = self.width_cm, self.depth_cm
        if self.shape == "circle":
            return np.asarray(np.arctan2(y_cm - d / 2, x_cm - w / 2) % (2 * math.pi) * w / 2)
        gaps = np.stack([y_cm, w - x_cm, d - y_cm, x_cm])
        sides = np.stack([x_cm, w + y_cm, 2 * w + d - x_cm, 2 * w + 2 * d - y_cm])
        return np.asarray(np.take_along_axis(sides, gaps.argmin(axis=0)[None], axis=0)[0])


def parse_room(text: str) -> Room:
    """Return the room of ``70x55`` (width x depth, cm) or ``circle:35`` (radius, cm).

    Raises
    ------
    ParameterError : another form, or a side outside 8..4000 cm
    """
    number = r"(\d+(?:\.\d+)?)"
    box = re.fullmatch(rf"\s*{number}\s*[xX]\s*{number}\s*(?:cm)?", text)
    circle = re.fullmatch(rf"\s*circle:\s*{number}\s*(?:cm)?", text)
    if box:
        room = Room(float(box[1]), float(box[2]))
    elif circle:
        room = Room(2 * float(circle[1]), 2 * float(circle[1]), "circle")
    else:
        raise ParameterError(f"room {text!r}: must be WIDTHxDEPTH or circle:RADIUS in cm, such as 70x55 or circle:35")
    if not all(_LEAST_CM <= side <= _MOST_CM for side in room[:2]):
        raise ParameterError(f"room {text!r}: its sides must be {_LEAST_CM:g} to {_MOST_CM:g} cm long")
    return room
