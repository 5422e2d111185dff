from __future__ import annotations

import math

import numpy as np
import pytest

from lobula.errors import ParameterError, ShapeError
from lobula.overhead import Room, TopCameraParams, TopView

from .scenes import ROOM

pytest.importorskip("cv2")

CAMERA = TopCameraParams(px_per_cm=10.0, margin_cm=3.0)


@pytest.fixture(scope="module")
def view():
    return TopView(ROOM, camera=CAMERA)


@pytest.fixture(scope="module")
def empty(view):
    return view.picture(np.empty((0, 3))).astype(float)


def test_the_empty_room(view, empty):
    """36 x 28 cm at 10 px/cm with 3 cm around: floor from column 30 to 390, then 1 cm of rim."""
    assert empty.shape == (340, 420)
    assert set(np.unique(empty[30:310, 30:390])) == {60.0}
    assert set(np.unique(empty[22:28, 30:390])) == {200.0}
    assert empty[5, 5] == 120.0


def test_a_disc_covers_its_area(view, empty):
    """The disc's paper is 175 grey above the floor, its ink 40 below: both areas are known."""
    from lobula.overhead.markers import marker_cells

    black_cm2 = marker_cells(3).sum() * 0.4**2
    expected = (235 - 60) * (math.pi * 2**2 - black_cm2) + (20 - 60) * black_cm2
    for pose in ([18.0, 14.0, 0.0], [18.037, 14.061, 0.7], [9.911, 20.123, -2.0]):
        added = view.picture(np.array([pose]), [3]).astype(float) - empty
        assert added.sum() / 10**2 == pytest.approx(expected, rel=2e-3)


def test_a_tenth_of_a_pixel_moves_the_picture_by_it(view, empty):
    def middle(x, y):
        added = np.abs(view.picture(np.array([[x, y, 0.4]]), [5]).astype(float) - empty)
        rows, columns = np.mgrid[: added.shape[0], : added.shape[1]]
        return (added * columns).sum() / added.sum(), (added * rows).sum() / added.sum()

    before, after = middle(18.0, 14.0), middle(18.01, 14.01)
    assert after[0] - before[0] == pytest.approx(0.1, abs=0.03)
    assert after[1] - before[1] == pytest.approx(-0.1, abs=0.03)  # y points up


def test_the_pattern_turns_with_the_robot(view):
    """Heading along x shows the pattern's first row on the right: turned by 90 degrees it is the picture turned."""
    east = view.picture(np.array([[17.0, 14.0, 0.0]]), [9])[150:190, 180:220]
    north = view.picture(np.array([[17.0, 14.0, math.pi / 2]]), [9])[150:190, 180:220]
    assert np.array_equal(np.rot90(east), north)


def test_noise_is_that_of_its_key(view):
    noisy = TopView(ROOM, camera=TopCameraParams(px_per_cm=10.0, noise_grey=4.0), samples=2)
    a, again, b = (noisy.picture(np.empty((0, 3)), noise_key=key) for key in (1, 1, [1, 2]))
    assert np.array_equal(a, again)
    assert a[100:200, 100:300].std() == pytest.approx(4.0, rel=0.05)
    assert not np.array_equal(a, b)


def test_blur_keeps_the_sum(view):
    blurred = TopView(ROOM, camera=TopCameraParams(px_per_cm=10.0, blur_px=2.0))
    poses = np.array([[18.0, 14.0, 0.3]])
    sharp, soft = view.picture(poses).astype(float), blurred.picture(poses).astype(float)
    assert soft[100:240, 100:320].sum() == pytest.approx(sharp[100:240, 100:320].sum(), rel=1e-3)
    assert np.abs(np.diff(soft, axis=1)).max() < np.abs(np.diff(sharp, axis=1)).max() / 2


def test_in_perspective_walls_show_and_hide():
    """From straight above, the inner faces of the walls are seen outside of the floor, striped."""
    above = TopView(ROOM, camera=TopCameraParams(px_per_cm=10.0, margin_cm=6.0, height_cm=60.0), samples=2)
    picture = above.picture(np.empty((0, 3)))
    x, y = above.camera.to_px(np.array([36.0, 14.0, 0.0])).astype(int)
    face = picture[y - 60 : y + 60, x + 10 : x + 30]
    assert set(np.unique(face)) >= {150, 210}
    # a camera far to the side of the near wall sees it cover the floor behind it, and the robot there
    aside = TopView(
        ROOM, camera=TopCameraParams(px_per_cm=10.0, margin_cm=12.0, height_cm=80.0, tilt_deg=40.0), samples=2
    )
    hidden, shown = (aside.picture(np.array([[18.0, y, 0.0]])) for y in (2.0, 14.0))
    assert np.count_nonzero(hidden == 235) < np.count_nonzero(shown == 235) / 2


def test_obstacles_and_sides_are_seen_in_perspective():
    settings = TopCameraParams(px_per_cm=10.0, margin_cm=6.0, height_cm=60.0)
    above = TopView(ROOM, camera=settings, obstacles_cm=[(28.0, 14.0, 2.5)], samples=2)
    picture = above.picture(np.array([[8.0, 14.0, 0.0]]))
    top = above.camera.to_px(np.array([28.0, 14.0, 12.0])).astype(int)
    foot = above.camera.to_px(np.array([28.0 - 2.0, 14.0, 0.0])).astype(int)
    assert picture[top[1], top[0]] == picture[foot[1], foot[0]] == 175
    side = above.camera.to_px(np.array([8.0 + 1.9, 14.0, 0.3])).astype(int)  # the side that faces the lens
    assert picture[side[1], side[0]] == 45


def test_corner_patterns_lie_on_the_corners_of_a_circle_too():
    room = Room(20.0, 20.0, "circle")
    view = TopView(room, camera=TopCameraParams(px_per_cm=10.0, margin_cm=4.0), corner_ids=(46, 47, 48, 49), samples=2)
    picture = view.picture(np.empty((0, 3)))
    for x, y in room.corners_cm:
        column, row = view.camera.to_px(np.array([x + 1.6, y, 3.0])).astype(int)
        assert picture[row, column] == 235


def test_wrong_requests(view):
    with pytest.raises(ShapeError, match=r"must be \(R, 3\)"):
        view.picture(np.zeros(3))
    with pytest.raises(ShapeError, match="1 ids for 2 poses"):
        view.picture(np.zeros((2, 3)), [1])
    with pytest.raises(ParameterError, match="different numbers"):
        view.picture(np.zeros((2, 3)), [1, 1])
    with pytest.raises(ParameterError, match="px_per_cm = 1"):
        TopCameraParams(px_per_cm=1.0)
