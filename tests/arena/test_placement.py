"""Robots start apart and clear of everything, evenly spread; a room too small says so."""

import math

import numpy as np
import pytest

from lobula.arena.placement import random_poses
from lobula.arena.world import Obstacle, RobotParams, RoomParams, World
from lobula.errors import ParameterError


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("room", [RoomParams(), RoomParams(shape="circle", radius_cm=30)])
def test_all_are_clear_of_each_other_and_of_everything(seed: int, room: RoomParams) -> None:
    obstacles = (Obstacle(x_cm=30, y_cm=25), Obstacle(x_cm=40, y_cm=35, radius_cm=4))
    world = World(room=room, robots=RobotParams(count=7), obstacles=obstacles)
    poses = random_poses(world, np.random.default_rng(seed))
    assert poses.shape == (7, 3)
    places = poses[:, 0] + 1j * poses[:, 1]
    assert np.abs(places[:, None] - places)[~np.eye(7, dtype=bool)].min() >= 4 + 0.5
    for one in obstacles:
        assert np.abs(places - complex(one.x_cm, one.y_cm)).min() >= 2 + one.radius_cm + 0.5
    assert min(world.wall_gap_cm(x, y) for x, y, _ in poses) >= 2.5


def test_places_and_headings_are_evenly_spread() -> None:
    world, rng = World(robots=RobotParams(count=1)), np.random.default_rng(2)
    poses = np.array([random_poses(world, rng)[0] for _ in range(1000)])
    for values, low, high in zip(poses.T, (7, 7, -math.pi), (63, 48, math.pi), strict=True):
        share = np.sort((values - low) / (high - low))
        # Kolmogorov and Smirnov: 1.95 / sqrt(n) is passed once in a thousand times
        assert np.abs(share - np.arange(1000) / 1000).max() < 1.95 / math.sqrt(1000)


def test_a_crowd_gets_less_room_each() -> None:
    world = World(room=RoomParams(width_cm=30, depth_cm=30), robots=RobotParams(count=12))
    poses = random_poses(world, np.random.default_rng(0))
    assert poses.shape == (12, 3)


@pytest.mark.parametrize(
    "world",
    [
        World(robots=RobotParams(count=200)),
        World(room=RoomParams(width_cm=8, depth_cm=8), robots=RobotParams(count=2)),
        World(room=RoomParams(shape="circle", radius_cm=4), obstacles=(Obstacle(x_cm=4, y_cm=4),)),
    ],
)
def test_no_room_is_one_clear_error(world: World) -> None:
    with pytest.raises(ParameterError, match=r"no room for so many robots of radius 2 cm in .*; at most \d+ found"):
        random_poses(world, np.random.default_rng(0))
