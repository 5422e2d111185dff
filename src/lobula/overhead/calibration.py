"""From pixels of an overhead picture to cm in the room, at the height at which the ID patterns lie.

A flat room and a flat picture are tied by a homography; four corners of the room determine it. Patterns that lie
higher than these corners are seen too far out; with the height of the camera that is put right, see ``raised``.
"""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from .lens import Lens
from .opencv import load_opencv
from .room import Room

_LENS_POINTS = 8
_LEAST_SIDE_PX = 32.0


class Calibration(NamedTuple):
    """``matrix`` (3, 3) takes straightened pixels, counted from the picture's middle, to cm in the room.

    ``error_cm`` is how far the reference points lie from where they should (root mean square), NaN if nobody can tell.
    """

    matrix: NDArray[np.float64]
    lens: Lens
    error_cm: float = math.nan

    def to_cm(self, px: NDArray[Any]) -> NDArray[np.float64]:
        """Return the points (..., 2) of the room that are seen at pixels (..., 2)."""
        return _mapped(self.matrix, self.lens.straight(px))

    def raised(self, by_cm: float, camera_cm: float) -> Calibration:
        """Return the calibration of the plane ``by_cm`` above this one; the lens is ``camera_cm`` above this one.

        What is ``by_cm`` higher is seen where the ray through it meets this plane, farther from the point below the
        lens. Square pixels, and the optical axis in the picture's middle, are taken for granted.

        Raises
        ------
        ParameterError : no camera at that height sees the room so
        """
        to_px = np.linalg.inv(self.matrix / self.matrix[2, 2])  # depth 1 in the picture's middle
        one, two, origin = to_px.T  # = scale * K (r1, r2, t): K the camera, r the room's axes in it
        focal_px = _focal_px(one, two, origin, camera_cm)
        camera = np.array([focal_px, focal_px, 1.0])
        up = np.cross(one / camera, two / camera)  # scale^2 r3
        up = camera * up / math.sqrt(float(np.linalg.norm(up)))
        return self._replace(matrix=np.linalg.inv(np.column_stack([one, two, origin + by_cm * up])))


def from_scale(room: Room, px_per_cm: float, lens: Lens) -> Calibration:
    """Return the calibration of a camera that looks straight down from far away, the room in the picture's middle."""
    s = 1 / px_per_cm
    return Calibration(np.array([(s, 0, room.width_cm / 2), (0, -s, room.depth_cm / 2), (0, 0, 1)]), lens)


def from_corners(room: Room, corners_px: NDArray[Any], lens: Lens) -> Calibration:
    """Return the calibration by the room's corners (4, 2), px: the one at the origin, the next along x, and so round.

    Of a circular room they are the corners of the square around it.

    Raises
    ------
    ParameterError : corners that no picture from above can show in this order
    """
    corners = np.asarray(corners_px, np.float64)
    edges = np.roll(corners, -1, axis=0) - corners
    following = np.roll(edges, -1, axis=0)
    turns = edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0]
    given = ", ".join(f"({x:g}, {y:g})" for x, y in corners)
    order = "(0, 0), then the one along x, then round: counter-clockwise as the picture shows them"
    if not np.isfinite(corners).all() or np.linalg.norm(edges, axis=1).min() < _LEAST_SIDE_PX:
        raise ParameterError(f"corners {given} px: must be the room's four corners, {_LEAST_SIDE_PX:g} px apart")
    if (turns > 0).all():
        raise ParameterError(f"corners {given} px: run clockwise: must be {order}")
    if not (turns < 0).all():
        raise ParameterError(f"corners {given} px: do not make a convex figure: must be {order}")
    return _fitted(lens, corners, room.corners_cm)


