"""The settings of the arena: the paper's by default, checked, alike for alike."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lobula.arena.world import LightParams, Obstacle, RoomParams, World
from lobula.errors import ParameterError
from lobula.params import settings_hash, to_dict


def test_the_default_is_the_papers_arena() -> None:
    world = World()
    assert world.room.size_cm == (70, 55)
    assert (world.robots.speed_low_cm_s, world.robots.speed_high_cm_s) == (6, 10)
    assert (world.camera.width_px, world.camera.height_px, world.camera.fov_deg) == (99, 72, 70)
    assert world.tick_s == pytest.approx(1 / 30)


def test_perimeters_and_distances_to_the_wall() -> None:
    assert World().room.perimeter_cm == 250
    assert World().wall_gap_cm(10, 50) == 5
    assert World().wall_gap_cm(-1, 20) == -1
    circle = World(room=RoomParams(shape="circle", radius_cm=40))
    assert circle.room.perimeter_cm == pytest.approx(80 * math.pi)
    assert circle.wall_gap_cm(43, 44) == pytest.approx(35)  # 3-4-5 from the middle


def test_the_hash_tells_worlds_apart_by_any_setting_and_obstacle() -> None:
    worlds = [World(), World(obstacles=(Obstacle(),)), World(obstacles=(Obstacle(x_cm=30),)),
              replace(World(), room=RoomParams(width_cm=71))]  # fmt: skip
    assert len({settings_hash(world) for world in worlds}) == len(worlds)
    assert settings_hash(World()) == settings_hash(World())
    assert to_dict(worlds[1])["obstacles"][0]["radius_cm"] == 2.5


def test_obstacles_must_be_such() -> None:
    with pytest.raises(ParameterError, match=r"obstacles\[0\] = 5: must be an Obstacle"):
        World(obstacles=(5,))  # type: ignore[arg-type]


def test_steady_light() -> None:
    assert LightParams().gain(np.arange(3.0)).tolist() == [1, 1, 1]


def test_flickering_light_is_a_sinusoid_about_one() -> None:
    light = LightParams(course="flicker", flicker_hz=2, flicker_amplitude=0.3)
    gain = light.gain(np.array([0, 0.125, 0.25, 0.375]))
    np.testing.assert_allclose(gain, [1, 1.3, 1, 0.7], atol=1e-12)


def test_light_steps_change_at_the_frame_of_the_step() -> None:
    light = LightParams(course="steps", step_every_s=2, step_gain=0.5)
    times_s = np.arange(0, 200) / 30
    gain = light.gain(times_s)
    assert gain[0] == 1
    assert gain[59] == 1
    assert gain[60] == gain[119] == 0.5
    assert gain[120] == 1
