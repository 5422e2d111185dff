from __future__ import annotations

import numpy as np
import pytest

from lobula.overhead.edges import refine_corners

pytest.importorskip("cv2")


def square(middle, side, angle, size=80):
    """A dark square on white, every pixel the mean of 16 x 16 points; and its corners, as a detector orders them."""
    fine = (np.arange(16 * size) + 0.5) / 16 - 0.5
    u, v = np.meshgrid(fine - middle[0], fine - middle[1])
    a, b = u * np.cos(angle) + v * np.sin(angle), v * np.cos(angle) - u * np.sin(angle)
    inside = (np.abs(a) < side / 2) & (np.abs(b) < side / 2)
    image = 230 - 200 * inside.reshape(size, 16, size, 16).mean(axis=(1, 3))
    own = side / 2 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return np.rint(image).astype(np.uint8), own @ turn.T + middle


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.785, 2.0])
def test_corners_to_a_twentieth_of_a_pixel(angle):
    image, corners = square((40.3, 38.8), 26.0, angle)
    rough = corners + np.array([[0.7, -0.4], [-0.6, 0.5], [0.3, 0.8], [-0.8, -0.2]])
    found = refine_corners(image, rough[None], 6)[0]
    assert np.abs(found - corners).max() < 0.05


def test_several_at_once_and_in_other_orders():
    image, corners = square((40.3, 38.8), 26.0, 0.3)
    turned = np.roll(corners, 1, axis=0)
    found = refine_corners(image, np.stack([corners, turned]), 6)
    assert found[1] == pytest.approx(np.roll(found[0], 1, axis=0), abs=0.02)


def test_where_there_is_no_edge_it_says_so():
    corners = np.array([[20, 20], [40, 20], [40, 40], [20, 40]], float)
    assert np.isnan(refine_corners(np.full((60, 60), 128, np.uint8), corners[None], 6)).all()
    bright = np.full((60, 60), 40, np.uint8)
    bright[20:41, 20:41] = 200  # bright on dark: not what a pattern's border is
    assert np.isnan(refine_corners(bright, corners[None], 6)).all()
