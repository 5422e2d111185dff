"""Coarse ON and OFF cells: what darkens or brightens as a whole."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.coarse import heard

from lobula.errors import ParameterError
from lobula.model.medulla.coarse import CoarseParams, coarse

from ..pictures import few, noise, signed

P = CoarseParams(patch_px=9, floor_grey=1.0)
OPEN = replace(P, floor_grey=0.0)
SIDES = st.integers(2, 5)
SHAPE = (72, 99)  # 8 x 11 patches of 9 px
ROWS, COLUMNS = np.mgrid[: SHAPE[0], : SHAPE[1]] + 0.5


def disc(radius_px, row=36.0, column=48.0, grey=30.0):
    """A disc of ``grey`` on a wall of 150."""
    inside = np.hypot(ROWS - row, COLUMNS - column) < radius_px
    return np.where(inside, grey, 150.0).astype(np.float32)


def test_golden_patches_by_hand():
    # 2 x 2 patches of 4 px, means 6, -3, 0.5 and -8.5: beyond a floor of 1 they say 5, 2, 0 and 7.5, four times each
    change = np.array([[9, 7, -3, -3],
                       [2, 6, -6, 0],
                       [1, 0, -9, -8],
                       [1, 0, -10, -7]], np.float32)  # fmt: skip
    assert coarse(change, CoarseParams(patch_px=2, floor_grey=1.0)) == (20.0, 8.0 + 30.0)
    assert coarse(change, CoarseParams(patch_px=2, floor_grey=0.0)) == (24.0 + 2.0, 12.0 + 34.0)
    assert coarse(change, CoarseParams(patch_px=2, floor_grey=6.0)) == (0.0, 10.0)
    assert coarse(change, CoarseParams(patch_px=4, floor_grey=1.0)) == (0.0, 4.0)  # a mean of -20 / 16


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("side", "floor"), [(2, 5.0), (3, 0.0), (4, 20.0), (9, 1.0), (10, 1.0)])
def test_agrees_with_the_oracle(seed, side, floor):
    change = noise(seed, (13, 23), low=-255.0)
    slow = heard(change.tolist(), side, floor)
    assert sum(slow) > 0 or side == 10
    assert coarse(change, CoarseParams(patch_px=side, floor_grey=floor)) == pytest.approx(slow, rel=1e-6, abs=1e-3)


@few
@given(signed, SIDES, st.floats(0, 20))
def test_on_and_off_are_each_others_mirror(change, side, floor):
    p = CoarseParams(patch_px=side, floor_grey=floor)
    on, off = coarse(change, p)
    assert coarse(-change, p) == (off, on)


@few
@given(signed, SIDES)
def test_without_a_floor_they_differ_by_the_whole_change(change, side):
    on, off = coarse(change, CoarseParams(patch_px=side, floor_grey=0.0))
    rows, columns = (n // side * side for n in change.shape)
    assert on - off == pytest.approx(change[:rows, :columns].sum(dtype=np.float64), abs=1e-3)


@few
@given(signed, SIDES, st.floats(0, 20), st.floats(0, 20))
def test_bounds_types_and_input(change, side, floor, more):
    copy = change.copy()
    on, off = coarse(change, CoarseParams(patch_px=side, floor_grey=floor))
    assert type(on) is type(off) is float
    assert min(on, off) >= 0
    assert on + off <= np.abs(change).sum(dtype=np.float64) * (1 + 1e-6)
    higher = coarse(change, CoarseParams(patch_px=side, floor_grey=floor + more))
    assert (higher.on <= on, higher.off <= off) == (True, True)
    assert np.array_equal(change, copy)


@pytest.mark.parametrize("period_px", [3, 9])
@pytest.mark.parametrize("shift_px", [1, 2])
@pytest.mark.parametrize("axis", [0, 1])
def test_whole_stripes_cancel(period_px, shift_px, axis):
    wave = np.random.default_rng(period_px).integers(0, 256, period_px)
    wall = wave[np.indices(SHAPE)[axis] % period_px].astype(np.float32)
    change = np.roll(wall, shift_px, axis) - wall
    assert np.abs(change).max() > 10
    assert coarse(change, OPEN) == (0, 0)


@pytest.mark.parametrize("p", [OPEN, P], ids=["open", "floor"])
def test_a_dark_disc_that_grows_darkens_and_no_more(p):
    on, off = coarse(disc(24) - disc(20), p)
    assert on == 0
    ring = 120 * math.pi * (24**2 - 20**2)
    assert 0.8 * ring < off < 1.01 * ring


@pytest.mark.parametrize("p", [OPEN, P], ids=["open", "floor"])
def test_a_dark_disc_that_shrinks_brightens_and_no_more(p):
    on, off = coarse(disc(20) - disc(24), p)
    assert off == 0
    assert on == coarse(disc(24) - disc(20), p).off


@pytest.mark.parametrize(("rows", "columns"), [(0, 1), (0, 4), (3, 0), (-2, 2), (5, -7)])
def test_a_dark_disc_that_passes_does_both_alike(rows, columns):
    change = disc(20, 36 + rows, 48 + columns) - disc(20)
    on, off = coarse(change, OPEN)
    assert on > 1000
    assert on == pytest.approx(off, rel=0.01)  # the disc does not grow, up to how it meets the pixels
    on, off = coarse(change, P)
    assert on == pytest.approx(off, rel=0.2)


def test_columns_and_rows_left_over_are_not_heard():
    change = np.zeros((20, 25), np.float32)
    change[18:], change[:, 18:] = -100.0, 100.0  # 2 x 2 patches end at 18
    assert coarse(change, P) == (0, 0)
    change[17, 17] = -200.0
    assert coarse(change, P) == pytest.approx((0, 200 - 81))


@pytest.mark.parametrize("side", [25, 200])
def test_patches_larger_than_the_picture_are_deaf(side):
    assert coarse(np.full((24, 32), -100.0, np.float32), CoarseParams(patch_px=side)) == (0, 0)


def test_silence_on_nothing():
    assert coarse(np.zeros(SHAPE, np.float32), OPEN) == (0, 0)


@pytest.mark.parametrize(
    ("name", "bad"),
    [("patch_px", 1), ("patch_px", 257), ("patch_px", 4.5), ("patch_px", True), ("floor_grey", -0.1),
     ("floor_grey", 256.0), ("floor_grey", math.nan)],
)  # fmt: skip
def test_rejects(name, bad):
    with pytest.raises(ParameterError, match=rf"CoarseParams\.{name} = "):
        CoarseParams(**{name: bad})
