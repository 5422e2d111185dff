"""Rotate, flip, region and fit: worked by hand, and against doing it on the whole picture."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.errors import FrameSourceError, ParameterError
from lobula.frames.geometry import View, lay_out


def test_wide_picture_is_cropped_at_the_sides():
    layout = lay_out(View(), 1242, 374, 0, "clip")
    assert layout.seen == (364, 0, 514, 374)  # 374 * 99 / 72 = 514.25 wide, in the middle
    assert layout.crop == layout.seen
    assert layout.place == (0, 0, 99, 72)


def test_tall_picture_is_cropped_above_and_below():
    assert lay_out(View(), 99, 172, 0, "clip").seen == (0, 50, 99, 72)


def test_squeeze_keeps_all():
    layout = lay_out(View(fit="squeeze"), 160, 90, 0, "clip")
    assert layout.seen == (0, 0, 160, 90)
    assert layout.place == (0, 0, 99, 72)


def test_pad_keeps_all_and_the_shape():
    wide = lay_out(View(fit="pad"), 160, 90, 0, "clip")
    assert wide.seen == (0, 0, 160, 90)
    assert wide.place == (0, 8, 99, 56)  # 99 * 90 / 160 = 55.7 rows
    assert lay_out(View(fit="pad"), 90, 160, 0, "clip").place == (29, 0, 40, 72)  # 72 * 90 / 160 = 40.5 columns


def test_region_of_interest_is_in_upright_pixels():
    # a 100 x 60 picture turned clockwise is 60 x 100; its top right corner was the top left one
    layout = lay_out(View(rotate=90, roi=(20, 0, 40, 30), fit="squeeze"), 100, 60, 0, "clip")
    assert (layout.width, layout.height) == (60, 100)
    assert layout.crop == (0, 0, 30, 40)


def test_rotation_adds_to_the_container():
    assert lay_out(View(rotate=270), 100, 60, 90, "clip").quarter_turns == 0
    assert lay_out(View(), 100, 60, 90, "clip").quarter_turns == 1


def test_upright_by_hand():
    picture = np.array([[1, 2], [3, 4]])
    turned = lay_out(View(rotate=90, size=(32, 32)), 40, 40, 0, "clip")
    assert turned.upright(picture).tolist() == [[3, 1], [4, 2]]
    both = lay_out(View(rotate=90, flip="h", size=(32, 32)), 40, 40, 0, "clip")
    assert both.upright(picture).tolist() == [[1, 3], [2, 4]]
    assert lay_out(View(flip="v"), 40, 40, 0, "clip").upright(picture).tolist() == [[3, 4], [1, 2]]


@settings(max_examples=150, deadline=None)
@given(
    st.tuples(st.integers(40, 90), st.integers(40, 90)),
    st.sampled_from([0, 90, 180, 270]),
    st.sampled_from([0, 90, 180, 270]),
    st.sampled_from([None, "h", "v", "hv"]),
    st.sampled_from(["crop", "squeeze", "pad"]),
    st.data(),
)
def test_cropping_before_turning_is_cropping_after(shape, rotate, rotation, flip, fit, data):
    picture = np.arange(shape[0] * shape[1]).reshape(shape)
    whole = lay_out(View(rotate=rotate, flip=flip, fit=fit), shape[1], shape[0], rotation, "clip")
    x, y = data.draw(st.integers(0, whole.width - 32)), data.draw(st.integers(0, whole.height - 24))
    roi = (x, y, data.draw(st.integers(32, whole.width - x)), data.draw(st.integers(24, whole.height - y)))
    layout = lay_out(View(rotate=rotate, flip=flip, fit=fit, roi=roi), shape[1], shape[0], rotation, "clip")
    c, s = layout.crop, layout.seen
    cropped_first = layout.upright(picture[c.y : c.y + c.height, c.x : c.x + c.width])
    np.testing.assert_array_equal(cropped_first, layout.upright(picture)[s.y : s.y + s.height, s.x : s.x + s.width])
    assert roi[0] <= s.x <= s.x + s.width <= roi[0] + roi[2]
    assert roi[1] <= s.y <= s.y + s.height <= roi[1] + roi[3]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"size": (31, 24)}, r"size = \(31, 24\): must be \(width, height\) of at least 32 x 24"),
        ({"size": (99.0, 72.0)}, "size"),
        ({"fit": "stretch"}, "fit = 'stretch': must be one of crop, squeeze, pad"),
        ({"flip": "x"}, "flip = 'x': must be one of h, v, hv"),
        ({"rotate": 45}, "rotate = 45: must be one of 0, 90, 180, 270"),
        ({"roi": (0, 0, 10)}, "roi"),
    ],
)
def test_refuses(arguments, message):
    with pytest.raises(ParameterError, match=message):
        View(**arguments)


@pytest.mark.parametrize("roi", [(60, 0, 41, 40), (0, 0, 31, 40), (-1, 0, 40, 40), (0, 37, 40, 24)])
def test_refuses_a_region_outside_or_too_small(roi):
    with pytest.raises(ParameterError, match="inside the 100 x 60 px of clip, at least 32 x 24"):
        lay_out(View(roi=roi), 100, 60, 0, "clip")


def test_refuses_a_tiny_picture():
    with pytest.raises(FrameSourceError, match="clip: picture of 1 x 1 px: must be at least 32 x 24"):
        lay_out(View(), 1, 1, 0, "clip")
