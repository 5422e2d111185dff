"""The change of luminance, its limit, and what sums it up."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lobula.errors import ParameterError
from lobula.model.retina import (
    SAME_LIGHT,
    Light,
    SaturationParams,
    change_statistics,
    frame_difference,
    saturate,
)

from .pictures import channels, few, noise, signed

pictures = st.integers(0, 2**31 - 1).map(lambda seed: np.random.default_rng(seed).integers(0, 256, (2, 6, 8), np.uint8))


def test_golden_difference_by_hand():
    image, previous = np.array([[10, 0, 255]], np.uint8), np.array([[0, 10, 5]], np.float32)
    assert frame_difference(image, previous, 1.0).tolist() == [[10, -10, 250]]
    assert frame_difference(image, previous, 0.5).tolist() == [[5, -5, 125]]


def test_golden_difference_in_another_light_by_hand():  # 2 * 10 + 5 = 25 is what 10 looks like now
    image, previous = np.array([[25, 31]], np.uint8), np.array([[10, 10]], np.float32)
    assert frame_difference(image, previous, 0.5, Light(2.0, 5.0)).tolist() == [[0, 3]]


def test_golden_statistics_by_hand():
    # changes +3, -1, 0, +0.5: mean 2.5 / 4, mean of magnitudes 4.5 / 4; half a grey level is no change
    about = change_statistics(np.array([[13, 9], [10, 10.5]], np.float32), np.full((2, 2), 10, np.float32))
    assert about == (0.625, 1.125, 3.0, 0.25, 0.25)


@few
@given(pictures)
def test_forth_and_back_cancel(pair):
    there = frame_difference(pair[0], pair[1].astype(np.float32), 1.0)
    back = frame_difference(pair[1], pair[0].astype(np.float32), 1.0)
    assert there.dtype == back.dtype == np.float32
    assert np.array_equal(there, -back)


@few
@given(pictures)
def test_bytes_and_floats_are_the_same_light(pair):
    previous = pair[1].astype(np.float32)
    assert np.array_equal(
        frame_difference(pair[0], previous, 0.7), frame_difference(pair[0].astype(np.float32), previous, 0.7)
    )
    assert change_statistics(pair[0], previous) == change_statistics(pair[0].astype(np.float32), previous)


@few
@given(channels)
def test_statistics_hold_together(pair):
    about = change_statistics(*pair)
    assert abs(about.mean) <= about.mean_abs * (1 + 1e-9) <= about.max_abs * (1 + 1e-6)
    assert 0 <= about.brighter + about.darker <= 1


def test_still_picture_is_silent():
    image = noise(0)
    assert not frame_difference(image, image.copy(), 1.0).any()
    assert change_statistics(image, image.copy()) == (0, 0, 0, 0, 0)


def test_inputs_are_not_modified():
    image, previous = noise(0), noise(1)
    copies = image.copy(), previous.copy()
    for light in (SAME_LIGHT, Light(1.3, -4.0)):
        assert frame_difference(image, previous, 0.5, light).dtype == np.float32
        change_statistics(image, previous)
    assert np.array_equal(image, copies[0])
    assert np.array_equal(previous, copies[1])


def test_golden_limit_by_hand():
    change = np.array([[0, 12, -12], [12.5, -90, 255]], np.float32)
    limited = saturate(change, SaturationParams(enabled=True, limit_grey=12.0))
    assert limited.tolist() == [[0, 12, -12], [12, -12, 12]]


@few
@given(signed, st.floats(1, 255))
def test_saturation_is_odd_and_bounded_and_leaves_small_changes_alone(change, limit):
    p, copy = SaturationParams(enabled=True, limit_grey=limit), change.copy()
    limited = saturate(change, p)
    assert limited.dtype == np.float32
    assert (np.abs(limited) <= np.float32(limit)).all()
    assert (np.sign(limited) == np.sign(change)).all()
    small = np.abs(change) <= np.float32(limit)
    assert (limited[small] == change[small]).all()
    assert np.array_equal(saturate(-change, p), -limited)
    assert np.array_equal(saturate(limited, p), limited)
    assert np.array_equal(change, copy)


def test_a_change_that_does_not_saturate_goes_on_as_it_is():
    change = noise(0, low=-255.0)
    assert np.array_equal(saturate(change, SaturationParams(enabled=False, limit_grey=1.0)), change)


@pytest.mark.parametrize(
    ("name", "bad"),
    [("enabled", 1), ("enabled", "on"), ("limit_grey", 0.5), ("limit_grey", 256.0), ("limit_grey", math.nan)],
)
def test_saturation_rejects(name, bad):
    with pytest.raises(ParameterError, match=rf"SaturationParams\.{name} = "):
        SaturationParams(**{name: bad})