def from_points(px: NDArray[Any], cm: NDArray[Any], lens: Lens) -> Calibration:
    """Return the calibration by points seen at ``px`` (n, 2) that lie at ``cm`` (n, 2); from 8 on the lens is fitted.

    Raises
    ------
    ParameterError : fewer than four points, or points in one line
    """
    px, cm = np.asarray(px, np.float64), np.asarray(cm, np.float64)
    if len(px) < 4:
        raise ParameterError(
            f"{len(px)} reference points: must be at least 4, from {_LENS_POINTS} on the lens is fitted"
        )
    spread = [np.linalg.svd(part - part.mean(axis=0), compute_uv=False) for part in (px, cm)]
    if any(least < 0.05 * most or not math.isfinite(most) for most, least in spread):
        raise ParameterError("reference points: lie in one line: must be spread over the room")
    if len(px) < _LENS_POINTS:
        return _fitted(lens, px, cm)
    step = np.array([1e-4, 1e-4])
    for _ in range(20):  # Gauss-Newton in the lens's two numbers, the homography fitted anew for each
        base = _misses(_fitted(lens, px, cm), px, cm)
        slopes = np.stack(
            [
                (_misses(_fitted(lens._replace(a=lens.a + da, b=lens.b + db), px, cm), px, cm) - base) / 1e-4
                for da, db in np.diag(step)
            ],
            axis=1,
        )
        change = np.linalg.lstsq(slopes, -base, rcond=None)[0]
        lens = lens._replace(a=lens.a + float(change[0]), b=lens.b + float(change[1]))
        if np.abs(change).max() < 1e-7:
            break
    return _fitted(lens, px, cm)


def read_points(path: str | Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the pixels (n, 2) and the points in cm (n, 2) of a CSV file with x_px, y_px, x_cm, y_cm.

    Raises
    ------
    ParameterError : it cannot be read, or a column or a number is missing
    """
    columns = ("x_px", "y_px", "x_cm", "y_cm")
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as file:
            rows = [[float(row[name]) for name in columns] for row in csv.DictReader(file)]
    except OSError as error:
        raise ParameterError(f"points {path}: cannot be read: {error.strerror}") from error
    except (KeyError, TypeError, ValueError) as error:
        raise ParameterError(f"points {path}: every row must hold numbers in {', '.join(columns)}") from error
    table = np.array(rows, np.float64).reshape(-1, 4)
    return table[:, :2], table[:, 2:]


def _focal_px(
    one: NDArray[np.float64], two: NDArray[np.float64], origin: NDArray[np.float64], camera_cm: float
) -> float:
    """Return the focal length at which the columns of a homography put the camera ``camera_cm`` above its plane.

    With n = one x two and g = 1 / focal length the height is |n . origin| sqrt(g) / (n1^2 + n2^2 + g^2 n3^2)^(3/4),
    which is a cubic in g^(2/3). Of its roots the largest leans least, by less than 54.7 degrees.
    """
    n = np.cross(one, two)
    tilted, level = float(n[0] ** 2 + n[1] ** 2), float(n[2] ** 2)
    roots = np.roots([level, 0.0, -((abs(float(n @ origin)) / camera_cm) ** (4 / 3)), tilted])
    real = roots.real[(np.abs(roots.imag) < 1e-9 * np.abs(roots)) & (roots.real > 0)]
    if not len(real):
        raise ParameterError(
            f"camera height {camera_cm:g} cm: no camera sees these corners from there: must be its height over the "
            "floor, and the picture must not be cut"
        )
    return float(real.max() ** -1.5)


def _fitted(lens: Lens, px: NDArray[np.float64], cm: NDArray[np.float64]) -> Calibration:
    straight = lens.straight(px)
    matrix = load_opencv().findHomography(straight, cm, 0)[0]
    if matrix is None:
        raise ParameterError("reference points: no flat room looks like this: must be spread over the room")
    if matrix[2, 2] * np.linalg.det(matrix) > 0:
        raise ParameterError("reference points: show the room mirrored: in a picture from above y must run up")
    calibration = Calibration(np.asarray(matrix, np.float64), lens)
    error = math.sqrt(float(np.mean(_misses(calibration, px, cm) ** 2)) * 2) if len(px) > 4 else math.nan
    return calibration._replace(error_cm=error)


def _misses(calibration: Calibration, px: NDArray[np.float64], cm: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray((calibration.to_cm(px) - cm).ravel())


def _mapped(matrix: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    a = points @ matrix[:, :2].T + matrix[:, 2]
    return np.asarray(a[..., :2] / a[..., 2:])
