"""What ties the picture to the room: its corners, corner markers, known points, or a scale."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from .calibration import Calibration, from_corners, from_points, from_scale
from .lens import Lens
from .markers import MarkerParams, require_ids
from .room import Room


@dataclass(frozen=True, kw_only=True)
class Reference:
    """One of the first four, and the heights at play.

    ``corners_px`` (4, 2): where the room's corners are seen, the one at the origin first, then along x and round.
    ``corner_ids``: four ID patterns whose middles lie on these corners, in that order; they are looked for.
    ``points``: pixels (n, 2) and cm (n, 2) of known points; from eight on the lens is fitted too.
    ``px_per_cm``: the camera looks straight down from far away, the room's middle in the picture's.
    ``plane_cm``: height of all these over the floor; if left out that of the robots' patterns for ``corner_ids`` and
    ``px_per_cm``, else the floor. ``camera_cm``: height of the lens over the floor.

    Raises
    ------
    ParameterError : not exactly one of the first four, or a value out of its range
    """

    corners_px: NDArray[Any] | Sequence[Sequence[float]] | None = None
    corner_ids: Sequence[int] | None = None
    points: tuple[NDArray[Any], NDArray[Any]] | None = None
    px_per_cm: float | None = None
    plane_cm: float | None = None
    camera_cm: float | None = None

    def __post_init__(self) -> None:
        names = ("corners_px", "corner_ids", "points", "px_per_cm")
        if sum(getattr(self, name) is not None for name in names) != 1:
            raise ParameterError("reference: exactly one must be given of " + ", ".join(names))
        if self.corners_px is not None and np.shape(self.corners_px) != (4, 2):
            raise ParameterError(f"corners_px: shape {np.shape(self.corners_px)}: must be (4, 2), column and row")
        if self.corner_ids is not None and len(require_ids(list(self.corner_ids), "corner_ids")) != 4:
            raise ParameterError(f"corner_ids = {list(self.corner_ids)}: must be four, one for each corner")
        _require_between("px_per_cm", self.px_per_cm, 1.0, 1000.0)
        _require_between("plane_cm", self.plane_cm, 0.0, 1000.0)
        _require_between("camera_cm", self.camera_cm, 10.0, 10000.0)

    def calibration(
        self, room: Room, lens: Lens, marker: MarkerParams, detections: NDArray[np.void] | None = None
    ) -> Calibration:
        """Return the calibration for the plane of the robots' patterns.

        Parameters
        ----------
        detections : what was found in the whole recording, where ``corner_ids`` are given

        Raises
        ------
        ParameterError : the reference does not fit the room or the picture, or a corner's pattern was not found
        """
        base = self.ground(room, lens, detections)
        by_cm = marker.height_cm - self._plane_cm(marker)
        if by_cm == 0 or self.camera_cm is None:
            return base
        if self.camera_cm <= max(marker.height_cm, self._plane_cm(marker)):
            raise ParameterError(f"camera_cm = {self.camera_cm:g}: must be above the robots and the reference")
        return base.raised(by_cm, self.camera_cm - self._plane_cm(marker))

    def ground(self, room: Room, lens: Lens, detections: NDArray[np.void] | None = None) -> Calibration:
        """Return the calibration of the plane in which the reference lies; see ``calibration``."""
        if self.corners_px is not None:
            return from_corners(room, np.asarray(self.corners_px, np.float64), lens)
        if self.points is not None:
            return from_points(*self.points, lens)
        if self.px_per_cm is not None:
            return from_scale(room, self.px_per_cm, lens)
        return from_corners(room, self._corners_found(detections), lens)

    def notes(self, marker: MarkerParams) -> list[str]:
        """Return lines for the user about what this reference leaves out."""
        by_cm = marker.height_cm - self._plane_cm(marker)
        if by_cm == 0 or self.camera_cm is not None:
            return []
        return [
            f"the robots' patterns lie {abs(by_cm):g} cm {'above' if by_cm > 0 else 'below'} the reference: without "
            "the height of the camera they are taken to be seen from far away"
        ]

    def _plane_cm(self, marker: MarkerParams) -> float:
        if self.plane_cm is not None:
            return self.plane_cm
        return 0.0 if self.corner_ids is None and self.px_per_cm is None else marker.height_cm

    def _corners_found(self, detections: NDArray[np.void] | None) -> NDArray[np.float64]:
        corners = []
        for one in self.corner_ids or ():
            seen = np.empty((0, 4, 2)) if detections is None else detections["corners_px"][detections["id"] == one]
            if not len(seen):
                raise ParameterError(f"corner marker {one}: was found in no frame: must be seen in at least one")
            corners.append(np.median(_middles(seen), axis=0))
        return np.array(corners)


def _middles(squares: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return where the diagonals of (n, 4, 2) squares meet: their middles in perspective as well."""
    start, way = squares[:, 0], squares[:, 2] - squares[:, 0]
    other, other_way = squares[:, 1], squares[:, 3] - squares[:, 1]
    gap = other - start
    share = (gap[:, 0] * other_way[:, 1] - gap[:, 1] * other_way[:, 0]) / (
        way[:, 0] * other_way[:, 1] - way[:, 1] * other_way[:, 0]
    )
    return np.asarray(start + way * share[:, None])


def _require_between(name: str, value: float | None, low: float, high: float) -> None:
    if value is not None and not (math.isfinite(value) and low <= value <= high):
        raise ParameterError(f"{name} = {value:g}: must be in [{low:g}, {high:g}]")
