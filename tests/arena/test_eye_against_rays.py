"""The C core against the independent renderer: the same pictures, within what a finite number of rays can tell.

With n rays across and m down a pixel, an edge of contrast c is off by at most c / 2n or c / 2m, and the core rounds by
half a grey. What is left, a few greys in few pixels, comes from sloping edges that cross a stripe within one column:
there the core takes the means of both.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lobula.arena.eye import Eye
from lobula.arena.scene import build_scene
from lobula.arena.world import BodyParams, CameraParams, Obstacle, RoomParams, World
from lobula.engine.library import available

from .views import by_rays

if not available():
    pytest.skip("the C core was not built", allow_module_level=True)

RAYS = (32, 24)
CAMERA = CameraParams(width_px=40, height_px=29, noise_grey=0)
BOX = World(camera=CAMERA)
ROUND = World(room=RoomParams(shape="circle"), camera=CAMERA)
FURNISHED = replace(
    BOX,
    body=BodyParams(bars=5, bands_grey=(0.0, 30.0, -20.0)),
    obstacles=(
        Obstacle(x_cm=50, y_cm=40),
        Obstacle(x_cm=20, y_cm=40, height_cm=5, radius_cm=4),
        Obstacle(x_cm=35, y_cm=12, height_cm=1, radius_cm=3, pattern="plain"),
    ),
)
WIDE = replace(BOX, camera=replace(CAMERA, fov_deg=140.0))


def compare(world, camera, bodies):
    scene = build_scene(world, 11)
    seen = Eye(scene, world.camera, engine="core").views([camera], np.reshape(bodies, (-1, 3)))[0]
    off = seen - by_rays(scene, camera, bodies, RAYS, world.camera)
    where = np.unravel_index(np.abs(off).argmax(), off.shape)
    assert np.abs(off).max() < 10, f"{seen[where]} at {where} from {camera}"
    assert (np.abs(off) > 3.5).mean() < 0.01
    assert np.abs(off).mean() < 0.4  # rounding alone makes 0.25
    assert abs(off.mean()) < 0.2  # a column before a near wall is all of one rounding


def clear_bodies(rng, world, camera, count):
    """Discs that overlap neither each other nor the camera's own, as the arena keeps them."""
    width, depth = world.room.size_cm
    discs = [camera[:2]]
    while len(discs) <= count:
        place = rng.uniform((2, 2), (width - 2, depth - 2))
        clear = all(np.hypot(*(place - disc)) > 4 for disc in discs)
        posts = all(np.hypot(place[0] - o.x_cm, place[1] - o.y_cm) > 2 + o.radius_cm for o in world.obstacles)
        if clear and posts and world.wall_gap_cm(*place) > 2:
            discs.append(place)
    return [(*disc, rng.uniform(-4, 4)) for disc in discs[1:]]


@pytest.mark.parametrize("world", [BOX, ROUND, FURNISHED, WIDE], ids=["box", "round", "furnished", "wide"])
@pytest.mark.parametrize("seed", range(4))
def test_anywhere_in_the_room(world, seed):
    rng = np.random.default_rng(seed)
    width, depth = world.room.size_cm
    camera = np.array([*rng.uniform((0.2 * width, 0.2 * depth), (0.8 * width, 0.8 * depth)), rng.uniform(-4, 4)])
    compare(world, camera, clear_bodies(rng, world, camera, 6))


@pytest.mark.parametrize("world", [BOX, ROUND], ids=["box", "round"])
@pytest.mark.parametrize("gap_cm", [2.0, 0.7, 0.1])
@pytest.mark.parametrize("turn", [0.0, 0.6, 1.3, 1.55])
def test_near_a_wall(world, gap_cm, turn):
    """The pupil ``gap_cm`` from the wall on the right, turned from facing it to looking along it."""
    width, depth = world.room.size_cm
    x = width - gap_cm - CAMERA.ahead_cm * np.cos(turn)
    camera = (x, depth / 2 - CAMERA.ahead_cm * np.sin(turn), turn)
    compare(world, camera, [(width - 2.5, depth / 2 + 8, 0.0)])


@pytest.mark.parametrize("heading", [np.pi / 4, 0.2, 1.4, np.pi / 4 + 0.5])
def test_in_a_corner(heading):
    compare(BOX, (66.5, 51.5, heading), [(60.0, 53.0, 0.0), (68.0, 47.0, 1.0)])


@pytest.mark.parametrize("gap_cm", [4.0, 1.0, 0.3, 0.1])
@pytest.mark.parametrize("aside_deg", [0.0, 25.0, 60.0, 88.0])
@pytest.mark.parametrize("world", [BOX, FURNISHED], ids=["plain", "patterned"])
def test_a_body_right_before_the_pupil(world, gap_cm, aside_deg):
    camera = np.array([30.0, 25.0, 0.3])
    pupil = camera[:2] + 1.33 * np.array([np.cos(0.3), np.sin(0.3)])
    bearing = 0.3 + np.radians(aside_deg)
    body = pupil + (2 + gap_cm) * np.array([np.cos(bearing), np.sin(bearing)])
    compare(world, camera, [(*body, 0.5)])


def test_bodies_one_behind_the_other():
    compare(BOX, (10.0, 27.5, 0.0), [(20.0, 27.5, 0.0), (26.0, 28.5, 0.0), (40.0, 24.0, 0.0), (60.0, 27.5, 0.0)])


def test_a_low_obstacle_behind_and_before_a_robot():
    low = Obstacle(x_cm=30, y_cm=27.5, radius_cm=3, height_cm=1, pattern="plain")
    world = replace(BOX, obstacles=(low,))
    compare(world, (15.0, 27.5, 0.0), [(40.0, 27.0, 0.0)])
    compare(world, (15.0, 27.5, 0.0), [(23.0, 28.0, 0.0)])


def test_a_pupil_outside_the_room_and_inside_a_body():
    """Both are moved to just inside, or just outside, in the same way."""
    compare(BOX, (70.5, 30.0, 2.0), [])
    compare(ROUND, (70.5, 30.0, 2.0), [])
    compare(BOX, (30.0, 30.0, 0.0), [(31.9, 30.6, 0.0)])
