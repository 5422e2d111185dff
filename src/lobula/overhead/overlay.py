"""One picture of the recording with what was made of it drawn in: whether the corners were right shows at a glance."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .calibration import Calibration
from .markers import MarkerParams
from .opencv import load_opencv
from .room import Room

_ROOM_RGB, _ROBOT_RGB, _WORDS_RGB = (60, 200, 90), (240, 80, 60), (250, 220, 60)
_LINE_PX = 1.3  # half the width of the lines


def overlay(
    image: NDArray[Any], room: Room, ground: Calibration, above: Calibration, poses: NDArray[np.void],
    marker: MarkerParams,
) -> NDArray[np.uint8]:  # fmt: skip
    """Return ``image`` (H, W) as RGB with the outline of the room and the robots at ``poses`` in it.

    Parameters
    ----------
    ground : of the plane in which the room's corners were given
    above : of the plane of the ID patterns
    poses : (R,) with id, x_cm, y_cm, heading_rad: circles of the disc's size, a line from the middle forward
    """
    grey = np.clip(np.rint(image), 0, 255).astype(np.uint8)
    picture = np.repeat(grey[:, :, None], 3, axis=2)
    height, width = grey.shape
    # a pixel belongs to a line if its place in the room is near enough to it: right through any lens
    px = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1).astype(np.float64)
    on_ground, on_discs = ground.to_cm(px), above.to_cm(px)
    picture[np.abs(room.outside_cm(on_ground[..., 0], on_ground[..., 1])) < _LINE_PX * _cm_per_px(on_ground)] = (
        _ROOM_RGB
    )
    near_cm, radius = _LINE_PX * _cm_per_px(on_discs), marker.disc_cm / 2
    middles = []
    for one in poses:
        offset = on_discs - (one["x_cm"], one["y_cm"])
        cosine, sine = np.cos(one["heading_rad"]), np.sin(one["heading_rad"])
        forward = offset @ np.array([cosine, sine])
        away = np.hypot(offset[..., 0], offset[..., 1])
        line = (np.abs(offset @ np.array([-sine, cosine])) < near_cm) & (forward > 0) & (away < 1.5 * radius)
        picture[line | (np.abs(away - radius) < near_cm)] = _ROBOT_RGB
        middles.append(np.unravel_index(int(away.argmin()), away.shape))
    cv2 = load_opencv()
    for (row, column), one in zip(middles, poses, strict=True):
        place = int(column) + round(radius / near_cm), int(row) - round(radius / near_cm)
        cv2.putText(picture, str(one["id"]), place, cv2.FONT_HERSHEY_SIMPLEX, 0.5, _WORDS_RGB, 1, cv2.LINE_AA)
    return picture


def _cm_per_px(cm: NDArray[np.float64]) -> float:
    """Size of a pixel in the picture's middle."""
    row, column = cm.shape[0] // 2, cm.shape[1] // 2
    return float(np.linalg.norm(cm[row, column + 1] - cm[row, column]))
