from __future__ import annotations

import math

import numpy as np
import pytest

from lobula.errors import ParameterError
from lobula.overhead import MarkerParams, Reference, Room, TopCameraParams, read_points
from lobula.overhead.calibration import from_corners, from_points, from_scale
from lobula.overhead.camera import TopCamera
from lobula.overhead.lens import Lens

pytest.importorskip("cv2")

ROOM = Room(40.0, 30.0)
LENS = Lens(440, 340)
CORNERS = np.array([[19.5, 319.5], [419.5, 319.5], [419.5, 19.5], [19.5, 19.5]])
"""Of the room at 10 px/cm in the middle of the picture."""

GRID = np.stack(np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 30, 4)), axis=-1).reshape(-1, 2)


def seen(camera: TopCamera, points, z: float):
    return camera.to_px(np.column_stack([points, np.full(len(points), z)]))


def test_corners_and_scale_by_hand():
    for one in (from_corners(ROOM, CORNERS, LENS), from_scale(ROOM, 10.0, LENS)):
        assert one.to_cm([219.5, 169.5]) == pytest.approx([20.0, 15.0])
        assert one.to_cm([[19.5, 319.5], [29.5, 299.5]]) == pytest.approx(np.array([[0.0, 0.0], [1.0, 2.0]]), abs=1e-6)
        assert math.isnan(one.error_cm)


@pytest.mark.parametrize(
    ("order", "says"),
    [((3, 2, 1, 0), "run clockwise"), ((0, 2, 1, 3), "convex"), ((0, 0, 2, 3), "32 px apart")],
)
def test_corners_in_a_wrong_order(order, says):
    with pytest.raises(ParameterError, match=says):
        from_corners(ROOM, CORNERS[list(order)], LENS)


@pytest.mark.parametrize("settings", [{}, {"tilt_deg": 20.0}, {"tilt_deg": 35.0, "towards_deg": 30.0}])
def test_discs_above_the_corners(settings):
    params = TopCameraParams(height_cm=90.0, **settings)
    camera = TopCamera(ROOM, params)
    lens = Lens(camera.width, camera.height)
    above_cm = 90.0 * math.cos(math.radians(params.tilt_deg))
    on_floor = from_corners(ROOM, seen(camera, ROOM.corners_cm, 0.0), lens)
    discs = seen(camera, GRID, 3.0)
    assert np.abs(on_floor.to_cm(discs) - GRID).max() > 0.5  # cm
    assert np.abs(on_floor.raised(3.0, above_cm).to_cm(discs) - GRID).max() < 1e-4
    on_wall = from_corners(ROOM, seen(camera, ROOM.corners_cm, 12.0), lens)
    assert np.abs(on_wall.raised(-9.0, above_cm - 12.0).to_cm(discs) - GRID).max() < 1e-4


def test_a_camera_height_that_cannot_be():
    """Seen at 35 degrees from far off, and said to hang 1 km up."""
    camera = TopCamera(ROOM, TopCameraParams(height_cm=90.0, tilt_deg=35.0))
    one = from_corners(ROOM, seen(camera, ROOM.corners_cm, 0.0), Lens(camera.width, camera.height))
    with pytest.raises(ParameterError, match="camera height 100000 cm"):
        one.raised(3.0, 1e5)


def test_points_fit_the_lens():
    """The pictures are bent the way OpenCV's k1 does; that is undone by another formula, so not quite to nothing."""
    camera = TopCamera(ROOM, TopCameraParams(height_cm=90.0, tilt_deg=10.0, lens_k1=-0.1))
    lens = Lens(camera.width, camera.height)
    px = seen(camera, GRID, 3.0)
    fitted = from_points(px, GRID, lens)
    assert np.abs(fitted.to_cm(px) - GRID).max() < 0.02
    assert fitted.error_cm < 0.01
    corners = from_corners(ROOM, seen(camera, ROOM.corners_cm, 3.0), lens)
    assert np.abs(corners.to_cm(px) - GRID).max() > 0.3


