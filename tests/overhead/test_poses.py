from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lobula.overhead import MarkerParams
from lobula.overhead.poses import fit_poses

MARKER = MarkerParams()  # 2.4 cm wide


def placed(x, y, heading, size=1.0):
    own = size * MARKER.corners_cm
    forward, left = np.array([math.cos(heading), math.sin(heading)]), np.array([-math.sin(heading), math.cos(heading)])
    return own[:, :1] * forward + own[:, 1:] * left + (x, y)


def test_by_hand():
    """Heading along y: front left is at x - 1.2, y + 1.2."""
    corners = np.array([[[8.8, 6.2], [11.2, 6.2], [11.2, 3.8], [8.8, 3.8]]])
    pose = fit_poses(corners, MARKER)
    assert (pose.x_cm[0], pose.y_cm[0]) == pytest.approx((10.0, 5.0))
    assert pose.heading_rad[0] == pytest.approx(math.pi / 2)
    assert pose.scale[0] == pytest.approx(1.0)
    assert pose.misfit[0] == pytest.approx(0.0, abs=1e-12)


@given(st.floats(0, 70), st.floats(0, 55), st.floats(-3.1, 3.1), st.floats(0.5, 2))
def test_any_pose_and_size(x, y, heading, size):
    pose = fit_poses(placed(x, y, heading, size)[None], MARKER)
    assert (pose.x_cm[0], pose.y_cm[0]) == pytest.approx((x, y), abs=1e-9)
    assert pose.heading_rad[0] == pytest.approx(heading, abs=1e-9)
    assert pose.scale[0] == pytest.approx(size)


def test_the_standard_errors_are_those_of_noisy_corners():
    rng = np.random.default_rng(0)
    corners = placed(20.0, 10.0, 1.0) + rng.normal(0, 0.02, (4000, 4, 2))
    pose = fit_poses(corners, MARKER)
    off_cm = np.sqrt(np.mean((pose.x_cm - 20) ** 2 + (pose.y_cm - 10) ** 2))
    assert np.sqrt(np.mean(pose.error_cm**2)) == pytest.approx(off_cm, rel=0.05)
    off_rad = np.sqrt(np.mean((pose.heading_rad - 1.0) ** 2))
    assert np.sqrt(np.mean(pose.error_rad**2)) == pytest.approx(off_rad, rel=0.05)
    assert off_cm == pytest.approx(0.02 / math.sqrt(2), rel=0.05)  # the mean of four corners, two coordinates
