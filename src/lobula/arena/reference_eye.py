"""The eye by rays: slow, obvious, independent of the C core; the fallback where there is none, and its test.

Every pixel is the mean of a grid of rays. A ray leaves the pupil for a point of the picture, meets the nearest of wall
and cylinders that it does not pass over, and else the floor or what is above.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .scene import Cylinder, Scene
from .world import CameraParams

NEAR_CM = 0.01
"""A pupil nearer to a wall or to a cylinder, or inside it, is taken to be so far off."""

GREY = 128
BYTES_SD = math.sqrt(4 * (256**2 - 1) / 12)
SCALE_BITS = 14

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class _Rays:
    """Rays of a view: ``x``, ``y`` the pupil; ``ways`` (C, 2) level directions, one a column of rays, of unit length;
    ``slopes`` (C, R) how much a ray rises over each cm along its way."""

    x: float
    y: float
    height_cm: float
    ways: Floats
    slopes: Floats


class ReferenceEye:
    """Draws views of one scene through one camera, from ``samples`` (across, down) rays in each pixel."""

    def __init__(self, scene: Scene, camera: CameraParams, *, samples: tuple[int, int] = (8, 8)) -> None:
        self.scene, self.camera, self.samples = scene, camera, samples
        self._obstacles = list(zip(scene.obstacles, scene.obstacle_poses, strict=True))

    def views(
        self, cameras: Floats, bodies: Floats, optional: dict[str, NDArray[Any] | None], out: NDArray[np.uint8]
    ) -> None:
        """Draw into ``out`` (N, H, W); ``arena.eye.Eye.views`` has the arguments, checked there."""
        own, keys, light, walls = (optional[name] for name in ("own", "keys", "light", "walls"))
        for i, camera in enumerate(cameras):
            poses = bodies if bodies.ndim == 2 else bodies[i]
            there, stands = (_there(optional[name], i) for name in ("shown", "obstacles"))
            hidden = -1 if own is None else int(own[i])
            cylinders = [(o, p) for k, (o, p) in enumerate(self._obstacles) if stands(k)]
            cylinders += [(self.scene.body, p) for k, p in enumerate(poses) if there(k) and k != hidden]
            image = self.luminance(camera, cylinders, pattern=walls is None or bool(walls[i]))
            image = blurred(image * (1.0 if light is None else float(light[i])), self.camera.blur_px)
            out[i] = sensed(image, self.camera.noise_grey, None if keys is None else int(keys[i]))

    def luminance(self, camera: Floats, cylinders: list[tuple[Cylinder, Floats]], *, pattern: bool) -> Floats:
        """Return the light that falls on each pixel, (H, W), before gain, blur and noise; ``cylinders`` with poses."""
        height, width = self.camera.height_px, self.camera.width_px
        across, down = self.samples
        rays = self._rays(camera)
        grey = self._room(rays, pattern)
        nearest = np.full(rays.slopes.shape, np.inf)
        for cylinder, pose in cylinders:
            _draw(cylinder, pose, rays, grey, nearest)
        return np.asarray(grey.reshape(width, across, height, down).mean(axis=(1, 3)).T)

    def _rays(self, camera: Floats) -> _Rays:
        c = self.camera
        focal = c.width_px / 2 / math.tan(math.radians(c.fov_deg) / 2)
        across = (np.arange(c.width_px * self.samples[0]) + 0.5) / self.samples[0] - c.width_px / 2
        down = (np.arange(c.height_px * self.samples[1]) + 0.5) / self.samples[1] - c.height_px / 2
        bearings = camera[2] - np.arctan(across / focal)
        x = camera[0] + c.ahead_cm * math.cos(camera[2])
        y = camera[1] + c.ahead_cm * math.sin(camera[2])
        return _Rays(
            *self._kept_inside(x, y),
            height_cm=c.above_floor_cm,
            ways=np.stack([np.cos(bearings), np.sin(bearings)], axis=1),
            slopes=-down / np.hypot(across, focal)[:, None],
        )

    def _kept_inside(self, x: float, y: float) -> tuple[float, float]:
        width, depth = self.scene.size_cm
        if self.scene.shape == "box":
            return min(max(x, NEAR_CM), width - NEAR_CM), min(max(y, NEAR_CM), depth - NEAR_CM)
        radius = width / 2
        off = math.hypot(x - radius, y - radius)
        back = min(1.0, (radius - NEAR_CM) / off) if off else 1.0
        return radius + (x - radius) * back, radius + (y - radius) * back

    def _room(self, rays: _Rays, pattern: bool) -> Floats:
        scene = self.scene
        reach, along = (_box if scene.shape == "box" else _circle)(rays, scene.size_cm)
        if pattern:
            n = len(scene.wall_grey)
            wall = scene.wall_grey[np.minimum((along * n).astype(int), n - 1)]
        else:
            wall = np.full(len(reach), scene.wall_grey.mean())
        hit_cm = rays.height_cm + rays.slopes * reach[:, None]
        grey = np.where(hit_cm > scene.wall_cm, scene.above_grey, wall[:, None])
        return np.where(hit_cm < 0, scene.floor_grey, grey)


def _there(flags: NDArray[Any] | None, view: int) -> Callable[[int], bool]:
    return lambda k: flags is None or bool(flags[view, k])


def _box(rays: _Rays, size_cm: tuple[float, float]) -> tuple[Floats, Floats]:
    """Return how far each column of rays goes to the wall, and where on its way around it arrives, in 0..1."""
    width, depth = size_cm
    dx, dy = rays.ways.T
    with np.errstate(divide="ignore"):
        to_side = np.where(dx > 0, width - rays.x, -rays.x) / np.where(dx == 0, 1e-300, dx)
        to_end = np.where(dy > 0, depth - rays.y, -rays.y) / np.where(dy == 0, 1e-300, dy)
    reach = np.minimum(to_side, to_end)
    x = np.clip(rays.x + reach * dx, 0, width)
    y = np.clip(rays.y + reach * dy, 0, depth)
    on_side = to_side < to_end
    along = np.where(
        on_side, np.where(dx > 0, width + y, 2 * (width + depth) - y), np.where(dy > 0, 2 * width + depth - x, x)
    )
    return reach, along / (2 * (width + depth))


def _circle(rays: _Rays, size_cm: tuple[float, float]) -> tuple[Floats, Floats]:
    """Return the same for a round wall."""
    radius = size_cm[0] / 2
    x, y = rays.x - radius, rays.y - radius
    along = rays.ways @ np.array([x, y])
    reach = -along + np.sqrt(along**2 + radius**2 - x * x - y * y)
    bearing = np.arctan2(y + reach * rays.ways[:, 1], x + reach * rays.ways[:, 0])
    return reach, np.mod(bearing / (2 * np.pi), 1.0)


def _draw(cylinder: Cylinder, pose: Floats, rays: _Rays, grey: Floats, nearest: Floats) -> None:
    """Paint a cylinder over what lies farther away; ``nearest`` keeps how far each ray went."""
    off = np.array([pose[0] - rays.x, pose[1] - rays.y])
    distance = float(np.hypot(*off))
    if distance < cylinder.radius_cm + NEAR_CM:
        straight = np.array([rays.ways[:, 0].sum(), rays.ways[:, 1].sum()])
        back = off / distance if distance else straight / np.hypot(*straight)
        off = back * (cylinder.radius_cm + NEAR_CM)
    along = rays.ways @ off
    beside2 = off @ off - along**2
    met = np.flatnonzero((beside2 < cylinder.radius_cm**2) & (along > 0))
    if len(met) == 0:
        return
    half_chord = np.sqrt(cylinder.radius_cm**2 - beside2[met])
    front, back_side = (along[met] - half_chord)[:, None], (along[met] + half_chord)[:, None]
    slopes = rays.slopes[met]
    at_front, at_back = rays.height_cm + slopes * front, rays.height_cm + slopes * back_side
    side = (at_front >= 0) & (at_front < cylinder.height_cm)
    top = (at_front >= cylinder.height_cm) & (at_back < cylinder.height_cm)
    reach = np.where(side, front, np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = np.where(top, (cylinder.height_cm - rays.height_cm) / slopes, reach)
    seen = (side | top) & (reach < nearest[met])
    hits = rays.ways[met] * front - off
    around = _around(cylinder, np.arctan2(hits[:, 1], hits[:, 0]) - pose[2])
    bands = np.asarray(cylinder.bands_grey)
    k = np.clip((at_front / cylinder.height_cm * len(bands)).astype(int), 0, len(bands) - 1)
    lid = bands.mean() + (np.mean(cylinder.around_grey) if len(cylinder.around_grey) else 0.0)
    colour = np.clip(np.where(top, lid, bands[k] + around[:, None]), 0, 255)
    grey[met] = np.where(seen, colour, grey[met])
    nearest[met] = np.where(seen, reach, nearest[met])


def _around(cylinder: Cylinder, bearings: Floats) -> Floats:
    n = len(cylinder.around_grey)
    if n == 0:
        return np.zeros(len(bearings))
    sector = (np.mod(bearings / (2 * np.pi), 1.0) * n).astype(int)
    return np.asarray(cylinder.around_grey[np.minimum(sector, n - 1)])


def blurred(image: Floats, sd_px: float) -> Floats:
    """Return ``image`` (H, W) under a Gaussian, cut at three standard deviations, its rim repeated outwards."""
    if sd_px == 0:
        return image
    radius = math.ceil(3 * sd_px)
    kernel = np.exp(-0.5 * (np.arange(-radius, radius + 1) / sd_px) ** 2)
    kernel /= kernel.sum()
    for axis in (0, 1):
        wide = np.pad(image, [(radius, radius) if a == axis else (0, 0) for a in (0, 1)], mode="edge")
        parts = [w * np.take(wide, range(k, k + image.shape[axis]), axis) for k, w in enumerate(kernel)]
        image = np.sum(parts, axis=0)
    return image


def noise(key: int, shape: tuple[int, int], sd_grey: float) -> NDArray[np.int64]:
    """Return the sensor's noise, (H, W), in 1/128 grey: a function of the key and the pixel, the same in the C core."""
    height, width = shape
    first, second = _mixed(key)
    x = np.arange(height * width, dtype=np.uint32) * np.uint32(0x9E3779B9) + np.uint32(first)
    x ^= x >> np.uint32(16)
    x *= np.uint32(0x7FEB352D)
    x ^= (x >> np.uint32(15)) ^ np.uint32(second)
    x *= np.uint32(0x846CA68B)
    x ^= x >> np.uint32(16)
    total = sum(((x >> np.uint32(8 * k)) & np.uint32(255)).astype(np.int64) for k in range(4)) - 510
    scale = math.floor(sd_grey * GREY / BYTES_SD * 2**SCALE_BITS + 0.5)
    levels = (total * scale + 2 ** (SCALE_BITS - 1)) >> SCALE_BITS
    return np.asarray(levels.reshape(width, height).T)  # pixels count down the columns


def sensed(image: Floats, noise_grey: float, key: int | None) -> NDArray[np.uint8]:
    """Return what the sensor makes of light (H, W): noise, then the nearest whole grey in 0..255."""
    levels = np.floor(image.astype(np.float32) * np.float32(GREY) + np.float32(0.5)).astype(np.int64)
    if key is not None and noise_grey > 0:
        levels += noise(key, (image.shape[0], image.shape[1]), noise_grey)
    return np.asarray(np.clip((levels + GREY // 2) >> 7, 0, 255), np.uint8)


def _mixed(key: int) -> tuple[int, int]:
    """Return the two halves of a 64-bit key, every bit of it in both."""
    mask = 2**64 - 1
    key = (key + 0x9E3779B97F4A7C15) & mask
    key = ((key ^ (key >> 30)) * 0xBF58476D1CE4E5B9) & mask
    key = ((key ^ (key >> 27)) * 0x94D049BB133111EB) & mask
    key ^= key >> 31
    return key & 0xFFFFFFFF, key >> 32