def test_points_that_do_not_do():
    with pytest.raises(ParameterError, match="3 reference points: must be at least 4"):
        from_points(CORNERS[:3], ROOM.corners_cm[:3], LENS)
    with pytest.raises(ParameterError, match="in one line"):
        from_points(np.column_stack([np.arange(5), np.arange(5)]) * 50.0, GRID[:5], LENS)
    with pytest.raises(ParameterError, match="mirrored"):
        from_points(CORNERS, ROOM.corners_cm * (1, -1), LENS)


def test_points_from_a_file(tmp_path):
    path = tmp_path / "points.csv"
    path.write_text("name,x_px,y_px,x_cm,y_cm\n" + "".join(
        f"p,{u},{v},{x},{y}\n" for (u, v), (x, y) in zip(CORNERS, ROOM.corners_cm, strict=True)
    ))  # fmt: skip
    px, cm = read_points(path)
    assert np.array_equal(px, CORNERS)
    assert np.array_equal(cm, ROOM.corners_cm)
    path.write_text("x_px,y_px\n1,2\n")
    with pytest.raises(ParameterError, match="x_px, y_px, x_cm, y_cm"):
        read_points(path)
    with pytest.raises(ParameterError, match="cannot be read"):
        read_points(tmp_path / "none.csv")


class TestReference:
    def test_exactly_one(self):
        with pytest.raises(ParameterError, match="exactly one"):
            Reference()
        with pytest.raises(ParameterError, match="exactly one"):
            Reference(px_per_cm=10.0, corner_ids=(1, 2, 3, 4))

    @pytest.mark.parametrize(
        "settings",
        [
            {"corners_px": CORNERS[:3]},
            {"corner_ids": (1, 2, 3)},
            {"corner_ids": (1, 2, 3, 3)},
            {"px_per_cm": 0.0},
            {"px_per_cm": math.nan},
            {"px_per_cm": 10.0, "camera_cm": -5.0},
            {"px_per_cm": 10.0, "plane_cm": -5.0},
        ],
    )
    def test_values_that_are_none(self, settings):
        with pytest.raises(ParameterError):
            Reference(**settings)

    def test_the_height_of_the_camera_counts_only_where_heights_differ(self):
        marker = MarkerParams()
        level = Reference(corners_px=CORNERS, plane_cm=3.0, camera_cm=100.0).calibration(ROOM, LENS, marker)
        assert level.to_cm([119.5, 169.5]) == pytest.approx([10.0, 15.0])
        # 3 cm up and seen from 100 cm: what seems 10 cm from the middle is 9.7 cm from it
        floor = Reference(corners_px=CORNERS, camera_cm=100.0)
        assert floor.calibration(ROOM, LENS, marker).to_cm([119.5, 169.5]) == pytest.approx([10.3, 15.0])
        assert floor.ground(ROOM, LENS).to_cm([119.5, 169.5]) == pytest.approx([10.0, 15.0])

    def test_a_far_camera_is_assumed_and_said(self):
        (note,) = Reference(corners_px=CORNERS).notes(MarkerParams())
        assert "3 cm above the reference" in note
        assert not Reference(corners_px=CORNERS, camera_cm=90.0).notes(MarkerParams())
        assert not Reference(corner_ids=(1, 2, 3, 4)).notes(MarkerParams())

    def test_a_camera_below_the_robots(self):
        with pytest.raises(ParameterError, match="camera_cm = 10"):
            Reference(corners_px=CORNERS, plane_cm=12.0, camera_cm=10.0).calibration(ROOM, LENS, MarkerParams())

    def test_a_corner_that_is_not_found(self):
        with pytest.raises(ParameterError, match="corner marker 46: was found in no frame"):
            Reference(corner_ids=(46, 47, 48, 49)).calibration(ROOM, LENS, MarkerParams())
