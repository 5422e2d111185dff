"""What the cameras see, in both engines: places, sizes, slow motion, what is left out, light, noise, and bad input."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.arena.eye import Eye
from lobula.arena.reference_eye import blurred, sensed
from lobula.arena.scene import Cylinder, build_scene
from lobula.arena.world import BodyParams, CameraParams, Obstacle, RoomParams, World
from lobula.engine.library import available
from lobula.errors import ParameterError, ShapeError

from .views import FOCAL_PX, NOBODY, QUIET, ROOM, mirrored, mirrored_poses, picture

ENGINES = [*(["core"] if available() else []), "reference"]
NOISY = CameraParams(noise_grey=2.0)
needs_core = pytest.mark.skipif(not available(), reason="the C core was not built")

FURNISHED = World(
    body=BodyParams(bars=5, bands_grey=(0.0, 30.0, -20.0)),
    obstacles=(
        Obstacle(x_cm=50, y_cm=40),
        Obstacle(x_cm=20, y_cm=40, height_cm=5, radius_cm=4),
        Obstacle(x_cm=35, y_cm=12, height_cm=1, radius_cm=3, pattern="plain"),
    ),
)


def fine(scene, camera, bodies=NOBODY):
    """The picture to a hundredth of a grey: the mean over noise that dithers the rounding; the same noise each time."""
    count = 1500
    eye = Eye(scene, NOISY, engine="core")
    views = eye.views(np.tile(camera, (count, 1)), np.reshape(bodies, (-1, 3)), keys=np.arange(count))
    return views.mean(axis=0)


# ---- Places and sizes.


@pytest.mark.parametrize("distance_cm", [4.0, 8.0, 16.0, 32.0])
def test_a_body_of_4_cm_covers_the_columns_it_must(distance_cm):
    """Its silhouettes are tangents: 2 f tan(asin(2 / distance)) columns apart; half a grey at each is 0.02 columns."""
    row = picture(ROOM, (20.0, 27.5, 0.0), (21.33 + distance_cm, 27.5, 0.0))[36]
    covered = (100 - row.astype(float)).sum() / 50
    assert covered == pytest.approx(min(2 * FOCAL_PX * 2 / np.sqrt(distance_cm**2 - 4), 99), abs=0.03)


@pytest.mark.parametrize("heading", np.linspace(-np.pi, np.pi, 9))
def test_a_body_stands_where_it_must(heading):
    """8 cm ahead of the pupil and 2 cm to the left: tangents at atan(1 / 4) +- asin(2 / sqrt(68))."""
    ahead, left = np.array([np.cos(heading), np.sin(heading)]), np.array([-np.sin(heading), np.cos(heading)])
    camera = np.array([30.0, 25.0])
    body = camera + (1.33 + 8) * ahead + 2 * left
    row = picture(ROOM, (*camera, heading), (*body, 0.0))[36].astype(float)
    middle, half = np.arctan2(2, 8), np.arcsin(2 / np.sqrt(68))
    first, last = 49.5 - FOCAL_PX * np.tan(middle + half), 49.5 - FOCAL_PX * np.tan(middle - half)
    inside = np.clip(np.minimum(np.arange(99) + 1, last) - np.maximum(np.arange(99), first), 0, 1)
    assert row == pytest.approx(100 - 50 * inside, abs=0.6)


def test_corners_and_walls_of_the_box():
    """Each wall its own grey; looking along the diagonal of a square room the corner is in the middle."""
    greys = np.repeat([60.0, 90.0, 120.0, 150.0], 10)  # lower, right, upper, left
    scene = replace(ROOM, size_cm=(50.0, 50.0), wall_grey=greys)
    for quarter, (right, left) in enumerate([(90, 120), (120, 150), (150, 60), (60, 90)]):
        row = picture(scene, (25.0, 25.0, np.pi / 4 + quarter * np.pi / 2))[36]
        assert row[:49].tolist() == [left] * 49
        assert row[50:].tolist() == [right] * 49
        assert abs(row[49] - (left + right) / 2) <= 0.5


def test_a_round_room_seen_from_its_middle():
    """Quarters of the wall change at headings 0, 90, ...; the pupil is 1.33 cm off the middle, along the axis."""
    scene = replace(ROOM, shape="circle", size_cm=(60.0, 60.0), wall_grey=np.array([60.0, 90.0, 120.0, 150.0]))
    for quarter, (left, right) in enumerate([(60, 150), (90, 60), (120, 90), (150, 120)]):
        row = picture(scene, (30.0, 30.0, quarter * np.pi / 2))[36]
        assert row[:49].tolist() == [left] * 49
        assert row[50:].tolist() == [right] * 49


# ---- Slow motion: a tenth of a pixel, an edge of 50 greys, 5 greys.


@needs_core
@pytest.mark.parametrize("column", [12.0, 60.3, 49.95, 80.7])
def test_a_stripe_moves_by_a_tenth_of_a_pixel(column):
    """An edge in the middle of the right wall, 20 cm ahead; the pupil moves sideways."""
    greys = np.full(12500, 100.0)
    greys[:4875] = 50.0  # 97.5 cm on: 70 along the lower wall, then 27.5 up
    scene = replace(ROOM, wall_grey=greys)
    before, after = (
        fine(scene, (70 - 20 - 1.33, 27.5 + (at - 49.5) * 20 / FOCAL_PX, 0.0)) for at in (column, column + 0.1)
    )
    change = (after - before)[30]
    edge = int(column)
    assert change[edge : edge + 2].sum() == pytest.approx(5, abs=0.5)
    assert np.abs(np.delete(change, [edge, edge + 1])).max() < 0.2


@needs_core
@pytest.mark.parametrize("aside_cm", [-1.3, 0.0, 0.71, 2.9])
def test_a_silhouette_moves_by_a_tenth_of_a_pixel(aside_cm):
    def silhouette(y):
        return 49.5 - FOCAL_PX * np.tan(np.arctan2(27.5 - y, 15) + np.arcsin(2 / np.hypot(27.5 - y, 15)))

    y = 27.5 + aside_cm
    step = 0.1 * 1e-6 / (silhouette(y + 1e-6) - silhouette(y))  # cm for a tenth of a pixel
    before, after = (fine(ROOM, (20.0, at, 0.0), (36.33, 27.5, 0.0)) for at in (y, y + step))
    change = (after - before)[36]
    edge = int(silhouette(y))
    assert change[edge - 1 : edge + 2].sum() == pytest.approx(5, abs=0.5)


@needs_core
@pytest.mark.parametrize("what", ["wall", "body"])
@pytest.mark.parametrize("row", [10.0, 15.35, 27.8])
def test_a_top_edge_moves_by_a_tenth_of_a_pixel(what, row):
    """Towards the middle of the wall, or of a body as high: depth = f (height - 1.6) / (36 - row)."""
    height = 12.0 if what == "wall" else 3.0
    scene = ROOM if what == "body" else replace(ROOM, wall_grey=np.array([50.0]), size_cm=(200.0, 200.0))
    before, after = (FOCAL_PX * (height - 1.6) / (36 - at) for at in (row, row - 0.1))
    if what == "wall":
        pictures = [fine(scene, (200 - 1.33 - depth, 100.0, 0.0)) for depth in (before, after)]
    else:
        pictures = [fine(scene, (20.0, 27.5, 0.0), (21.33 + 2 + depth, 27.5, 0.0)) for depth in (before, after)]
    change = (pictures[1] - pictures[0])[:, 49]
    edge = int(row)
    assert change[edge - 1 : edge + 2].sum() == pytest.approx(-5, abs=0.5)
    assert np.abs(change[: edge - 1]).max(initial=0) < 0.2


# ---- Symmetry.


@needs_core
@pytest.mark.parametrize("shape", ["box", "circle"])
def test_a_mirrored_world_gives_a_mirrored_picture(shape):
    world = replace(FURNISHED, room=RoomParams(shape=shape))
    scene = build_scene(world, 3)
    rng = np.random.default_rng(4)
    width, depth = scene.size_cm
    cameras = np.column_stack(
        [rng.uniform(15, width - 15, 40), rng.uniform(15, depth - 15, 40), rng.uniform(-9, 9, 40)]
    )
    bodies = np.column_stack([rng.uniform(5, width - 5, 6), rng.uniform(5, depth - 5, 6), rng.uniform(-9, 9, 6)])
    seen = Eye(scene, QUIET).views(cameras, bodies)
    turned = Eye(mirrored(scene), QUIET).views(mirrored_poses(cameras, width), mirrored_poses(bodies, width))
    assert np.abs(seen.astype(int) - turned[:, :, ::-1]).max() <= 1


@needs_core
def test_a_round_room_turned_with_all_in_it_looks_the_same():
    scene = replace(ROOM, shape="circle", size_cm=(60.0, 60.0), floor_grey=30.0)
    pose, body = np.array([40.0, 30.0, 0.4]), np.array([48.0, 33.0, 0.0])
    first = picture(scene, pose, body)
    for angle in (0.3, 2.0, 4.0):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        moved = [np.array([*(30 + turn @ (p[:2] - 30)), p[2] + angle]) for p in (pose, body)]
        assert np.abs(picture(scene, *moved).astype(int) - first).max() <= 1


# ---- What is left out, light, blur, noise.


@pytest.mark.parametrize("engine", ENGINES)
def test_what_is_not_shown(engine):
    scene = replace(build_scene(FURNISHED, 1), body=ROOM.body)
    eye = Eye(scene, QUIET, engine=engine)
    camera = (10.0, 27.5, 0.2)
    bodies = np.array([[10.0, 27.5, 0.2], [22.0, 30.0, 0.0], [18.0, 26.0, 0.0]])

    def seen(some, **left_out):
        return eye.views([camera], some, **{name: [value] for name, value in left_out.items()})[0]

    alone = seen(NOBODY)
    assert np.array_equal(seen(bodies, own=0), seen(bodies[1:]))
    assert np.array_equal(seen(bodies, own=1), seen(bodies[[0, 2]]))
    assert not np.array_equal(seen(bodies, own=-1), seen(bodies, own=1))
    assert np.array_equal(seen(bodies, own=0, shown=[True, False, True]), seen(bodies[2:]))
    assert np.array_equal(seen(bodies, shown=[False] * 3), alone)
    fewer = replace(scene, obstacles=scene.obstacles[1:2], obstacle_poses=scene.obstacle_poses[1:2])
    without = Eye(fewer, QUIET, engine=engine).views([camera], bodies[1:])[0]
    assert np.array_equal(seen(bodies, own=0, obstacles=[False, True, False]), without)
    plain = replace(scene, wall_grey=np.array([scene.wall_grey.mean()]))
    without = Eye(plain, QUIET, engine=engine).views([camera], bodies[1:])[0]
    assert np.array_equal(seen(bodies, own=0, walls=False), without)
    assert not np.array_equal(seen(bodies, own=0, walls=True), without)


@pytest.mark.parametrize("engine", ENGINES)
def test_light_is_a_gain_on_everything(engine):
    eye = Eye(build_scene(World(), 1), QUIET, engine=engine)
    camera, bodies = (20.0, 20.0, 1.0), [[25.0, 30.0, 0.0]]
    lit = eye.views([camera] * 4, bodies, light=[1.0, 0.5, 0.0, 3.0]).astype(float)
    assert np.abs(lit[1] - lit[0] / 2).max() <= 0.75
    assert lit[2].max() == 0
    assert np.abs(lit[3] - np.minimum(3 * lit[0], 255)).max() <= 2
    assert lit[3].max() == 255


@needs_core
@pytest.mark.parametrize("blur_px", [0.4, 1.0, 4.0])
def test_blur(blur_px):
    scene = build_scene(FURNISHED, 2)
    camera, bodies = (20.0, 20.0, 0.5), [[30.0, 25.0, 0.0]]
    sharp, soft = (picture(scene, camera, bodies, params=replace(QUIET, blur_px=b)) for b in (0.0, blur_px))
    assert np.abs(blurred(sharp.astype(float), blur_px) - soft).max() <= 1.01  # both were rounded
    assert np.diff(soft.astype(int), axis=1).std() < np.diff(sharp.astype(int), axis=1).std()


@needs_core
@pytest.mark.parametrize("noise_grey", [0.01, 1.5, 20.0, 100.0])
@pytest.mark.parametrize("size", [(99, 72), (32, 24), (61, 47)])
def test_noise_alone_is_the_same_in_both_engines(size, noise_grey):
    params = CameraParams(width_px=size[0], height_px=size[1], noise_grey=noise_grey)
    keys = [0, 1, 2**63 + 5, 2**64 - 1]
    eyes = [Eye(ROOM, params, engine=engine) for engine in ("core", "reference")]
    ours, theirs = (eye.views([(20.0, 27.5, 0.0)] * 4, NOBODY, keys=np.array(keys, np.uint64)) for eye in eyes)
    assert np.array_equal(ours, theirs)
    for image, key in zip(ours, keys, strict=True):
        assert np.array_equal(image, sensed(np.full((size[1], size[0]), 100.0), noise_grey, key))


@pytest.mark.parametrize("engine", ENGINES)
def test_noise_is_a_function_of_the_key(engine):
    eye = Eye(ROOM, NOISY, engine=engine)
    a, b, c = eye.views([(20.0, 27.5, 0.0)] * 3, NOBODY, keys=[5, 5, 6])
    assert np.array_equal(a, b)
    assert abs(np.corrcoef(a.ravel(), c.ravel())[0, 1]) < 4 / np.sqrt(a.size)
    assert a.mean() == pytest.approx(100, abs=4 * 2 / np.sqrt(a.size))
    assert a.std() == pytest.approx(np.sqrt(4 + 1 / 12), rel=0.03)


# ---- Any pose, many views, bad input.

places = st.one_of(st.floats(-80, 150), st.sampled_from([0.0, 1e-9, 0.01, 27.5, 55.0, 70.0, 68.67]))
poses = st.tuples(places, places, st.one_of(st.floats(-20, 20), st.sampled_from([0.0, np.pi / 2, -np.pi])))


@pytest.mark.parametrize("engine", ENGINES)
@settings(max_examples=40, deadline=None)
@given(shape=st.sampled_from(["box", "circle"]), camera=poses, bodies=st.lists(poses, max_size=4), onto=st.booleans())
def test_any_pose_gives_a_picture_of_what_there_is(engine, shape, camera, bodies, onto):
    small = CameraParams(width_px=32, height_px=24, noise_grey=0)
    low = Cylinder(radius_cm=6.0, height_cm=0.5, bands_grey=np.array([90.0, 110.0]))
    scene = replace(
        ROOM, shape=shape, size_cm=(70.0, 70.0) if shape == "circle" else (70.0, 55.0),
        wall_grey=np.array([70.0, 130.0, 75.0, 125.0]), obstacles=(low,), obstacle_poses=np.array([[30.0, 27.5, 0.0]]),
        body=replace(ROOM.body, around_grey=np.array([0.0, 40.0, 20.0])),
    )  # fmt: skip
    if onto:
        bodies = [*bodies, camera]
    image = Eye(scene, small, engine=engine).views([camera], np.reshape(bodies, (-1, 3)))[0]
    assert image.min() >= 50
    assert image.max() <= 130


@needs_core
@settings(max_examples=25, deadline=None)
@given(st.lists(poses, min_size=1, max_size=5), st.lists(poses, max_size=5))
def test_a_view_does_not_depend_on_the_others(cameras, bodies):
    eye = Eye(build_scene(FURNISHED, 1), CameraParams())
    there = np.reshape(bodies, (-1, 3))
    keys = np.arange(len(cameras))
    together = eye.views(cameras, there, keys=keys)
    repeated = eye.views(cameras, np.broadcast_to(there, (len(cameras), *there.shape)), keys=keys)
    assert np.array_equal(together, repeated)
    for i, camera in enumerate(cameras):
        assert np.array_equal(eye.views([camera], there, keys=keys[i : i + 1])[0], together[i])


@pytest.mark.parametrize("engine", ENGINES)
def test_out_is_written(engine):
    eye = Eye(ROOM, QUIET, engine=engine)
    out = np.zeros((2, 72, 99), np.uint8)
    given_back = eye.views([(20.0, 27.5, 0.0)] * 2, NOBODY, out=out)
    assert given_back is out
    assert out.min() == 100
    assert eye.views(np.zeros((0, 3)), NOBODY).shape == (0, 72, 99)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("changed", "error", "message"),
    [
        ({"cameras": [[1.0, 2.0]]}, ShapeError, r"cameras \(1, 2\): must be \(N, 3\)"),
        ({"cameras": [[1.0, np.nan, 0.0]]}, ParameterError, "cameras: every number must be finite"),
        ({"cameras": [["here", 0, 0]]}, ParameterError, "cameras: could not convert"),
        ({"bodies": [1.0, 2.0, 3.0]}, ShapeError, r"bodies \(3,\): must be \(1, B, 3\) or \(B, 3\)"),
        ({"bodies": np.zeros((2, 4, 3))}, ShapeError, r"bodies \(2, 4, 3\): must be \(1, B, 3\)"),
        ({"bodies": [[1.0, np.inf, 0.0]]}, ParameterError, "bodies: every number must be finite"),
        ({"own": [1]}, ParameterError, "own: must be the index of one of 1 bodies, or -1"),
        ({"own": [0, 0]}, ShapeError, r"own \(2,\): must be \(1,\)"),
        ({"keys": [-1]}, ParameterError, "keys: "),
        ({"light": [-0.5]}, ParameterError, r"light: every gain must be in \[0, 1000\]"),
        ({"light": [np.nan]}, ParameterError, "light: every gain"),
        ({"shown": [[True, True]]}, ShapeError, r"shown \(1, 2\): must be \(1, 1\)"),
        ({"obstacles": [[True]]}, ShapeError, r"obstacles \(1, 1\): must be \(1, 0\)"),
        ({"walls": True}, ShapeError, r"walls \(\): must be \(1,\)"),
        ({"out": np.zeros((1, 72, 98), np.uint8)}, ShapeError, r"out: uint8 \(1, 72, 98\): must be contiguous uint8"),
        ({"out": np.zeros((1, 72, 99))}, ShapeError, "out: float64"),
        ({"out": np.zeros((1, 99, 72), np.uint8).transpose(0, 2, 1)}, ShapeError, "out: .* must be contiguous"),
    ],
)
def test_what_it_refuses(engine, changed, error, message):
    arguments = {"cameras": [[20.0, 27.5, 0.0]], "bodies": [[30.0, 27.5, 0.0]], **changed}
    with pytest.raises(error, match=rf"Eye\.views: {message}"):
        Eye(ROOM, QUIET, engine=engine).views(arguments.pop("cameras"), arguments.pop("bodies"), **arguments)


def test_unknown_engine():
    with pytest.raises(ParameterError, match="engine 'eyes': must be one of auto, core, reference"):
        Eye(ROOM, QUIET, engine="eyes")
