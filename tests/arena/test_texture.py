"""The wall's strip: widths, greys and closing of random stripes, and a strip from a picture."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lobula.arena.texture import SAMPLE_CM, stripes, wall_strip
from lobula.arena.world import WallParams
from lobula.errors import FrameSourceError, ParameterError

FINE = WallParams()
"""0.6 to 0.8 cm, 150 and 210."""


def edges_cm(strip, length_cm):
    """Where a strip of 150 and 210 changes, from the samples that hold an edge and the greys beside them."""
    light = (strip - 150) / 60
    sample = length_cm / len(strip)
    starts = np.flatnonzero((light[1:] >= 0.5) != (light[:-1] >= 0.5))
    found = []
    for i in starts:
        # one of the two samples is mixed, or none: the edge lies where their light has its middle
        first, last = light[i - 1], light[i + 2]
        share = (light[i] + light[i + 1] - 2 * last) / (first - last)
        found.append((i + share) * sample)
    return np.array(found)


@pytest.mark.parametrize("length_cm", [250.0, 2 * np.pi * 35, 15.7])
def test_stripes_have_the_widths_and_greys_that_were_asked_for(length_cm):
    strip = stripes(FINE, length_cm, np.random.default_rng(1))
    edges = edges_cm(strip, length_cm)
    widths = np.diff(edges)
    stretch = 0.7 / length_cm  # all are stretched by at most half a pair of stripes over the whole
    assert widths.min() > 0.6 * (1 - 2 * stretch) - 1e-9
    assert widths.max() < 0.8 * (1 + 2 * stretch) + 0.02
    assert {strip.min(), strip.max()} == {150.0, 210.0}
    assert length_cm / len(strip) <= SAMPLE_CM


def test_widths_are_spread_over_their_range():
    widths = np.diff(edges_cm(stripes(FINE, 2500.0, np.random.default_rng(2)), 2500.0))
    assert widths.mean() == pytest.approx(0.7, abs=0.01)
    assert widths.std() == pytest.approx(0.2 / np.sqrt(12), abs=0.005)


def test_the_strip_closes():
    """As many dark stripes as light ones: the last meets the first with the other grey."""
    for seed in range(20):
        strip = stripes(FINE, 250.0, np.random.default_rng(seed))
        assert {strip[0], strip[-1]} == {150.0, 210.0}


@given(st.floats(0.05, 5), st.floats(1, 3), st.floats(0.5, 300), st.integers(0, 9))
def test_any_width_on_any_length(low, ratio, length_cm, seed):
    wall = WallParams(stripe_low_cm=low, stripe_high_cm=low * ratio, dark_grey=10, light_grey=240)
    strip = stripes(wall, length_cm, np.random.default_rng(seed))
    assert strip.min() >= 10 - 1e-6
    assert strip.max() <= 240 + 1e-6
    # dark and light stripes are alike, so the mean lies well inside
    assert 10 < strip.mean() < 240


def test_same_seed_same_strip():
    strips = [stripes(FINE, 100.0, np.random.default_rng(seed)) for seed in (3, 3, 4)]
    assert np.array_equal(strips[0], strips[1])
    assert not np.array_equal(strips[0], strips[2])


def test_plain_is_the_mean_grey():
    assert wall_strip(WallParams(pattern="plain"), 250.0, np.random.default_rng(0)).tolist() == [180.0]


def test_a_picture_gives_its_middle_row(tmp_path):
    rows = np.array([[0, 0, 0, 0], [10, 20, 200, 255], [9, 9, 9, 9]], np.uint8)
    (tmp_path / "strip.pgm").write_bytes(b"P5 4 3 255\n" + rows.tobytes())
    wall = WallParams(pattern="file", file=str(tmp_path / "strip.pgm"))
    assert wall_strip(wall, 250.0, np.random.default_rng(0)) == pytest.approx([10, 20, 200, 255], abs=1)


def test_a_file_that_is_missing_or_no_picture(tmp_path):
    missing = WallParams(pattern="file", file=str(tmp_path / "none.png"))
    with pytest.raises(FrameSourceError, match=r"wall\.file: .*none\.png: No such file"):
        wall_strip(missing, 250.0, np.random.default_rng(0))
    (tmp_path / "text.png").write_text("not a picture")
    with pytest.raises(ParameterError, match=r"wall\.file = .*text\.png': must be a picture"):
        wall_strip(WallParams(pattern="file", file=str(tmp_path / "text.png")), 250.0, np.random.default_rng(0))
