"""What there is to see in an arena, as plain arrays: the eyes draw it, whatever it was made from."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .texture import stripes, wall_strip
from .world import BodyParams, Obstacle, World

Floats = NDArray[np.float64]


def _nothing() -> Floats:
    return np.zeros(0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Cylinder:
    """An upright cylinder. Luminance at a point = its band + what lies around at its bearing, kept in 0..255.

    bands_grey : (K,) level bands of equal height, from the floor up; seen from above, its top has their mean
    around_grey : (n,) added: sectors of equal width, counter-clockwise from its heading; (0,) for none
    """

    radius_cm: float
    height_cm: float
    bands_grey: Floats
    around_grey: Floats = field(default_factory=_nothing)


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """A room with its wall, the look of its robots, and the cylinders that stay where they are.

    shape : "box" or "circle"
    size_cm : along x and y; of a circle its diameter, twice
    wall_cm, wall_grey : its height; (n,) luminance in samples of equal length, counter-clockwise from the lower left
        corner, in a circle from the point at heading 0
    floor_grey, above_grey : luminance below and above the wall
    body : every robot
    obstacles, obstacle_poses : (P,) cylinders at (P, 3) x, y, heading
    """

    shape: str
    size_cm: tuple[float, float]
    wall_cm: float
    wall_grey: Floats
    floor_grey: float
    above_grey: float
    body: Cylinder
    obstacles: tuple[Cylinder, ...] = ()
    obstacle_poses: Floats = field(default_factory=lambda: np.zeros((0, 3)))


def build_scene(world: World, seed: int | np.random.SeedSequence) -> Scene:
    """Return what ``world`` looks like; ``seed`` draws the stripes.

    Raises
    ------
    FrameSourceError, ParameterError : the file of the wall's pattern is no picture
    """
    rng = np.random.default_rng(seed)
    return Scene(
        shape=world.room.shape,
        size_cm=world.room.size_cm,
        wall_cm=world.wall.height_cm,
        wall_grey=wall_strip(world.wall, world.room.perimeter_cm, rng),
        floor_grey=world.room.floor_grey,
        above_grey=world.room.above_grey,
        body=_body(world.body),
        obstacles=tuple(_obstacle(obstacle, world, rng) for obstacle in world.obstacles),
        obstacle_poses=np.array([[o.x_cm, o.y_cm, 0.0] for o in world.obstacles]).reshape(-1, 3),
    )


def _body(body: BodyParams) -> Cylinder:
    # a bar straight ahead, and as much of it on either side: quarters of a period
    period = np.array([body.bars_grey, 0.0, 0.0, body.bars_grey])
    return Cylinder(
        radius_cm=body.radius_cm,
        height_cm=body.height_cm,
        bands_grey=body.grey + np.array(body.bands_grey),
        around_grey=np.tile(period, body.bars),
    )


def _obstacle(obstacle: Obstacle, world: World, rng: np.random.Generator) -> Cylinder:
    plain = obstacle.pattern == "plain"
    return Cylinder(
        radius_cm=obstacle.radius_cm,
        height_cm=obstacle.height_cm,
        bands_grey=np.array([obstacle.grey if plain else 0.0]),
        around_grey=_nothing() if plain else stripes(world.wall, 2 * math.pi * obstacle.radius_cm, rng),
    )
