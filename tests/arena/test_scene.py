"""From a world's settings to what there is to see."""

from __future__ import annotations

import numpy as np
import pytest

from lobula.arena.scene import build_scene
from lobula.arena.world import BodyParams, Obstacle, RoomParams, WallParams, World


def test_the_paper_room():
    scene = build_scene(World(), 0)
    assert (scene.shape, scene.size_cm, scene.wall_cm) == ("box", (70.0, 55.0), 12.0)
    assert (scene.floor_grey, scene.above_grey) == (95.0, 200.0)
    assert (scene.body.radius_cm, scene.body.height_cm, scene.body.bands_grey.tolist()) == (2.0, 3.0, [45.0])
    assert len(scene.body.around_grey) == len(scene.obstacles) == 0
    assert len(scene.wall_grey) >= 250 / 0.02


def test_a_round_room_has_a_square_around_it():
    scene = build_scene(World(room=RoomParams(shape="circle", radius_cm=20)), 0)
    assert (scene.shape, scene.size_cm) == ("circle", (40.0, 40.0))


def test_bands_and_bars_of_a_body():
    body = BodyParams(grey=100, bands_grey=(0, 20, -10), bars=3, bars_grey=30)
    look = build_scene(World(body=body), 0).body
    assert look.bands_grey.tolist() == [100, 120, 90]
    # a period of 120 degrees: half of it bar, the first centred on the heading
    degrees = (np.arange(len(look.around_grey)) + 0.5) * 360 / len(look.around_grey)
    in_bar = np.abs((degrees + 60) % 120 - 60) < 30
    assert look.around_grey.tolist() == np.where(in_bar, 30.0, 0.0).tolist()


def test_obstacles_striped_and_plain():
    obstacles = (Obstacle(x_cm=10, y_cm=20, radius_cm=3), Obstacle(x_cm=40, y_cm=30, pattern="plain", grey=99))
    scene = build_scene(World(obstacles=obstacles), 0)
    striped, plain = scene.obstacles
    assert scene.obstacle_poses.tolist() == [[10, 20, 0], [40, 30, 0]]
    assert (striped.around_grey.min(), striped.around_grey.max(), striped.bands_grey.tolist()) == (150, 210, [0])
    assert len(striped.around_grey) >= 2 * np.pi * 3 / 0.02
    assert (plain.bands_grey.tolist(), len(plain.around_grey)) == ([99.0], 0)


def test_the_seed_draws_the_wall():
    walls = [build_scene(World(), seed).wall_grey for seed in (5, 5, 6)]
    assert np.array_equal(walls[0], walls[1])
    assert not np.array_equal(walls[0], walls[2])
    drawn = build_scene(World(), np.random.SeedSequence(5)).wall_grey
    assert np.array_equal(drawn, walls[0])


@pytest.mark.parametrize("pattern", ["stripes", "plain"])
def test_the_pattern_changes_nothing_else(pattern):
    scene = build_scene(World(wall=WallParams(pattern=pattern, height_cm=9)), 1)
    assert scene.wall_cm == 9
    assert scene.wall_grey.mean() == pytest.approx(180, abs=1)
