"""Smooth ink: areas, places, and what happens at the edge of the picture."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.report.arena_marks import KINDS, draw_mark
from lobula.report.arena_pen import disc, line, path, ring, sector, tint
from lobula.report.arena_video import clock

WHITE = (255, 255, 255)


def blank(height=60, width=80):
    return np.zeros((height, width, 3), np.uint8)


def area(canvas):
    return canvas[..., 0].sum() / 255


@given(st.floats(20, 40), st.floats(20, 60), st.floats(2, 15))
@settings(max_examples=40, deadline=None)
def test_a_disc_has_its_area_and_its_middle(row, column, radius):
    canvas = blank()
    disc(canvas, row, column, radius, WHITE)
    assert area(canvas) == pytest.approx(math.pi * radius**2, rel=0.05, abs=1.5)
    ink = canvas[..., 0] / area(canvas) / 255
    rows, columns = np.mgrid[:60, :80]
    assert ((ink * rows).sum(), (ink * columns).sum()) == pytest.approx((row, column), abs=0.1)


def test_a_ring_and_a_line_have_their_area():
    canvas = blank()
    ring(canvas, 30, 40, 15, 2, WHITE)
    assert area(canvas) == pytest.approx(2 * math.pi * 15 * 2, rel=0.03)
    canvas = blank()
    line(canvas, (10.3, 10.1), (40.3, 50.1), 3, WHITE)  # 50 long, and a round end at both
    assert area(canvas) == pytest.approx(150 + math.pi * 1.5**2, rel=0.04)


@pytest.mark.parametrize("heading_deg", [0, 37, 90, 180, 215, 270, 300, 725, -100])
def test_a_sector_lies_ahead(heading_deg):
    canvas, heading = np.zeros((201, 201, 3), np.uint8), math.radians(heading_deg)
    within = np.ones((201, 201), np.bool_)
    sector(canvas, 100, 100, heading, math.radians(35), 80, WHITE, 1.0, within)
    # fading to nothing at the radius, a sector holds a third of its area: the integral of (1 - r/R) r dr is R^2 / 6
    assert area(canvas) == pytest.approx(2 * math.radians(35) * 80**2 / 6, rel=0.03)
    rows, columns = np.mgrid[:201, :201]
    ink = canvas[..., 0] / canvas[..., 0].sum()
    up, right = 100 - (ink * rows).sum(), (ink * columns).sum() - 100
    assert math.remainder(math.atan2(up, right) - heading, 2 * math.pi) == pytest.approx(0, abs=0.02)


def test_a_sector_stays_within():
    canvas, within = blank(), np.zeros((60, 80), np.bool_)
    within[:, :45] = True
    sector(canvas, 30, 40, 0.0, 0.6, 30, WHITE, 1.0, within)
    assert canvas[:, :45].any()
    assert not canvas[:, 45:].any()


def test_a_path_is_as_wide_as_its_pen_and_keeps_the_stronger_ink():
    ink = np.zeros((40, 60), np.float32)
    at = np.arange(5.0, 50.0, 1.0)
    path(ink, np.full_like(at, 20.0), at, np.full_like(at, 0.5), 2.0)
    assert ink[:, 10:40].sum(axis=0) == pytest.approx(np.full(30, 2 * 0.5), rel=0.1)
    path(ink, np.full_like(at, 20.0), at, np.full_like(at, 0.2), 2.0)
    assert ink.max() == 0.5


quarters = st.integers(-800, 1200).map(lambda number: number / 4)  # exact, wherever the picture begins


@given(quarters, quarters, st.floats(0.5, 60), st.sampled_from(KINDS))
@settings(max_examples=60, deadline=None)
def test_what_falls_outside_is_cut_off(row, column, radius, kind):
    large, small = np.zeros((660, 680, 3), np.uint8), blank()
    for canvas, by in ((small, 0), (large, 300)):
        disc(canvas, row + by, column + by, radius, (10, 200, 30))
        ring(canvas, row + by, column + by, radius / 2, 2, (200, 20, 60))
        line(canvas, (row + by, column + by), (row + by + 20, column + by - 30), 2, WHITE)
        sector(canvas, row + by, column + by, 1.0, 0.6, radius, WHITE, 0.5, np.ones(canvas.shape[:2], np.bool_))
        draw_mark(canvas, kind, row + by, column + by)
    assert np.abs(large[300:360, 300:380].astype(int) - small).max() <= 2  # a share is rounded to 1/128


def test_full_ink_is_the_colour_and_none_changes_nothing():
    canvas = np.full((4, 5, 3), 77, np.uint8)
    tint(canvas, np.zeros((4, 5)), (3, 250, 128))
    assert (canvas == 77).all()
    tint(canvas, np.ones((4, 5)), (3, 250, 128))
    assert (canvas == (3, 250, 128)).all()


def test_every_mark_differs_in_shape():
    shapes = []
    for kind in KINDS:
        canvas = np.full((19, 19, 3), 120, np.uint8)
        draw_mark(canvas, kind, 9, 9)
        shapes.append((np.abs(canvas.astype(int) - 120).max(axis=2) > 60).tobytes())
    assert len(set(shapes)) == len(KINDS)


@pytest.mark.parametrize(
    ("time_s", "words"), [(0, "0:00.0"), (9.99, "0:09.9"), (61.3, "1:01.3"), (3600, "1:00:00.0"), (0.3, "0:00.3")]
)
def test_clock(time_s, words):
    assert clock(time_s) == words
