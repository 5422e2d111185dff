"""What the arena's eye is given: what a scene and a camera must have, and the core's structures for them."""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import POINTER, Structure, c_double, c_int32, c_int64, c_void_p
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

SHAPES = ("box", "circle")
"""Plans of a room; the position here is the core's number."""

Floats = NDArray[np.float64]


class Cylinder(Protocol):
    """An upright cylinder; ``lobula.arena.scene.Cylinder`` documents its fields."""

    @property
    def radius_cm(self) -> float: ...
    @property
    def height_cm(self) -> float: ...
    @property
    def bands_grey(self) -> Floats: ...
    @property
    def around_grey(self) -> Floats: ...


class Scene(Protocol):
    """What there is to see; ``lobula.arena.scene.Scene`` documents its fields."""

    @property
    def shape(self) -> str: ...
    @property
    def size_cm(self) -> tuple[float, float]: ...
    @property
    def wall_cm(self) -> float: ...
    @property
    def wall_grey(self) -> Floats: ...
    @property
    def floor_grey(self) -> float: ...
    @property
    def above_grey(self) -> float: ...
    @property
    def body(self) -> Cylinder: ...
    @property
    def obstacles(self) -> Sequence[Cylinder]: ...
    @property
    def obstacle_poses(self) -> Floats: ...


class Camera(Protocol):
    """``lobula.arena.world.CameraParams`` has these."""

    @property
    def width_px(self) -> int: ...
    @property
    def height_px(self) -> int: ...
    @property
    def fov_deg(self) -> float: ...
    @property
    def ahead_cm(self) -> float: ...
    @property
    def above_floor_cm(self) -> float: ...
    @property
    def noise_grey(self) -> float: ...
    @property
    def blur_px(self) -> float: ...


class StripStruct(Structure):
    """``lobula_eye_strip``."""

    _fields_ = [("sums", c_void_p), ("samples", c_int32), ("reserved", c_int32)]


class CylinderStruct(Structure):
    """``lobula_eye_cylinder``."""

    _fields_ = [
        ("radius_cm", c_double), ("height_cm", c_double), ("bands_grey", c_void_p), ("bands", c_int32),
        ("reserved", c_int32), ("around", StripStruct),
    ]  # fmt: skip


class SceneStruct(Structure):
    """``lobula_eye_scene``."""

    _fields_ = [
        ("shape", c_int32), ("obstacles", c_int32),
        *((n, c_double) for n in ("width_cm", "depth_cm", "wall_cm", "floor_grey", "above_grey")),
        ("wall", StripStruct), ("body", CylinderStruct), ("obstacle", POINTER(CylinderStruct)),
        ("obstacle_poses", c_void_p),
    ]  # fmt: skip


class CameraStruct(Structure):
    """``lobula_eye_camera``."""

    _fields_ = [
        ("width", c_int32), ("height", c_int32),
        *((n, c_double) for n in ("focal_px", "ahead_cm", "above_floor_cm", "noise_grey", "blur_px")),
    ]  # fmt: skip


class ViewsStruct(Structure):
    """``lobula_eye_views``."""

    _fields_ = [
        ("count", c_int64), ("bodies", c_int64), ("cameras", c_void_p), ("poses", c_void_p), ("poses_step", c_int64),
        *((n, c_void_p) for n in ("own", "keys", "light", "shown", "obstacles", "walls")),
    ]  # fmt: skip
