from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lobula.overhead import Room, TopCameraParams
from lobula.overhead.camera import TopCamera

ROOM = Room(40.0, 30.0)


def camera(**settings):
    return TopCamera(ROOM, TopCameraParams(**settings))


def test_straight_down_by_hand():
    """10 px/cm and 2 cm around: 440 x 340 px, the room's middle between pixels 219 and 220, and 169 and 170."""
    one = camera(px_per_cm=10.0, margin_cm=2.0)
    assert (one.width, one.height) == (440, 340)
    assert one.to_px(np.array([20.0, 15.0, 0.0])).tolist() == [219.5, 169.5]
    assert one.to_px(np.array([0.0, 0.0, 0.0])) == pytest.approx([19.5, 319.5])
    assert one.to_px(np.array([0.0, 30.0, 12.0])) == pytest.approx([19.5, 19.5])  # height makes no difference


def test_what_is_higher_is_seen_farther_out():
    """From 100 cm, a point 20 cm up and 15 cm from the middle is seen at 15 * 100 / 80 = 18.75 cm."""
    one = camera(px_per_cm=10.0, margin_cm=2.0, height_cm=100.0)
    assert one.to_px(np.array([35.0, 15.0, 20.0])) == pytest.approx([219.5 + 187.5, 169.5])
    assert one.foot_cm == pytest.approx([20.0, 15.0])


def test_a_tilted_camera_looks_from_its_side():
    one = camera(height_cm=100.0, tilt_deg=30.0, towards_deg=-90.0)
    assert one.foot_cm == pytest.approx([20.0, 15.0 - 50.0])
    left, right = (one.to_px(np.array([x, y, 0.0])) for x, y in ((0.0, 0.0), (40.0, 0.0)))
    far_left, far_right = (one.to_px(np.array([x, y, 0.0])) for x, y in ((0.0, 30.0), (40.0, 30.0)))
    assert right[0] - left[0] > far_right[0] - far_left[0]  # the near wall looks longer
    assert one.to_px(np.array([20.0, 15.0, 0.0])) == pytest.approx([(one.width - 1) / 2, (one.height - 1) / 2])


def test_barrel_distortion_pulls_the_corners_in():
    """r = 1 in the picture's corner is seen at 1 + k1."""
    straight, bent = camera(lens_k1=0.0), camera(lens_k1=-0.1)
    corner = np.array([-0.5, -0.5])
    there = np.append(straight.on_plane(corner, 0.0), 0.0)
    middle = np.array([(bent.width - 1) / 2, (bent.height - 1) / 2])
    assert bent.to_px(there) - middle == pytest.approx(0.9 * (corner - middle))


@given(
    st.floats(0, 40), st.floats(0, 30), st.floats(0, 12), st.floats(40, 1e6) | st.just(math.inf), st.floats(0, 25),
    st.floats(-180, 180), st.floats(-0.1, 0.1),
)  # fmt: skip
def test_back_from_the_picture(x, y, z, height, tilt, towards, k1):
    one = camera(height_cm=height, tilt_deg=tilt, towards_deg=towards, lens_k1=k1)
    px = one.to_px(np.array([x, y, z]))
    assert one.on_plane(px, z) == pytest.approx([x, y], abs=1e-6)
