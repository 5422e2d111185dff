"""Difference of Gaussians."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.dog import dog

from lobula.errors import ParameterError
from lobula.model.lamina.dog import DogParams, difference_of_gaussians, gaussian_blur, gaussian_kernel

from ..pictures import few, noise, signed, spot

SHARED = DogParams()


def test_golden_kernel_by_hand():
    # sigma 1, radius 1: weights exp(-1/2), 1, exp(-1/2) over their sum 2.21306
    assert gaussian_kernel(1, 1.0) == pytest.approx([0.274069, 0.451863, 0.274069], abs=1e-6)


def test_golden_one_bright_pixel_by_hand():
    # inner, sigma 2: 1 + 2 (0.88250 + 0.60653) = 3.97806; middle weight 0.251379, two away 0.152469
    # outer, sigma 4: 1 + 2 (0.96923 + 0.88250 + 0.75484 + 0.60653) = 7.42620; 0.134658 and 0.118836
    # middle: 100 (0.251379^2 - 0.134658^2) = 4.50586;  two off both ways: 100 (0.152469^2 - 0.118836^2) = 0.91250
    edges = difference_of_gaussians(spot((13, 13), 6, 6, 100.0), SHARED)
    assert edges[6, 6] == pytest.approx(4.50586, abs=1e-4)
    assert edges[4, 4] == edges[8, 8] == pytest.approx(0.91250, abs=1e-4)
    assert edges[6, 3] == 0  # outside the 5 x 5 inner field
    assert np.count_nonzero(edges) == 25


def test_golden_opposite_signs_are_silent():
    # around +200 on -10: e = -10 + 210 * 0.0631915 = 3.27 but i = -10 + 210 * 0.0181329 = -6.19
    change = np.full((13, 13), -10.0, np.float32)
    change[6, 6] = 200.0
    assert difference_of_gaussians(change, SHARED)[6, 6] == 0


def test_golden_both_negative_by_hand():
    # around +100 on -10: e = -10 + 6.95107 = -3.04893, i = -10 + 1.99462 = -8.00538; LA = -|e - i| = -4.95645
    change = np.full((13, 13), -10.0, np.float32)
    change[6, 6] = 100.0
    assert difference_of_gaussians(change, SHARED)[6, 6] == pytest.approx(-4.95645, abs=1e-4)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("radius_px", "sigma_px"), [(2, 2.0), (1, 0.8)])
def test_agrees_with_the_oracle(seed, radius_px, sigma_px):
    change = noise(seed, low=-255)
    edges = difference_of_gaussians(change, DogParams(radius_px=radius_px, sigma_px=sigma_px))
    assert edges == pytest.approx(np.array(dog(change.tolist(), radius_px, sigma_px)), abs=1e-3)


@few
@given(st.floats(-255, 255, width=32))
def test_uniform_change_is_silent(value):
    edges = difference_of_gaussians(np.full((7, 9), value, np.float32), SHARED)
    assert np.abs(edges).max() <= 2e-6 * abs(value)


def test_still_picture_is_exactly_silent():
    assert not difference_of_gaussians(np.zeros((7, 9), np.float32), SHARED).any()


def test_far_from_the_change_is_exactly_silent():
    edges = difference_of_gaussians(spot((20, 20), 3, 3, 255.0), SHARED)
    assert not edges[6:].any()
    assert not edges[:, 6:].any()


def test_rounding_noise_has_no_sign():
    assert not difference_of_gaussians(noise(1, low=-9e-5, high=9e-5), SHARED).any()


@pytest.mark.parametrize("seed", range(3))
def test_darkening_is_the_negative_of_brightening(seed):
    change = noise(seed, low=-255)
    assert np.array_equal(difference_of_gaussians(-change, SHARED), -difference_of_gaussians(change, SHARED))


@pytest.mark.parametrize("seed", range(3))
def test_mirrored_and_turned_pictures(seed):
    change = noise(seed, low=-255)
    edges = difference_of_gaussians(change, SHARED)
    for turned in (np.fliplr, np.flipud, np.transpose):
        assert difference_of_gaussians(turned(change), SHARED) == pytest.approx(turned(edges), abs=1e-3)


@few
@given(signed)
def test_polarity_and_bound(change):
    """Nothing exceeds the largest change by more than twice, and the sign is that of the inner blur."""
    edges = difference_of_gaussians(change, SHARED)
    inner = gaussian_blur(change, 2, 2.0)
    assert np.abs(edges).max() <= 2.0001 * np.abs(change).max()
    assert (np.sign(edges) * np.sign(inner) >= 0).all()


@few
@given(signed)
def test_keeps_float32_and_the_input(change):
    before = change.copy()
    edges = difference_of_gaussians(change, SHARED)
    assert edges.dtype == np.float32
    assert edges.shape == change.shape
    assert np.array_equal(change, before)


@few
@given(st.integers(1, 12), st.floats(0.3, 32))
def test_kernel_is_a_mean(radius, sigma):
    kernel = gaussian_kernel(radius, sigma)
    assert kernel.sum(dtype=np.float64) == pytest.approx(1, abs=1e-6)
    assert np.array_equal(kernel, kernel[::-1])
    assert kernel.argmax() == radius


def test_switched_off_hands_the_change_on():
    change = noise(0, low=-255)
    assert np.array_equal(difference_of_gaussians(change, DogParams(enabled=False)), change)


@pytest.mark.parametrize(
    ("name", "bad"),
    [("sigma_px", 0.0), ("sigma_px", math.nan), ("sigma_px", 33.0), ("radius_px", 0), ("radius_px", 2.5),
     ("surround", 1), ("dead_zone_grey", -1e-9), ("enabled", 1)],
)  # fmt: skip
def test_rejects(name, bad):
    with pytest.raises(ParameterError, match=rf"DogParams\.{name} = "):
        DogParams(**{name: bad})
