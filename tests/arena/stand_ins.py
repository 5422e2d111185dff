"""Eyes and controllers that do little, and all of it plainly."""

from __future__ import annotations

from typing import Any

import numpy as np

from lobula.arena.world import CameraParams, RobotParams, World


class PlainEye:
    """Pictures whose grey tells where the camera is, what surrounds it, its key and the light; nothing else."""

    def __init__(self, camera: CameraParams | None = None) -> None:
        camera = camera or CameraParams()
        self.shape = (camera.height_px, camera.width_px)

    def views(
        self, cameras: Any, bodies: Any, *, own: Any = None, keys: Any = None, light: Any = None, shown: Any = None,
        obstacles: Any = None, walls: Any = None,
    ) -> np.ndarray:  # fmt: skip
        cameras = np.asarray(cameras)
        bodies = np.broadcast_to(bodies, (len(cameras), *np.shape(bodies)[-2:]))
        grey = 20 * np.asarray(light) + cameras.sum(axis=1) % 7 + 0.1 * bodies.sum(axis=(1, 2)) % 5
        grey = grey + (np.asarray(keys, np.uint64) % np.uint64(5)).astype(float)
        return np.broadcast_to(grey[:, None, None], (len(cameras), *self.shape)).clip(0, 255).astype(np.uint8)


class Scripted:
    """Avoids at given ticks: ``{tick: robots}``; notes what it was told."""

    def __init__(self, script: dict[int, list[int]] | None = None) -> None:
        self.script = script or {}

    def start(self, robots: int, rng: np.random.Generator) -> None:
        self.told: list[np.ndarray] = []

    def step(self, images: np.ndarray, time_s: float, turning: np.ndarray) -> np.ndarray:
        said = np.zeros(len(turning), bool)
        said[self.script.get(len(self.told), [])] = True
        self.told.append(turning.copy())
        return said


class Adder:
    """Remembers a number for each robot, the sum of all it saw, and avoids when that is a multiple of 50."""

    def start(self, robots: int, rng: np.random.Generator) -> None:
        self.sums = [0] * robots

    def step(self, images: np.ndarray, time_s: float, turning: np.ndarray) -> np.ndarray:
        self.sums = [total + int(image[0, 0]) for total, image in zip(self.sums, images, strict=True)]
        return np.array(self.sums) % 50 == 0

    def state(self, robot: int) -> dict[str, Any]:
        return {"sum": self.sums[robot]}

    def set_state(self, robot: int, state: Any) -> None:
        self.sums[robot] = state["sum"]

    def replay(self, state: Any, images: np.ndarray, times_s: np.ndarray, turning: np.ndarray) -> np.ndarray:
        return (state["sum"] + np.cumsum(images[:, 0, 0].astype(int))) % 50 == 0


def assert_same_table(first: np.ndarray, second: np.ndarray) -> None:
    """Column by column: NumPy takes NaN for NaN in plain arrays only."""
    assert first.dtype == second.dtype
    for name in first.dtype.names:
        np.testing.assert_array_equal(first[name], second[name], err_msg=name)


def world_of(robots: int = 1, **groups: Any) -> World:
    """Return the paper's world with ``robots`` robots at 9 cm/s (0.3 cm a tick) and other groups of settings."""
    return World(robots=RobotParams(count=robots, speed_low_cm_s=9, speed_high_cm_s=9), **groups)
