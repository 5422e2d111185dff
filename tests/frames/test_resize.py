"""The area average against block means and an oversampling oracle."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.frames.resize import AreaAverage, Rect, coverage


def oversampled(image, out_height, out_width):
    """Repeat every pixel until blocks come out whole, then take their plain means: slow and obvious."""
    down = math.lcm(image.shape[0], out_height) // image.shape[0]
    across = math.lcm(image.shape[1], out_width) // image.shape[1]
    fine = np.repeat(np.repeat(image.astype(np.float64), down, axis=0), across, axis=1)
    blocks = fine.reshape(out_height, fine.shape[0] // out_height, out_width, fine.shape[1] // out_width)
    return blocks.mean(axis=(1, 3))


def average(image, out_height, out_width):
    height, width = image.shape
    return AreaAverage(height, width, Rect(0, 0, width, height), out_height, out_width)(image)


def test_block_means_by_hand():
    image = np.array([[0, 2, 10, 10], [4, 6, 10, 30]], np.uint8)
    assert average(image, 1, 2).tolist() == [[3.0, 15.0]]


def test_three_pixels_into_two_by_hand():
    # each output covers one and a half pixels: (30 + 60 / 2) / 1.5 = 40, (60 / 2 + 120) / 1.5 = 100
    np.testing.assert_allclose(average(np.array([[30, 60, 120]], np.uint8), 1, 2), [[40, 100]], rtol=1e-6)


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 40), st.integers(1, 40), st.integers(1, 24), st.integers(1, 24), st.integers(0, 2**32 - 1))
def test_equals_oversampling(height, width, out_height, out_width, seed):
    image = np.random.default_rng(seed).integers(0, 256, (height, width), np.uint8)
    np.testing.assert_allclose(
        average(image, out_height, out_width), oversampled(image, out_height, out_width), atol=2e-4
    )


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 60), st.integers(1, 60))
def test_every_source_pixel_counts_the_same(n_in, n_out):
    weights = coverage(n_in, 0, n_in, n_out)
    np.testing.assert_allclose(weights.sum(axis=1), 1)
    np.testing.assert_allclose(weights.sum(axis=0), n_out / n_in)


def test_crop_is_slicing_first():
    image = np.random.default_rng(0).integers(0, 256, (50, 70), np.uint8)
    cropped = AreaAverage(50, 70, Rect(7, 3, 45, 40), 24, 32)(image)
    np.testing.assert_allclose(cropped, oversampled(image[3:43, 7:52], 24, 32), atol=2e-4)


def test_mapping_takes_limited_range_to_full_and_clips():
    image = np.array([[16, 235, 126, 5, 250]], np.uint8)
    gain, offset = 255 / 219, -16 * 255 / 219
    mapped = AreaAverage(1, 5, Rect(0, 0, 5, 1), 1, 5, gain, offset)(image)
    np.testing.assert_allclose(mapped, [[0, 255, 110 * 255 / 219, 0, 255]], atol=1e-4)
    assert mapped.min() >= 0
    assert mapped.max() <= 255


@pytest.mark.parametrize("dtype", [np.uint8, np.float32, np.float64])
def test_gives_float32_and_leaves_the_plane_alone(dtype):
    padded = np.full((48, 80), 7, dtype)
    plane = padded[:, :64]  # not contiguous, as a decoder's plane with a longer line
    before = padded.copy()
    image = average(plane, 24, 32)
    assert image.dtype == np.float32
    np.testing.assert_array_equal(image, 7)
    np.testing.assert_array_equal(padded, before)


def test_white_stays_within_range():
    assert average(np.full((481, 643), 255, np.uint8), 72, 99).max() <= 255


def test_refuses_a_plane_of_another_shape():
    with pytest.raises(ValueError, match=r"\(10, 20\): made for \(20, 10\)"):
        AreaAverage(20, 10, Rect(0, 0, 10, 20), 2, 2)(np.zeros((10, 20), np.uint8))
