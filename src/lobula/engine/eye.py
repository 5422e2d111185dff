"""The arena's eye in C: all views of one moment in one call."""

from __future__ import annotations

import ctypes
import math
from ctypes import POINTER, c_int64, c_void_p
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from .core import Memory
from .eye_structures import (
    SHAPES,
    Camera,
    CameraStruct,
    Cylinder,
    CylinderStruct,
    Floats,
    Scene,
    SceneStruct,
    StripStruct,
    ViewsStruct,
)
from .library import isa_index, library

EYE_ABI = 1


@cache
def _eye_library() -> ctypes.CDLL:
    core = library()
    try:
        core.lobula_eye_abi.restype, core.lobula_eye_abi.argtypes = ctypes.c_int, []
        size, draw = core.lobula_eye_workspace_size, core.lobula_eye_draw
    except AttributeError as error:
        raise ParameterError("the C core here has no eye: it belongs to another lobula; install again") from error
    if core.lobula_eye_abi() != EYE_ABI:
        raise ParameterError("the C core here has another eye: it belongs to another lobula; install again")
    size.restype, size.argtypes = ctypes.c_size_t, [POINTER(SceneStruct), POINTER(CameraStruct), c_int64]
    draw.restype, draw.argtypes = ctypes.c_int, [c_void_p, c_void_p, c_void_p, c_void_p, ctypes.c_int, c_void_p]
    return core


class _Staged:
    """Arguments of ``count`` views with ``bodies`` each, at places that do not move, and the core's list of them."""

    def __init__(self, count: int, bodies: int, shared: bool, obstacles: int) -> None:
        self.of = (count, bodies, shared)
        self.cameras = np.empty((count, 3))
        self.poses = np.empty((bodies, 3) if shared else (count, bodies, 3))
        self.optional: dict[str, NDArray[Any]] = {
            "own": np.empty(count, np.int32),
            "keys": np.empty(count, np.uint64),
            "light": np.empty(count),
            "shown": np.empty((count, bodies), np.uint8),
            "obstacles": np.empty((count, obstacles), np.uint8),
            "walls": np.empty(count, np.uint8),
        }
        self.places = {name: array.ctypes.data for name, array in self.optional.items()}
        self.views = ViewsStruct(
            count=count, bodies=bodies, cameras=self.cameras.ctypes.data, poses=self.poses.ctypes.data,
            poses_step=0 if shared else 3 * bodies,
        )  # fmt: skip
        self.address = ctypes.addressof(self.views)


class CoreEye:
    """Draws views of one scene through one camera. One thread at a time.

    Raises
    ------
    ParameterError : a scene or camera that the core does not take
    """

    def __init__(self, scene: Scene, camera: Camera) -> None:
        self._core = _eye_library()
        self._draw = self._core.lobula_eye_draw
        self._isa = isa_index()
        self._kept: list[Any] = []
        self._scene = self._scene_struct(scene)
        self._camera = CameraStruct(
            width=camera.width_px, height=camera.height_px,
            focal_px=focal_px(camera.width_px, camera.fov_deg), ahead_cm=camera.ahead_cm,
            above_floor_cm=camera.above_floor_cm, noise_grey=camera.noise_grey, blur_px=camera.blur_px,
        )  # fmt: skip
        self._fixed = ctypes.addressof(self._scene), ctypes.addressof(self._camera)
        self._staged = _Staged(0, 0, True, 0)
        self._workspace = Memory(self._workspace_size(0))
        self._bodies = 0

    def views(
        self, cameras: Floats, bodies: Floats, optional: dict[str, NDArray[Any] | None], out: NDArray[np.uint8]
    ) -> bool:
        """Draw into ``out`` (N, H, W), contiguous; false, with nothing drawn, where a number is out of range.

        ``arena.eye.Eye.views`` has the arguments, of shapes checked there; ``optional`` holds ``own``, ``keys``,
        ``light``, ``shown``, ``obstacles`` and ``walls``.
        """
        count, shared = len(cameras), bodies.ndim == 2
        number = bodies.shape[-2]
        staged = self._staged
        if staged.of != (count, number, shared):
            staged = self._staged = _Staged(count, number, shared, self._scene.obstacles)
        if number > self._bodies:
            self._workspace = Memory(self._workspace_size(number))
            self._bodies = number
        staged.cameras[...] = cameras
        staged.poses[...] = bodies
        for name, given in optional.items():
            if given is None:
                setattr(staged.views, name, None)
            else:
                staged.optional[name][...] = given
                setattr(staged.views, name, staged.places[name])
        status = self._draw(*self._fixed, staged.address, self._workspace.address, self._isa, out.ctypes.data)
        return bool(status == 0)

    def _workspace_size(self, bodies: int) -> int:
        size = int(self._core.lobula_eye_workspace_size(self._scene, self._camera, bodies))
        if not size:
            raise ParameterError("Eye: a scene or camera that the eye does not take: sizes must be positive and finite")
        return size

    def _scene_struct(self, scene: Scene) -> SceneStruct:
        width, depth = scene.size_cm
        struct = SceneStruct(
            shape=SHAPES.index(scene.shape), obstacles=len(scene.obstacles), width_cm=width, depth_cm=depth,
            wall_cm=scene.wall_cm, floor_grey=scene.floor_grey, above_grey=scene.above_grey,
            wall=self._strip(scene.wall_grey), body=self._cylinder(scene.body),
            obstacle_poses=self._address(scene.obstacle_poses),
        )  # fmt: skip
        struct.obstacle = (CylinderStruct * len(scene.obstacles))(*map(self._cylinder, scene.obstacles))
        return struct

    def _cylinder(self, cylinder: Cylinder) -> CylinderStruct:
        return CylinderStruct(
            radius_cm=cylinder.radius_cm, height_cm=cylinder.height_cm, bands=len(cylinder.bands_grey),
            bands_grey=self._address(cylinder.bands_grey), around=self._strip(cylinder.around_grey),
        )  # fmt: skip

    def _strip(self, greys: Floats) -> StripStruct:
        sums = np.concatenate([[0.0], np.cumsum(greys, dtype=np.float64)])
        return StripStruct(sums=self._address(sums), samples=len(greys))

    def _address(self, array: NDArray[Any]) -> int:
        """Return where the numbers lie, which live as long as the eye."""
        numbers = np.array(array, np.float64, order="C")
        self._kept.append(numbers)
        return int(numbers.ctypes.data)


def focal_px(width_px: int, fov_deg: float) -> float:
    """Return the distance, in pixels, of the picture from the pupil: ``(width / 2) / tan(fov / 2)``."""
    return 0.5 * width_px / math.tan(0.5 * math.radians(fov_deg))
