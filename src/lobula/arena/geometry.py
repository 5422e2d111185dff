"""Plane geometry of the arena: closest approach, distances and angles to walls, and what a robot can see.

Positions are (x, y) in cm, headings in rad counter-clockwise from x. A pupil is where the camera sits: ahead of the
robot's centre, looking along its heading.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .world import CameraParams, RoomParams

Floats = NDArray[np.float64]


def wrap_rad(angle: ArrayLike) -> Floats:
    """Return angles in [-pi, pi)."""
    return np.asarray((np.asarray(angle, np.float64) + np.pi) % (2 * np.pi) - np.pi)


def pupils(poses: ArrayLike, ahead_cm: float) -> Floats:
    """Return where the cameras of robots at ``poses`` (..., 3) sit, (..., 2)."""
    p = np.asarray(poses, np.float64)
    return p[..., :2] + ahead_cm * np.stack([np.cos(p[..., 2]), np.sin(p[..., 2])], axis=-1)


def closest_approach(offset_cm: ArrayLike, velocity_cm_s: ArrayLike, horizon_s: float) -> tuple[Floats, Floats]:
    """Return how near two points come within ``horizon_s`` if both keep their velocity, and when.

        t* = clip(-offset . velocity / velocity^2, 0, horizon),  distance = |offset + t* velocity|

    Parameters
    ----------
    offset_cm, velocity_cm_s : (..., 2), position and velocity of one relative to the other

    Returns
    -------
    distance_cm (...), from centre to centre; time_s (...), from now on
    """
    p, v = np.asarray(offset_cm, np.float64), np.asarray(velocity_cm_s, np.float64)
    speed2 = (v * v).sum(axis=-1)
    still = speed2 == 0
    t = np.where(still, 0.0, -(p * v).sum(axis=-1) / np.where(still, 1.0, speed2))
    t = np.clip(t, 0.0, horizon_s)
    return np.linalg.norm(p + t[..., None] * v, axis=-1), t


def wall_ahead_cm(room: RoomParams, point: Sequence[float], heading: float) -> float:
    """Return the distance from ``point`` inside the room to the wall along ``heading``."""
    x, y = point[0], point[1]
    dx, dy = math.cos(heading), math.sin(heading)
    width, depth = room.size_cm
    if room.shape == "circle":
        x, y = x - width / 2, y - depth / 2
        along = x * dx + y * dy
        return math.sqrt(max(along * along + room.radius_cm**2 - x * x - y * y, 0.0)) - along
    to_x = ((width if dx > 0 else 0.0) - x) / dx if dx else math.inf
    to_y = ((depth if dy > 0 else 0.0) - y) / dy if dy else math.inf
    return min(to_x, to_y)


def wall_normals(room: RoomParams, point: Sequence[float]) -> list[float]:
    """Return the headings in which the wall lies square to the line of sight from ``point``: each leads to a foot."""
    if room.shape == "circle":
        return [math.atan2(point[1] - room.radius_cm, point[0] - room.radius_cm)]
    return [0.0, math.pi / 2, math.pi, -math.pi / 2]


def touched_wall_normal(room: RoomParams, point: Sequence[float]) -> float:
    """Return the heading of the shortest way from ``point`` to the wall."""
    return min(wall_normals(room, point), key=lambda heading: wall_ahead_cm(room, point, heading))


def normal_ahead(room: RoomParams, point: Sequence[float], heading: float) -> float:
    """Return the outward normal, as a heading, of the wall that lies ahead of ``point`` along ``heading``."""
    reach = wall_ahead_cm(room, point, heading)
    hit = (point[0] + reach * math.cos(heading), point[1] + reach * math.sin(heading))
    return touched_wall_normal(room, hit)


def incidence_deg(heading: float, normal: float) -> float:
    """Return the angle between a heading and the way to what is met, in [0, 180] deg: 0 is head-on."""
    return math.degrees(abs(float(wrap_rad(heading - normal))))


def nearest_wall_in_view_cm(room: RoomParams, pupil: Sequence[float], heading: float, fov_deg: float) -> float:
    """Return the distance from ``pupil`` to the nearest point of the wall within the field of view.

    That point is a foot of a perpendicular in view, or lies at an edge of the view: between the feet the distance
    only rises towards a corner (or the far side of the circle) and falls again. Bodies are no hindrance: the wall is
    four times their height, so it shows above them.
    """
    half = math.radians(fov_deg) / 2
    feet = [normal for normal in wall_normals(room, pupil) if abs(float(wrap_rad(normal - heading))) <= half]
    return min(wall_ahead_cm(room, pupil, way) for way in (heading - half, heading + half, *feet))


def points_in_view(pupil: ArrayLike, headings: ArrayLike, points: ArrayLike, fov_deg: float) -> NDArray[np.bool_]:
    """Return whether ``points`` (..., 2) lie within the fields of view at ``pupil`` (..., 2), ``headings`` (...)."""
    to = np.asarray(points, np.float64) - np.asarray(pupil, np.float64)
    bearing = wrap_rad(np.arctan2(to[..., 1], to[..., 0]) - np.asarray(headings, np.float64))
    return np.asarray(np.abs(bearing) <= math.radians(fov_deg) / 2 + 1e-12)


def discs_in_view(
    pupil: Floats, headings: Floats, centres: Floats, radii: Floats, heights: Floats, camera: CameraParams
) -> NDArray[np.bool_]:
    """Return which upright cylinders appear in the picture: in one column of pixels at least.

    A column shows a cylinder that its ray meets and that no nearer one hides; the nearer one hides it where its top
    stands at least as high in the picture.

    Parameters
    ----------
    pupil, headings : (T, 2), (T,) for each of T moments
    centres, radii, heights : (T, B, 2), (B,), (B,); none of them the camera's own body

    Returns
    -------
    (T, B)
    """
    to = centres - pupil[:, None]
    bearings = wrap_rad(np.arctan2(to[..., 1], to[..., 0]) - headings[:, None])
    reach = np.arcsin(np.minimum(radii / np.maximum(np.hypot(to[..., 0], to[..., 1]), 1e-9), 1.0))
    within = np.abs(bearings) < math.radians(camera.fov_deg) / 2 + reach
    near = np.flatnonzero(within.any(axis=0))  # most are out of the field of view all the time
    seen = np.zeros(within.shape, np.bool_)
    seen[:, near] = _in_columns(headings, to[:, near], radii[near], heights[near], camera)
    return seen


def _in_columns(
    headings: Floats, to: Floats, radii: Floats, heights: Floats, camera: CameraParams
) -> NDArray[np.bool_]:
    """Return which cylinders at ``to`` (T, B, 2) from the pupil hold a column, by a ray through the middle of each."""
    half = camera.width_px / 2
    columns = np.arctan((np.arange(camera.width_px) + 0.5 - half) / half * math.tan(math.radians(camera.fov_deg) / 2))
    rays = headings[:, None] + columns
    along = to[..., 0, None] * np.cos(rays)[:, None] + to[..., 1, None] * np.sin(rays)[:, None]
    within2 = (radii * radii)[:, None] - (to * to).sum(axis=-1)[..., None] + along * along
    chord = np.sqrt(np.maximum(within2, 0.0))
    met = (within2 >= 0) & (along + chord > 0)
    if len(radii) < 2:
        return np.asarray(met.any(axis=2))
    depth = np.where(met, np.maximum(along - chord, 1e-6), np.inf)
    top = (heights - camera.above_floor_cm)[:, None] / depth
    hidden = (depth[:, None] < depth[:, :, None]) & (top[:, None] >= top[:, :, None])  # (T, hidden, hider, W)
    return np.asarray((met & ~hidden.any(axis=2)).any(axis=2))
