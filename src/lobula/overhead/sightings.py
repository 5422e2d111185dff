"""Which of the patterns found in a recording are robots: misread ones are left out, a wrong reference is refused."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from ..params import Params, param
from .calibration import Calibration
from .gaps import plausible
from .markers import MarkerParams
from .poses import fit_poses
from .room import Room
from .tracks import TRACK_DTYPE

_SIZE_OFF = 0.2  # all patterns too large or too small by this: the reference or the disc is wrong
_MOST_OUTSIDE = 0.5


@dataclass(frozen=True, kw_only=True)
class TrackParams(Params):
    """What is believed, and how long a robot may be lost."""

    max_gap_s: float = param(0.5, "s", "longest gap between two sightings that is bridged", low=0, high=60,
                             source="chosen")  # fmt: skip
    fastest_cm_s: float = param(100.0, "cm/s", "no robot drives faster: a jump beyond it is a misread pattern", low=1,
                                high=10000, source="chosen: three times Colias's top speed")  # fmt: skip
    size_tolerance: float = param(0.15, "", "how far a pattern's size may be from the median of all, as a share of it",
                                  low=0.01, high=1, source="chosen")  # fmt: skip
    shape_tolerance: float = param(0.06, "", "how far a pattern's corners may be from a square's, over its side",
                                   low=0.001, high=1, source="chosen")  # fmt: skip
    beyond_cm: float = param(2.0, "cm", "how far outside the room a robot's middle may be seen", low=0, high=1000,
                             source="chosen")  # fmt: skip
    least_share: float = param(0.02, "", "an id that is seen in fewer of the frames is a misread pattern", low=0,
                               high=1, source="chosen")  # fmt: skip


class Sightings:
    """What was found, as rows of tracks, TRACK_DTYPE in the order it was found; ``sift`` leaves in what robots can be.

    ``left_out`` counts what was not believed, by the reason.
    """

    def __init__(
        self, found: NDArray[np.void], numbers: NDArray[np.int64], times_s: NDArray[np.float64],
        calibration: Calibration, marker: MarkerParams,
    ) -> None:  # fmt: skip
        poses = fit_poses(calibration.to_cm(found["corners_px"]), marker)
        self.rows = np.zeros(len(found), TRACK_DTYPE)
        self.rows["frame"], self.rows["time_s"] = numbers[found["row"]], times_s[found["row"]]
        self.rows["id"], self.rows["found"] = found["id"], True
        for name in ("x_cm", "y_cm", "heading_rad", "error_cm", "error_rad"):
            self.rows[name] = getattr(poses, name)
        self.left_out: dict[str, int] = {}
        self._scale, self._misfit = poses.scale, poses.misfit
        self._frames = len(numbers)
        self._side_cm = marker.side_cm

    def sift(self, room: Room, params: TrackParams, wanted: tuple[int, ...] | None) -> list[str]:
        """Leave out what no robot can be, and return lines for people about it.

        Raises
        ------
        ParameterError : all patterns come out at a wrong size or shape, or most of them outside the room
        """
        if wanted is not None:
            self._keep(np.isin(self.rows["id"], wanted), "id not asked for")
        words = self._without_rare(params.least_share) if wanted is None else []
        if len(self.rows):
            self._require_fit(room, params)
            self._keep(np.abs(self._scale / np.median(self._scale) - 1) <= params.size_tolerance, "wrong size")
            self._keep(self._misfit <= params.shape_tolerance, "no square")
            self._keep(self._beyond_cm(room) <= params.beyond_cm, "outside the room")
        self._keep(self._best_of_frame(), "seen twice")
        believed = np.ones(len(self.rows), np.bool_)
        for one in np.unique(self.rows["id"]):
            mine = np.flatnonzero(self.rows["id"] == one)
            believed[mine] = plausible(self.rows[mine], params.fastest_cm_s)
        self._keep(believed, "jump")
        missing = np.setdiff1d(wanted or (), self.rows["id"])
        return [*words, *([f"ids never seen: {_list(missing)}"] if len(missing) else [])]

    def _without_rare(self, least_share: float) -> list[str]:
        """Leave out ids that are hardly ever seen: noise is read as a pattern now and then."""
        ids, counts = np.unique(self.rows["id"], return_counts=True)
        rare = ids[counts < least_share * self._frames]
        self._keep(~np.isin(self.rows["id"], rare), "rare id")
        return [f"ids seen in too few frames to be robots: {_list(rare)}"] if len(rare) else []

    def _beyond_cm(self, room: Room) -> NDArray[np.float64]:
        return room.outside_cm(self.rows["x_cm"], self.rows["y_cm"])

    def _keep(self, believed: NDArray[np.bool_], why: str) -> None:
        if count := int(np.count_nonzero(~believed)):
            self.left_out[why] = count
        self.rows, self._scale, self._misfit = self.rows[believed], self._scale[believed], self._misfit[believed]

    def _best_of_frame(self) -> NDArray[np.bool_]:
        """Whether each sighting is the only one of its id in its frame, or the one most like a square."""
        order = np.lexsort((self._misfit, self.rows["id"], self.rows["frame"]))
        ordered = self.rows[order]
        again = (np.diff(ordered["frame"]) == 0) & (np.diff(ordered["id"]) == 0)
        best = np.ones(len(order), np.bool_)
        best[order[1:][again]] = False
        return best

    def _require_fit(self, room: Room, params: TrackParams) -> None:
        check = "check the corners, their order, the room and the disc"
        size = float(np.median(self._scale))
        if abs(size - 1) > _SIZE_OFF:
            raise ParameterError(
                f"the ID patterns ({len(self.rows)} sightings) come out {size * self._side_cm:.2f} cm wide: must be "
                f"{self._side_cm:.2f}: {check}"
            )
        if float(np.median(self._misfit)) > params.shape_tolerance:
            raise ParameterError(f"the ID patterns do not come out square: {check}")
        beyond = self._beyond_cm(room) > params.beyond_cm
        if beyond.mean() > _MOST_OUTSIDE:
            raise ParameterError(
                f"{np.count_nonzero(beyond)} of {len(beyond)} ID patterns lie outside the room: {check}"
            )


def _list(ids: NDArray[Any]) -> str:
    return ", ".join(map(str, ids.tolist()))
