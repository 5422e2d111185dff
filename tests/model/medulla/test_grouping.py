"""Grouping."""

import math

import numpy as np
import pytest
from hypothesis import given
from oracles.lgmd import grouping

from lobula.errors import ParameterError
from lobula.model.medulla.grouping import GroupingParams, group

from ..pictures import channel, few, noise, spot

P = GroupingParams()


def test_golden_lone_pixel_by_hand():
    # Ce = 9 / 9 = 1 around it, omega = 0.01 + 1 / 4, G = 9 * 1 / 0.26 = 34.615 and stays
    grouped = group(spot((5, 5), 2, 2, 9.0), P, 1)
    assert grouped.image[2, 2] == pytest.approx(34.61538, rel=1e-5)
    assert grouped.total == pytest.approx(34.61538, rel=1e-5)
    assert np.count_nonzero(grouped.image) == 1


def test_golden_weak_pixel_is_dropped():  # Ce = 6 / 9, omega = 0.176667, G = 6 * 0.666667 / 0.176667 = 22.6 < 30
    assert group(spot((5, 5), 2, 2, 6.0), P, 1).total == 0


def test_golden_block_against_lone_pixel_by_hand():
    # a 3 x 3 block of 8: Ce = 8 in its middle, 8 * 6/9 at its sides, 8 * 4/9 at its corners; omega = 0.01 + 2
    # G = 8 * 8 / 2.01 = 31.84 in the middle, 21.2 and 14.2 elsewhere: only the middle reaches 30
    summation = np.zeros((9, 12), np.float32)
    summation[1:4, 1:4] = 8.0
    summation[6, 9] = 8.0  # alone: 8 * 8/9 / 2.01 = 3.5
    grouped = group(summation, P, 1)
    assert grouped.image[2, 2] == pytest.approx(31.84080, rel=1e-5)
    assert np.count_nonzero(grouped.image) == 1


def test_golden_threshold_is_kept():
    # uniform 3.0: Ce = 3, omega = 0.01 + 0.75 = 0.76, G = 9 / 0.76 = 11.842 everywhere
    summation = np.full((4, 5), 3.0, np.float32)
    assert group(summation, GroupingParams(threshold_grey=11.84), 1).total == pytest.approx(20 * 11.8421, rel=1e-5)
    assert group(summation, GroupingParams(threshold_grey=11.85), 1).total == 0


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("scale", "threshold", "floor"), [(30.0, 30.0, 0.01), (0.1, 0.1, 1e-4)])
def test_agrees_with_the_oracle(seed, scale, threshold, floor):
    summation = noise(seed, high=scale)
    p = GroupingParams(threshold_grey=threshold, floor_grey=floor)
    slow = np.array(grouping(summation.tolist(), threshold, floor))
    grouped = group(summation, p, 1)
    assert 0 < np.count_nonzero(slow) < slow.size
    assert grouped.image == pytest.approx(slow, rel=1e-5)
    assert grouped.total == pytest.approx(slow.sum(), rel=1e-5)


@few
@given(channel)
def test_bounds_dtype_and_input(summation):
    """Ce is at most max(Ce), so G <= 4 S; what stays has reached the threshold."""
    before = summation.copy()
    grouped = group(summation, P, 1)
    kept = grouped.image[grouped.image > 0]
    assert grouped.image.dtype == np.float32
    assert (grouped.image <= 4.0001 * summation).all()
    assert (kept >= 29.999).all()
    assert grouped.total == pytest.approx(grouped.image.sum(dtype=np.float64), rel=1e-5)
    assert np.array_equal(summation, before)


@few
@given(channel)
def test_mirrored_and_turned_pictures(summation):
    free = GroupingParams(threshold_grey=0.0)  # rounding may tip a cell over a threshold
    grouped = group(summation, free, 1).image
    for turned in (np.fliplr, np.flipud, np.transpose):
        assert group(turned(summation), free, 1).image == pytest.approx(turned(grouped), rel=1e-4, abs=1e-4)


def test_company_survives_and_loneliness_does_not():
    crowd, alone = np.zeros((9, 9), np.float32), spot((9, 9), 1, 7, 40.0)
    crowd[3:7, 1:5] = 40.0
    image = group(crowd + alone, P, 1).image
    assert image[1, 7] == 0
    assert image[4, 3] > 100


def test_silence_on_nothing():
    grouped = group(np.zeros((5, 6), np.float32), GroupingParams(threshold_grey=0.0), 1)
    assert grouped.total == 0
    assert not grouped.image.any()


def test_switched_off_hands_the_sum_on():
    summation = noise(0)
    grouped = group(summation, GroupingParams(enabled=False), 1)
    assert np.array_equal(grouped.image, summation)
    assert grouped.total == pytest.approx(summation.sum(dtype=np.float64))


@pytest.mark.parametrize(
    ("name", "bad"),
    [("threshold_grey", -1.0), ("threshold_grey", 256.0), ("floor_grey", 0.0), ("divisor", math.nan), ("enabled", 0)],
)
def test_rejects(name, bad):
    with pytest.raises(ParameterError, match=rf"GroupingParams\.{name} = "):
        GroupingParams(**{name: bad})
