"""The arena's eye in C: all views of one moment in one call."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from ctypes import POINTER, Structure, c_double, c_int32, c_int64, c_void_p
from functools import cache
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from .core import Memory
from .library import isa_index, library

EYE_ABI = 1
SHAPES = ("box", "circle")
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
    def posts(self) -> Sequence[Cylinder]: ...
    @property
    def post_poses(self) -> Floats: ...


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
        ("shape", c_int32), ("posts", c_int32),
        *((n, c_double) for n in ("width_cm", "depth_cm", "wall_cm", "floor_grey", "above_grey")),
        ("wall", StripStruct), ("body", CylinderStruct), ("post", POINTER(CylinderStruct)), ("post_poses", c_void_p),
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
        *((n, c_void_p) for n in ("own", "keys", "light", "shown", "walls")),
    ]  # fmt: skip


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

    def __init__(self, count: int, bodies: int, shared: bool) -> None:
        self.of = (count, bodies, shared)
        self.cameras = np.empty((count, 3))
        self.poses = np.empty((bodies, 3) if shared else (count, bodies, 3))
        self.optional: dict[str, NDArray[Any]] = {
            "own": np.empty(count, np.int32),
            "keys": np.empty(count, np.uint64),
            "light": np.empty(count),
            "shown": np.empty((count, bodies), np.uint8),
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
        self._isa = isa_index()
        self._kept: list[Any] = []
        self._scene = self._scene_struct(scene)
        self._camera = CameraStruct(
            width=camera.width_px, height=camera.height_px,
            focal_px=focal_px(camera.width_px, camera.fov_deg), ahead_cm=camera.ahead_cm,
            above_floor_cm=camera.above_floor_cm, noise_grey=camera.noise_grey, blur_px=camera.blur_px,
        )  # fmt: skip
        self._shape = (camera.height_px, camera.width_px)
        self._staged = _Staged(0, 0, True)
        self._workspace = Memory(self._workspace_size(0))
        self._bodies = 0

    def views(
        self, cameras: Floats, bodies: Floats, optional: dict[str, NDArray[Any] | None], out: NDArray[np.uint8]
    ) -> None:
        """Draw into ``out`` (N, H, W), contiguous; ``arena.eye.Eye.views`` has the arguments, checked there.

        ``optional`` holds ``own``, ``keys``, ``light``, ``shown`` and ``walls``.
        """
        count, shared = len(cameras), bodies.ndim == 2
        number = bodies.shape[-2]
        staged = self._staged
        if staged.of != (count, number, shared):
            staged = self._staged = _Staged(count, number, shared)
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
        status = self._core.lobula_eye_draw(
            ctypes.addressof(self._scene), ctypes.addressof(self._camera), staged.address, self._workspace.address,
            self._isa, out.ctypes.data,
        )  # fmt: skip
        if status:
            raise ParameterError("Eye.views: a pose, a light or a size that the eye does not take")

    def _workspace_size(self, bodies: int) -> int:
        size = int(self._core.lobula_eye_workspace_size(self._scene, self._camera, bodies))
        if not size:
            raise ParameterError("Eye: a scene or camera that the eye does not take: sizes must be positive and finite")
        return size

    def _scene_struct(self, scene: Scene) -> SceneStruct:
        posts = (CylinderStruct * max(len(scene.posts), 1))(*(self._cylinder(post) for post in scene.posts))
        self._kept.append(posts)
        width, depth = scene.size_cm
        return SceneStruct(
            shape=SHAPES.index(scene.shape), posts=len(scene.posts), width_cm=width, depth_cm=depth,
            wall_cm=scene.wall_cm, floor_grey=scene.floor_grey, above_grey=scene.above_grey,
            wall=self._strip(scene.wall_grey), body=self._cylinder(scene.body), post=posts,
            post_poses=self._address(scene.post_poses),
        )  # fmt: skip

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
