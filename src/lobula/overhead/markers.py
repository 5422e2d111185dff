"""ID patterns for robots seen from above: an ArUco marker on a white disc.

The dictionary is OpenCV's 4X4_50: 50 patterns of 4 x 4 cells inside a black border, the coarsest it has and so the one
that is read from the fewest pixels. The first row of a pattern points forward on the robot.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from ..params import Params, param
from .opencv import load_opencv

DICTIONARY = "DICT_4X4_50"
IDS = 50
CELLS = 6
"""Cells along a side, the black border of one cell included."""

PAPER_GREY, INK_GREY = 235.0, 20.0


@dataclass(frozen=True, kw_only=True)
class MarkerParams(Params):
    """Size of the ID patterns and where they are."""

    disc_cm: float = param(4.0, "cm", "diameter of the white disc", low=1, high=100, source="paper Sec. III-A")
    side_share: float = param(
        0.6, "", "side of the black square over the diameter; white stays around its corners", low=0.3, high=0.68,
        source="chosen",
    )  # fmt: skip
    height_cm: float = param(3.0, "cm", "height of the disc over the floor", low=0, high=200, source="paper Sec. III-A")

    @property
    def side_cm(self) -> float:
        """Side of the black square."""
        return self.disc_cm * self.side_share

    @property
    def corners_cm(self) -> NDArray[np.float64]:
        """(4, 2) corners of the square, (forward, left) of the robot: front left, front right, back right, back left.

        That is the order in which a detector gives them.
        """
        return self.side_cm / 2 * np.array([(1, 1), (1, -1), (-1, -1), (-1, 1)], np.float64)


def require_ids(ids: NDArray[np.int64] | list[int] | tuple[int, ...], where: str) -> tuple[int, ...]:
    """Return ``ids`` as plain numbers.

    Raises
    ------
    ParameterError : none, one twice, or one that the dictionary does not have
    """
    plain = tuple(int(one) for one in ids)
    if not plain or len(set(plain)) < len(plain) or not all(0 <= one < IDS for one in plain):
        raise ParameterError(f"{where} = {list(plain)}: must be different numbers in 0..{IDS - 1}")
    return plain


def marker_cells(marker_id: int) -> NDArray[np.bool_]:
    """Return the (6, 6) cells of a pattern, true where black; row 0 points forward, column 0 left.

    Raises
    ------
    ParameterError : an id that the dictionary does not have
    MissingExtraError : OpenCV is not installed
    """
    require_ids([marker_id], "marker id")
    aruco = load_opencv().aruco
    dictionary = aruco.getPredefinedDictionary(getattr(aruco, DICTIONARY))
    return np.asarray(aruco.generateImageMarker(dictionary, marker_id, CELLS) < 128)


def disc_grey(
    cells: NDArray[np.bool_], forward_cm: NDArray[np.float64], left_cm: NDArray[np.float64], marker: MarkerParams
) -> NDArray[np.float64]:
    """Return the grey of a disc at points given in its own frame; NaN where they are not on the disc."""
    cell = marker.side_cm / CELLS
    row = np.floor(CELLS / 2 - forward_cm / cell).astype(np.intp)
    column = np.floor(CELLS / 2 - left_cm / cell).astype(np.intp)
    within = (row >= 0) & (row < CELLS) & (column >= 0) & (column < CELLS)
    black = within & cells[np.clip(row, 0, CELLS - 1), np.clip(column, 0, CELLS - 1)]
    grey = np.where(black, INK_GREY, PAPER_GREY)
    return np.where(np.hypot(forward_cm, left_cm) <= marker.disc_cm / 2, grey, np.nan)
