"""ID patterns found in pictures: which, and where their corners are, in pixels."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .edges import refine_corners
from .markers import CELLS, DICTIONARY
from .opencv import load_opencv

DETECTION_DTYPE = np.dtype([("row", np.int64), ("id", np.int32), ("corners_px", np.float64, (4, 2))])
"""One pattern in one picture: ``row`` counts the pictures; corners front left, front right, back right, back left."""


class MarkerFinder:
    """Finds ID patterns in (H, W) pictures.

    Raises
    ------
    MissingExtraError : OpenCV is not installed
    """

    def __init__(self) -> None:
        aruco = load_opencv().aruco
        settings = aruco.DetectorParameters()
        settings.cornerRefinementMethod = aruco.CORNER_REFINE_NONE  # the edges are fitted instead: see docs/track.md
        settings.errorCorrectionRate = 1.0  # one wrong cell is put right: the patterns differ in four at least
        settings.perspectiveRemovePixelPerCell = 8
        settings.perspectiveRemoveIgnoredMarginPerCell = 0.25  # blur mixes neighbouring cells near their borders
        settings.adaptiveThreshConstant = 10
        settings.minMarkerPerimeterRate = 0.02
        self._detector: Any = aruco.ArucoDetector(aruco.getPredefinedDictionary(getattr(aruco, DICTIONARY)), settings)

    def find(self, picture: NDArray[Any], row: int = 0) -> NDArray[np.void]:
        """Return the patterns in ``picture`` (H, W), luminance 0..255, as a ``DETECTION_DTYPE`` table."""
        grey = picture if picture.dtype == np.uint8 else np.rint(picture).astype(np.uint8)
        corners, ids, _ = self._detector.detectMarkers(grey)
        found = np.zeros(0 if ids is None else len(ids), DETECTION_DTYPE)
        if len(found):
            rough = np.concatenate(corners).astype(np.float64)
            sharp = refine_corners(grey, rough, CELLS)
            found["row"], found["id"] = row, np.ravel(ids)
            found["corners_px"] = np.where(np.isnan(sharp), rough, sharp)
        return found
