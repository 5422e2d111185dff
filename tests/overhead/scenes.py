"""Rooms with robots in them, from above: small enough to be drawn in no time."""

from __future__ import annotations

import math

import numpy as np

from lobula.overhead import Reference, Room, TopCameraParams, TopView

ROOM = Room(36.0, 28.0)


def drives(frames: int = 12, rate_hz: float = 30.0) -> np.ndarray:
    """Seven robots, (frames, 7, 3): two pass with 0.02 cm between them, two turn in place side by side, three drive."""
    t = (np.arange(frames) - frames / 2) / rate_hz
    poses = np.empty((frames, 7, 3))
    poses[:, 0] = np.column_stack([18 + 9 * t, 0 * t + 14.01, 0 * t])
    poses[:, 1] = np.column_stack([18 - 9 * t, 0 * t + 18.03, 0 * t + math.pi])
    poses[:, 2] = np.column_stack([0 * t + 6, 0 * t + 6.3, 0.3 + math.radians(180) * t])
    poses[:, 3] = np.column_stack([0 * t + 10.05, 0 * t + 6.3, 2.0 - math.radians(225) * t])
    for robot, (x, y, heading, speed) in enumerate(
        ((29.3, 7.1, 2.2, 10), (6.4, 22.7, -1.1, 6), (30.9, 21.2, 0.7, 8)), 4
    ):
        poses[:, robot] = np.column_stack(
            [x + speed * t * math.cos(heading), y + speed * t * math.sin(heading), 0 * t + heading]
        )
    poses[..., 2] = (poses[..., 2] + math.pi) % (2 * math.pi) - math.pi
    return poses


def floor_corners_px(view: TopView, room: Room = ROOM) -> np.ndarray:
    return view.camera.to_px(np.column_stack([room.corners_cm, np.zeros(4)]))


def by_corners(view: TopView, camera: TopCameraParams) -> Reference:
    """The floor's corners as exact pixels, and how high the lens hangs."""
    lens_cm = camera.height_cm * math.cos(math.radians(camera.tilt_deg))
    return Reference(corners_px=floor_corners_px(view), camera_cm=lens_cm if math.isfinite(lens_cm) else None)


def errors(tracks, truth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far the tracks are from the truth, mm and degrees, (frames, robots) each."""
    found = tracks.poses()
    place = 10 * np.hypot(found["x_cm"] - truth[..., 0], found["y_cm"] - truth[..., 1])
    turn = (found["heading_rad"] - truth[..., 2] + math.pi) % (2 * math.pi) - math.pi
    return place, np.degrees(np.abs(turn))
