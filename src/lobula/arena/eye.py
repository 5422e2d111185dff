"""What every robot's camera sees, from positions in the room to pictures: the one place where conventions change.

The room has (x, y) in cm, y up, and headings counter-clockwise from x. Pictures have rows from the top down and columns
rightwards, so what lies to a robot's left, counter-clockwise, has the smaller column. The camera looks level along the
heading from a pupil ahead of the robot's centre; its axis meets the middle of the picture. A point at (forward, left,
up) from the pupil falls on

    column = W / 2 - f left / forward,    row = H / 2 - f up / forward,    f = (W / 2) / tan(fov / 2)
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from ..engine.eye import CoreEye
from ..engine.network import chosen_engine
from ..errors import ParameterError, ShapeError
from .reference_eye import ReferenceEye
from .scene import Scene
from .world import CameraParams

LARGEST = 1e6
MOST_LIGHT = 1000.0


class Eye:
    """Draws what cameras in ``scene`` see.

    Every pixel is the mean of what it covers, so that slow motion changes it little by little. A pupil inside a body or
    a wall, or nearer than 0.01 cm, is taken to be 0.01 cm off its surface.

    Parameters
    ----------
    scene : what there is to see
    camera : size, field of view, place, noise, blur; its ``auto_gain`` is the caller's business, through ``light``
    engine : ``core`` (C), ``reference`` (NumPy, a thousand times slower), or ``auto``: the core where it was built

    The same from both engines but for the sampling of the reference, which the tests bound; the noise is the same to
    the bit. Not for two threads at once.

    Raises
    ------
    ParameterError : an unknown engine, or ``core`` where there is none
    """

    def __init__(self, scene: Scene, camera: CameraParams, *, engine: str = "auto") -> None:
        self.scene, self.camera = scene, camera
        self.engine = chosen_engine(engine)
        self.shape = (camera.height_px, camera.width_px)
        self._eye = CoreEye(scene, camera) if self.engine == "core" else ReferenceEye(scene, camera)

    def views(
        self,
        cameras: ArrayLike,
        bodies: ArrayLike,
        *,
        own: ArrayLike | None = None,
        keys: ArrayLike | None = None,
        light: ArrayLike | None = None,
        shown: ArrayLike | None = None,
        obstacles: ArrayLike | None = None,
        walls: ArrayLike | None = None,
        out: NDArray[np.uint8] | None = None,
    ) -> NDArray[np.uint8]:
        """Return the pictures of N cameras, (N, H, W) uint8.

        Parameters
        ----------
        cameras : (N, 3) x, y of the robot's centre, cm, and its heading, rad
        bodies : (N, B, 3) the robots around each, or (B, 3) for all of them
        own : (N,) which body carries the camera, never seen; -1, as nothing, for none
        keys : (N,) uint64; the noise is a function of key and pixel. Nothing: without noise
        light : (N,) gain on all luminance, in 0..1000; nothing: 1
        shown : (N, B) False leaves a body out; nothing: all are there
        obstacles : (N, P) the same for the scene's obstacles
        walls : (N,) False paints the wall its mean grey; nothing: as it is
        out : (N, H, W) uint8 to write into, contiguous

        Raises
        ------
        ShapeError : an argument of another shape, or an ``out`` that does not fit
        ParameterError : a position, heading or light that is not finite or out of range; ``own`` that is no body
        """
        places = _array("cameras", cameras, np.float64)
        if places.ndim != 2 or places.shape[1] != 3:
            raise ShapeError(f"Eye.views: cameras {places.shape}: must be (N, 3)")
        count = len(places)
        poses = _array("bodies", bodies, np.float64)
        if poses.ndim not in (2, 3) or poses.shape[-1] != 3 or (poses.ndim == 3 and len(poses) != count):
            raise ShapeError(f"Eye.views: bodies {poses.shape}: must be ({count}, B, 3) or (B, 3)")
        number = poses.shape[-2]
        optional = {
            "own": _optional("own", own, np.int32, (count,)),
            "keys": _optional("keys", keys, np.uint64, (count,)),
            "light": _optional("light", light, np.float64, (count,)),
            "shown": _optional("shown", shown, np.bool_, (count, number)),
            "obstacles": _optional("obstacles", obstacles, np.bool_, (count, len(self.scene.obstacles))),
            "walls": _optional("walls", walls, np.bool_, (count,)),
        }
        if out is None:
            out = np.empty((count, *self.shape), np.uint8)
        elif out.shape != (count, *self.shape) or out.dtype != np.uint8 or not out.flags.c_contiguous:
            raise ShapeError(
                f"Eye.views: out: {out.dtype} {out.shape}: must be contiguous uint8 {(count, *self.shape)}"
            )
        if isinstance(self._eye, ReferenceEye):
            _require_values(places, poses, optional)
            self._eye.views(places, poses, optional, out)
        elif not self._eye.views(places, poses, optional, out):  # it looks at the numbers itself, more quickly
            _require_values(places, poses, optional)
            raise RuntimeError("the C core refuses these views")
        return out


def _require_values(cameras: NDArray[Any], bodies: NDArray[Any], optional: dict[str, NDArray[Any] | None]) -> None:
    for name, array in (("cameras", cameras), ("bodies", bodies)):
        if not (np.abs(array) <= LARGEST).all():  # so that NaN is refused too
            raise ParameterError(f"Eye.views: {name}: every number must be finite, within +-{LARGEST:g}")
    light, own = optional["light"], optional["own"]
    if light is not None and not ((light >= 0) & (light <= MOST_LIGHT)).all():
        raise ParameterError(f"Eye.views: light: every gain must be in [0, {MOST_LIGHT:g}]")
    number = bodies.shape[-2]
    if own is not None and not ((own >= -1) & (own < number)).all():
        raise ParameterError(f"Eye.views: own: must be the index of one of {number} bodies, or -1")


def _array(name: str, given: ArrayLike, dtype: DTypeLike) -> NDArray[Any]:
    try:
        return np.asarray(given, dtype)
    except (TypeError, ValueError, OverflowError) as error:
        raise ParameterError(f"Eye.views: {name}: {error}") from error


def _optional(name: str, given: ArrayLike | None, dtype: DTypeLike, shape: tuple[int, ...]) -> NDArray[Any] | None:
    if given is None:
        return None
    array = _array(name, given, dtype)
    if array.shape != shape:
        raise ShapeError(f"Eye.views: {name} {array.shape}: must be {shape}")
    return array
