"""Where points of the room lie in an overhead camera's picture.

Pixels are (column, row) with the middle of the upper left pixel at (0, 0), as in OpenCV; y of the room points up in
the picture.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..params import Params, param
from .room import Room

Points = NDArray[np.float64]
"""(..., 2) or (..., 3)."""


@dataclass(frozen=True, kw_only=True)
class TopCameraParams(Params):
    """An overhead camera aimed at the middle of the room; as it stands, an ideal one, infinitely far away."""

    px_per_cm: float = param(11.0, "px/cm", "scale at the middle of the floor", low=2, high=100, source="chosen")
    margin_cm: float = param(3.0, "cm", "room for the walls around the floor", low=0, high=500, source="chosen")
    height_cm: float = param(
        math.inf, "cm", "lens to the middle of the floor; inf: no perspective", low=20, high=math.inf, source="chosen"
    )
    tilt_deg: float = param(0.0, "deg", "angle from straight down", low=0, high=60, source="chosen")
    towards_deg: float = param(
        -90.0, "deg", "side of the room above which a tilted camera hangs", low=-360, high=360, source="chosen"
    )
    lens_k1: float = param(
        0.0, "", "radial distortion r (1 + k1 r^2), r = 1 in the picture's corners; below 0: barrel", low=-0.14,
        high=0.25, source="chosen",
    )  # fmt: skip
    blur_px: float = param(0.0, "px", "blur, standard deviation", low=0, high=10, source="chosen")
    noise_grey: float = param(0.0, "grey", "sensor noise, standard deviation", low=0, high=100, source="chosen")


class TopCamera:
    """The geometry of one camera over one room: ``width`` x ``height`` px, both even.

    ``foot_cm`` is the point of the floor below the lens.
    """

    def __init__(self, room: Room, params: TopCameraParams) -> None:
        p = params
        self.width = 2 * math.ceil((room.width_cm + 2 * p.margin_cm) * p.px_per_cm / 2)
        self.height = 2 * math.ceil((room.depth_cm + 2 * p.margin_cm) * p.px_per_cm / 2)
        self._centre = np.array([(self.width - 1) / 2, (self.height - 1) / 2])
        self._half_diagonal = math.hypot(self.width, self.height) / 2
        self._k1 = p.lens_k1
        tilt, towards = math.radians(p.tilt_deg), math.radians(p.towards_deg)
        lean = np.array([math.cos(towards), math.sin(towards), 0.0])
        up = np.array([0.0, 0.0, 1.0])
        # the picture's axes in the room: right and down are those of a camera that looks straight down, leant over
        axis = math.cos(tilt) * up + math.sin(tilt) * lean  # from the middle of the floor to the lens
        right, down = (_turned(v, lean, axis) for v in (np.array([1.0, 0.0, 0.0]), np.array([0.0, -1.0, 0.0])))
        near = 0.0 if math.isinf(p.height_cm) else 1.0 / p.height_cm
        turn = np.stack([p.px_per_cm * right, p.px_per_cm * down, -near * axis])
        middle = np.array([room.width_cm / 2, room.depth_cm / 2, 0.0])
        self.foot_cm = middle[:2] if not near else (middle + p.height_cm * axis)[:2]
        # a point X is seen at (a, b) / c, a = s right.(X - middle), b likewise, c = 1 - axis.(X - middle) / height
        self._matrix = np.column_stack([turn, -turn @ middle + np.array([0.0, 0.0, 1.0])])

    def to_px(self, points_cm: Points) -> Points:
        """Return the (..., 2) pixels of points (..., 3) in cm, z upwards from the floor."""
        a = points_cm @ self._matrix[:, :3].T + self._matrix[:, 3]
        return self._centre + self._bent(a[..., :2] / a[..., 2:])

    def on_plane(self, px: Points, z_cm: float) -> Points:
        """Return the (..., 2) points in cm, ``z_cm`` above the floor, that are seen at pixels (..., 2)."""
        m = self._matrix
        back = np.linalg.inv(np.column_stack([m[:, 0], m[:, 1], z_cm * m[:, 2] + m[:, 3]]))
        u, v = np.moveaxis(self._straight(np.asarray(px) - self._centre), -1, 0)
        x, y, w = (row[0] * u + row[1] * v + row[2] for row in back)  # faster than a product for many points
        return np.stack([x / w, y / w], axis=-1)

    def _bent(self, offset: Points) -> Points:
        r2 = np.sum(offset**2, axis=-1, keepdims=True) / self._half_diagonal**2
        return np.asarray(offset * (1 + self._k1 * r2))

    def _straight(self, offset: Points) -> Points:
        """Undo ``_bent``: Newton's method on r (1 + k1 r^2) = given."""
        if not self._k1:
            return offset
        given = np.linalg.norm(offset, axis=-1, keepdims=True) / self._half_diagonal
        r = given.copy()
        for _ in range(12):
            r -= (r * (1 + self._k1 * r * r) - given) / (1 + 3 * self._k1 * r * r)
        return np.asarray(offset * np.divide(r, given, out=np.ones_like(r), where=given > 0))


def _turned(vector: Points, lean: Points, axis: Points) -> Points:
    """Turn ``vector`` as the turn that takes straight up to ``axis`` by way of ``lean`` does."""
    up = np.array([0.0, 0.0, 1.0])
    k = np.cross(up, lean)
    sine, cosine = float(axis @ lean), float(axis @ up)
    return vector * cosine + np.cross(k, vector) * sine + k * (k @ vector) * (1 - cosine)
