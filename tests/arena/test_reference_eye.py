"""The slow renderer, against rows and columns worked out by hand, and the sensor's noise, against its statistics."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lobula.arena.reference_eye import ReferenceEye, blurred, noise, sensed
from lobula.arena.scene import Cylinder

from .views import FOCAL_PX, NOBODY, QUIET, ROOM, by_rays

SAMPLES = (16, 16)
HERE = (20.0, 27.5, 0.0)
"""In the middle of the room's depth, looking along x: the pupil at x = 21.33, the wall 48.67 cm ahead."""


def test_the_wall_stands_where_it_must():
    scene = replace(ROOM, wall_grey=np.array([200.0]), floor_grey=0.0, above_grey=60.0)
    column = by_rays(scene, HERE, NOBODY, SAMPLES)[:, 49]
    # from 36 - f 10.4 / 48.67 = 20.894 to 36 + f 1.6 / 48.67 = 38.324
    assert column[:20] == pytest.approx(60)
    assert column[20] == pytest.approx(60 * 0.894 + 200 * 0.106, abs=140 / 16)
    assert column[21:38] == pytest.approx(200)
    assert column[38] == pytest.approx(200 * 0.324, abs=200 / 16)
    assert column[39:] == pytest.approx(0)


@pytest.mark.parametrize("distance_cm", [5.0, 10.0, 30.0])
def test_a_body_covers_the_columns_it_must(distance_cm):
    body = (21.33 + distance_cm, 27.5, 0.0)
    row = by_rays(ROOM, HERE, body, SAMPLES)[36]
    covered = (100 - row).sum() / 50
    assert covered == pytest.approx(2 * FOCAL_PX * 2 / np.sqrt(distance_cm**2 - 4), abs=1 / 8)


def test_a_body_to_the_left_has_the_smaller_columns():
    """Left of someone who looks along x is where y is larger."""
    row = by_rays(ROOM, HERE, (30.0, 30.0, 0.0), SAMPLES)[36]
    middle = np.average(np.arange(99) + 0.5, weights=100 - row)
    centre, half = np.arctan2(2.5, 8.67), np.arcsin(2 / np.hypot(2.5, 8.67))
    tangents = 49.5 - FOCAL_PX * np.tan([centre + half, centre - half])
    assert middle == pytest.approx(tangents.mean(), abs=0.1)


def test_the_nearer_body_hides_the_farther():
    scene = replace(ROOM, body=replace(ROOM.body, bands_grey=np.array([40.0])))
    post = Cylinder(radius_cm=1.0, height_cm=3.0, bands_grey=np.array([0.0]))
    behind = replace(scene, obstacles=(post,), obstacle_poses=np.array([[40.0, 27.5, 0.0]]))
    before = replace(scene, obstacles=(post,), obstacle_poses=np.array([[26.0, 27.5, 0.0]]))
    assert by_rays(behind, HERE, (30.0, 27.5, 0.0), SAMPLES).min() == 40
    assert by_rays(before, HERE, (30.0, 27.5, 0.0), SAMPLES)[36].min() == 0


def test_the_top_of_a_low_cylinder_is_seen_from_above():
    """0.6 cm high and 4 cm wide, 10 cm ahead, seen from 1.6 cm: its top from row 36 + f / 12 to 36 + f / 8."""
    low = Cylinder(radius_cm=2.0, height_cm=0.6, bands_grey=np.array([0.0, 20.0]))
    scene = replace(ROOM, obstacles=(low,), obstacle_poses=np.array([[31.33, 27.5, 0.0]]))
    column = by_rays(scene, HERE, NOBODY, SAMPLES)[:, 49]
    top = slice(round(36 + FOCAL_PX / 12) + 1, round(36 + FOCAL_PX / 8) - 1)
    assert column[top] == pytest.approx(10)  # the mean of its bands
    assert column[int(36 + FOCAL_PX * 1.2 / 8)] == pytest.approx(20)  # the upper band, 1.0 to 1.3 cm below the pupil
    assert column[int(36 + FOCAL_PX * 1.5 / 8)] == pytest.approx(0)


def test_blur_keeps_the_light_and_spreads_it():
    image = np.zeros((31, 41))
    image[15, 20] = 100.0
    out = blurred(image, 2.0)
    assert out.sum() == pytest.approx(100)
    rows, columns = np.indices(image.shape)
    for axis in (rows - 15, columns - 20):
        assert (out * axis**2).sum() / 100 == pytest.approx(4, rel=0.05)  # cut at three standard deviations
    assert np.array_equal(blurred(np.full((5, 9), 7.0), 3.0).round(9), np.full((5, 9), 7.0))


def test_noise_is_what_it_says():
    sd = 8.0
    fields = np.stack([noise(key, (72, 99), sd) for key in range(30)]) / 128
    n = fields.size
    assert fields.mean() == pytest.approx(0, abs=4 * sd / np.sqrt(n))
    assert fields.std() == pytest.approx(sd, rel=0.01)
    # a sum of four even draws: kurtosis -1.2 / 4, no skew
    z = fields / fields.std()
    assert (z**4).mean() - 3 == pytest.approx(-0.3, abs=0.05)
    assert (z**3).mean() == pytest.approx(0, abs=4 * np.sqrt(6 / n))
    assert np.abs(z).max() < 3.46


def test_noise_of_different_pixels_and_keys_is_unrelated():
    keys = [0, 1, 2, 2**32, 2**63, 2**64 - 1]
    fields = np.stack([noise(key, (72, 99), 10.0).ravel() for key in keys]).astype(float)
    fields /= fields.std()
    n = fields.shape[1]
    limit = 4.5 / np.sqrt(n)
    between = fields @ fields.T / n - np.eye(len(keys))
    assert np.abs(between).max() < limit
    for shift in (1, 2, 71, 72, 73, 144, 99):
        for a in fields:
            for b in fields:
                assert abs((a * np.roll(b, shift)).mean()) < limit


def test_each_pixel_is_the_nearest_whole_grey():
    image = np.array([[0.0, 0.4, 0.6, 99.49], [99.51, 254.6, 300.0, 1e5]])
    assert sensed(image, 0.0, None).tolist() == [[0, 0, 1, 99], [100, 255, 255, 255]]
    assert sensed(image, 5.0, None).tolist() == sensed(image, 0.0, 7).tolist()


def test_more_rays_agree_with_fewer():
    scene = replace(ROOM, floor_grey=30.0, above_grey=220.0)
    coarse, fine = (by_rays(scene, (40.0, 20.0, 2.0), (33.0, 28.0, 0.0), (n, n)) for n in (8, 24))
    assert np.abs(coarse - fine).mean() < 0.2
    assert ReferenceEye(scene, QUIET).samples == (8, 8)
