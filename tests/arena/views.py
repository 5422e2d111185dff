"""What the tests of the eye share: bare scenes whose pictures can be worked out by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from lobula.arena.eye import Eye
from lobula.arena.reference_eye import ReferenceEye
from lobula.arena.scene import Cylinder, Scene
from lobula.arena.world import CameraParams

FOCAL_PX = 70.6933
"""49.5 / tan(35 deg): the paper's camera, worked out apart from the code."""

QUIET = CameraParams(noise_grey=0.0)
BODY = Cylinder(radius_cm=2.0, height_cm=3.0, bands_grey=np.array([50.0]))
ROOM = Scene(
    shape="box", size_cm=(70.0, 55.0), wall_cm=12.0, wall_grey=np.array([100.0]), floor_grey=100.0, above_grey=100.0,
    body=BODY,
)  # fmt: skip
"""A room all of grey 100, so that only bodies of grey 50 show."""

NOBODY = np.zeros((0, 3))


def picture(scene: Scene, camera: Any, bodies: Any = NOBODY, *, params: CameraParams = QUIET, **settings: Any) -> Any:
    """Return what one camera of the core, or without it of the reference, sees."""
    settings = {name: [value] for name, value in settings.items()}
    return Eye(scene, params).views([camera], np.reshape(bodies, (-1, 3)), **settings)[0]


def by_rays(scene: Scene, camera: Any, bodies: Any, samples: tuple[int, int], params: CameraParams = QUIET) -> Any:
    """Return what the reference says, from ``samples`` (across, down) rays a pixel, as float."""
    eye = ReferenceEye(scene, params, samples=samples)
    there = [(scene.body, pose) for pose in np.reshape(bodies, (-1, 3))]
    there += list(zip(scene.obstacles, scene.obstacle_poses, strict=True))
    return eye.luminance(np.asarray(camera, float), there, pattern=True)


def mirrored(scene: Scene) -> Scene:
    """Return the same scene seen in a mirror along the y axis of its room."""
    width, _ = scene.size_cm
    strip = scene.wall_grey[::-1]
    # a strip starts at the lower left corner, mirrored at the lower right one; or at heading 0, then at 180
    share = width / (2 * sum(scene.size_cm)) if scene.shape == "box" else 0.5
    turned = [replace(c, around_grey=c.around_grey[::-1]) for c in (scene.body, *scene.obstacles)]
    return replace(
        scene, wall_grey=np.roll(strip, round(share * len(strip))), body=turned[0], obstacles=tuple(turned[1:]),
        obstacle_poses=mirrored_poses(scene.obstacle_poses, width),
    )  # fmt: skip


def mirrored_poses(poses: Any, width: float) -> Any:
    """Return poses (..., 3) mirrored left and right in a room of ``width`` cm."""
    x, y, heading = np.moveaxis(np.asarray(poses, float), -1, 0)
    return np.stack([width - x, y, np.pi - heading], axis=-1)
