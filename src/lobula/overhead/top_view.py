"""What an overhead camera sees of an arena: floor, walls, obstacles, robots with their ID patterns.

Every pixel is the mean of ``samples`` x ``samples`` points of it, each decided by geometry alone, so that edges lie
where they should to a small fraction of a pixel, in perspective and through a lens as well.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ShapeError
from .camera import Points, TopCamera, TopCameraParams
from .markers import MarkerParams, disc_grey, marker_cells, require_ids
from .opencv import load_opencv
from .room import Room

_FLOOR, _RIM, _AROUND = 60.0, 200.0, 120.0
_STRIPES, _STRIPE_CM = (150.0, 210.0), 0.7
_BODY, _OBSTACLE, _RIM_CM = 45.0, 175.0, 1.0

_Part = tuple[slice, slice]


class TopView:
    """A room under a camera; ``picture`` puts robots into it.

    Parameters
    ----------
    room : the floor's plan
    camera : scale, perspective, lens, blur, noise
    marker : the robots' ID patterns; ``disc_cm`` is the robots' diameter and ``height_cm`` their height
    obstacles_cm : (n, 3) x, y, radius of upright cylinders as high as the wall
    wall_cm : height of the wall
    corner_ids : four ids whose patterns lie, their middles on the room's corners, at the robots' height
    samples : points along each side of a pixel

    Raises
    ------
    ParameterError : ids that are not different numbers of the dictionary
    MissingExtraError : OpenCV is not installed
    """

    def __init__(
        self, room: Room, *, camera: TopCameraParams | None = None, marker: MarkerParams | None = None,
        obstacles_cm: Sequence[Sequence[float]] | NDArray[Any] = (), wall_cm: float = 12.0,
        corner_ids: Sequence[int] | None = None, samples: int = 4,
    ) -> None:  # fmt: skip
        self._params = camera or TopCameraParams()
        self.camera = TopCamera(room, self._params)
        self._room, self._marker, self._wall_cm, self._samples = room, marker or MarkerParams(), wall_cm, samples
        self._obstacles = np.asarray(obstacles_cm, np.float64).reshape(-1, 3)
        self._corners = require_ids(list(corner_ids), "corner_ids") if corner_ids is not None else ()
        self._ground, self._rim = self._lay_ground()
        self._empty = self._mean(self._ground)

    def picture(
        self, poses: NDArray[Any], ids: Sequence[int] | None = None, *, noise_key: int | Sequence[int] = 0
    ) -> NDArray[np.uint8]:
        """Return the (height, width) picture of robots at ``poses`` (R, 3): x cm, y cm, heading rad.

        ``ids`` (R,) are their patterns, 0, 1, 2, ... if left out. The same ``noise_key`` gives the same noise.

        Raises
        ------
        ShapeError : poses of another shape, or not as many ids
        ParameterError : ids that are not different numbers of the dictionary
        """
        poses = np.asarray(poses, np.float64)
        if poses.ndim != 2 or poses.shape[1] != 3:
            raise ShapeError(f"TopView.picture: poses {poses.shape}: must be (R, 3): x cm, y cm, heading rad")
        chosen = require_ids(list(range(len(poses)) if ids is None else ids), "ids") if len(poses) else ()
        if len(chosen) != len(poses):
            raise ShapeError(f"TopView.picture: {len(chosen)} ids for {len(poses)} poses: must be as many")
        fine, parts = self._ground.copy(), []
        marker = self._marker
        cylinders = [(x, y, radius, self._wall_cm, _OBSTACLE) for x, y, radius in self._obstacles]
        if math.isfinite(self._params.height_cm):  # from infinitely far away the discs hide the robots' sides
            cylinders += [(x, y, marker.disc_cm / 2, marker.height_cm, _BODY) for x, y in poses[:, :2]]
        foot_x, foot_y = self.camera.foot_cm
        for one in sorted(cylinders, key=lambda c: -np.hypot(c[0] - foot_x, c[1] - foot_y)):  # far ones are covered
            parts.append(self._paint_cylinder(fine, *one))
        for (x, y, heading), number in zip(poses, chosen, strict=True):
            parts.append(self._paint_disc(fine, x, y, heading, number))
        for part in parts:
            fine[part] = np.where(self._rim[part], self._ground[part], fine[part])
        for (x, y), number in zip(self._room.corners_cm, self._corners, strict=False):
            parts.append(self._paint_disc(fine, x, y, np.pi / 2, number))
        image = self._empty.copy()
        for rows, columns in parts:
            n = self._samples
            part = slice(rows.start // n, rows.stop // n), slice(columns.start // n, columns.stop // n)
            image[part] = self._mean(fine[rows, columns])
        return self._sensed(image, noise_key)

    def _sensed(self, image: NDArray[np.float32], noise_key: int | Sequence[int]) -> NDArray[np.uint8]:
        p = self._params
        if p.blur_px:
            image = load_opencv().GaussianBlur(image, (0, 0), p.blur_px)
        if p.noise_grey:
            noise = np.random.default_rng(noise_key).standard_normal(image.shape, np.float32)
            image = image + np.float32(p.noise_grey) * noise
        return np.clip(np.rint(image), 0, 255).astype(np.uint8)

    def _mean(self, fine: NDArray[np.float32]) -> NDArray[np.float32]:
        n = self._samples
        parts = [fine[row::n, column::n] for row in range(n) for column in range(n)]
        return np.asarray(sum(parts[1:], parts[0]) / np.float32(n * n))

    def _samples_of(self, part: _Part) -> Points:
        """(h, w, 2) sample points of the pixels ``part``, px."""
        n = self._samples
        rows, columns = ((np.arange(s.start * n, s.stop * n) + 0.5) / n - 0.5 for s in part)
        return np.stack(np.meshgrid(columns, rows), axis=-1)

    def _fine(self, part: _Part) -> _Part:
        n = self._samples
        return slice(part[0].start * n, part[0].stop * n), slice(part[1].start * n, part[1].stop * n)

    def _lay_ground(self) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
        """Grey of every sample of the room without robots and obstacles, and whether it shows the wall's upper rim."""
        n, height, width = self._samples, self.camera.height, self.camera.width
        edges = np.stack(np.meshgrid(np.arange(width + 1) - 0.5, np.arange(height + 1) - 0.5), axis=-1)
        grey, rim = self._ground_at(edges)
        first = grey[:-1, :-1], rim[:-1, :-1]
        # nothing on the ground is smaller than a pixel: one whose corners agree is all alike
        mixed = np.zeros((height, width), np.bool_)
        for other, reference in zip((grey, rim), first, strict=True):
            mixed |= (other[1:, :-1] != reference) | (other[:-1, 1:] != reference) | (other[1:, 1:] != reference)
        rows, columns = np.nonzero(mixed)
        within = (np.arange(n) + 0.5) / n - 0.5
        points = np.empty((len(rows), n, n, 2))
        points[..., 0], points[..., 1] = columns[:, None, None] + within, (rows[:, None] + within)[..., None]
        fine = []
        for plain, sampled in zip(first, self._ground_at(points), strict=True):
            blocks = np.broadcast_to(plain[:, None, :, None], (height, n, width, n)).copy()
            blocks.transpose(0, 2, 1, 3)[rows, columns] = sampled
            fine.append(blocks.reshape(height * n, width * n))
        return fine[0].astype(np.float32), fine[1].astype(np.bool_)

    def _ground_at(self, px: Points) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        x, y = np.moveaxis(self.camera.on_plane(px, 0.0), -1, 0)
        over = self._room.outside_cm(*np.moveaxis(self.camera.on_plane(px, self._wall_cm), -1, 0))
        stripe = np.floor(self._room.along_cm(x, y) / _STRIPE_CM).astype(np.int64) % 2
        grey = np.where(self._room.outside_cm(x, y) <= 0, _FLOOR, np.where(stripe == 0, *_STRIPES))
        grey = np.where(over > 0, np.where(over <= _RIM_CM, _RIM, _AROUND), grey)
        return grey, over > 0

    def _paint_cylinder(
        self, fine: NDArray[np.float32], x: float, y: float, radius: float, height: float, grey: float
    ) -> _Part:
        part = self._around(x, y, radius, (0.0, height))
        px = self._samples_of(part)
        foot, top = self.camera.on_plane(px, 0.0) - (x, y), self.camera.on_plane(px, height) - (x, y)
        # a ray meets the cylinder where its way from the top's plane to the floor passes within the radius
        way = top - foot
        length2 = np.sum(way * way, axis=-1)
        share = -np.sum(foot * way, axis=-1) / np.where(length2 > 0, length2, 1)
        nearest = foot + np.clip(share, 0, 1)[..., None] * way
        there = self._fine(part)
        fine[there] = np.where(np.sum(nearest**2, axis=-1) <= radius**2, grey, fine[there])
        return there

    def _paint_disc(self, fine: NDArray[np.float32], x: float, y: float, heading: float, number: int) -> _Part:
        marker = self._marker
        part = self._around(x, y, marker.disc_cm / 2, (marker.height_cm,))
        offset = self.camera.on_plane(self._samples_of(part), marker.height_cm) - (x, y)
        forward = offset @ np.array([np.cos(heading), np.sin(heading)])
        left = offset @ np.array([-np.sin(heading), np.cos(heading)])
        grey = disc_grey(marker_cells(number), forward, left, marker)
        there = self._fine(part)
        fine[there] = np.where(np.isnan(grey), fine[there], grey)
        return there

    def _around(self, x: float, y: float, radius: float, heights: tuple[float, ...]) -> _Part:
        """The pixels in which a disc of this radius at these heights can be seen."""
        angle = np.linspace(0, 2 * np.pi, 33)
        ring = np.stack([x + 1.1 * radius * np.cos(angle), y + 1.1 * radius * np.sin(angle)], axis=-1)
        px = np.concatenate([self.camera.to_px(np.insert(ring, 2, z, axis=1)) for z in heights])
        low = np.floor(px.min(axis=0)).astype(int)
        high = np.ceil(px.max(axis=0)).astype(int) + 1
        columns, rows = (
            slice(*np.clip((first, last), 0, size).tolist())
            for first, last, size in zip(low, high, (self.camera.width, self.camera.height), strict=True)
        )
        return rows, columns
