"""What the mask's black touches is held at grey; the rest is left alone."""

from __future__ import annotations

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError, ParameterError
from lobula.frames.geometry import View, lay_out
from lobula.frames.mask import ignored_pixels

from .clips import image_bytes


def mask_with(black, shape=(72, 99)):
    mask = np.full(shape, 255, np.uint8)
    mask[black] = 0
    return mask


def ignored(mask, view, width, height):
    return ignored_pixels(mask, lay_out(view, width, height, 0, "clip"), view.size)


def test_mask_at_the_working_size_is_taken_pixel_by_pixel():
    black = (slice(60, 72), slice(None))
    expected = np.zeros((72, 99), bool)
    expected[60:] = True
    np.testing.assert_array_equal(ignored(mask_with(black), View(), 198, 144), expected)


def test_one_black_pixel_takes_the_working_pixel_it_touches():
    mask = mask_with((slice(101, 102), slice(51, 52)), (144, 198))  # twice the working size
    assert np.argwhere(ignored(mask, View(), 198, 144)).tolist() == [[50, 25]]


def test_mask_of_the_whole_picture_is_cut_by_the_region():
    mask = mask_with((slice(0, 20), slice(0, 30)), (100, 120))
    view = View(size=(40, 30), roi=(20, 10, 80, 60))  # two source pixels per working pixel
    expected = np.zeros((30, 40), bool)
    expected[:5, :5] = True
    np.testing.assert_array_equal(ignored(mask, view, 120, 100), expected)


def test_mask_of_another_size_is_stretched_over_the_region():
    mask = mask_with((slice(None), slice(1, 2)), (1, 2))  # right half
    view = View(size=(40, 30), roi=(20, 10, 80, 60))
    expected = np.zeros((30, 40), bool)
    expected[:, 20:] = True
    np.testing.assert_array_equal(ignored(mask, view, 120, 100), expected)


def test_padding_is_not_part_of_the_mask():
    view = View(size=(40, 40), fit="pad")
    mask = mask_with((slice(0, 1), slice(None)), (2, 1))  # upper half
    expected = np.zeros((40, 40), bool)
    expected[10:20] = True  # 80 x 40 px come to lie in rows 10 to 29
    np.testing.assert_array_equal(ignored(mask, view, 80, 40), expected)


@pytest.mark.parametrize(("shape", "region"), [((100, 100), None), ((72, 128), None), ((72, 99), (0, 0, 90, 40))])
def test_a_mask_of_another_shape_is_refused(shape, region):
    _, _, width, height = region or (0, 0, 198, 144)
    message = rf"{shape[1]} x {shape[0]} px over a picture of {width} x {height}: must have the same shape"
    with pytest.raises(ParameterError, match=message):
        ignored(mask_with((slice(0, 9), slice(0, 9)), shape), View(roi=region), 198, 144)


def test_a_mask_may_be_rounded_to_whole_pixels():
    """1920 x 1080 at a twentieth is 96 x 54; at a thirteenth 147.7 x 83.1."""
    for shape in ((54, 96), (83, 148), (83, 147), (84, 148)):
        assert not ignored(np.full(shape, 255, np.uint8), View(), 1920, 1080).any()


def test_masked_pixels_never_change(tmp_path):
    path = tmp_path / "mask.png"
    path.write_bytes(image_bytes(mask_with((slice(60, 72), slice(None)))))
    images = np.random.default_rng(0).integers(0, 256, (4, 72, 99), np.uint8)
    with lobula.frames.open(images, mask=path) as frames:
        for i, frame in enumerate(frames):
            np.testing.assert_array_equal(frame.image[60:], 128)
            np.testing.assert_array_equal(frame.image[:60], images[i, :60])
    assert images[:, 60:].std() > 0  # the caller's own array is not written to


def test_refuses_what_is_no_mask(tmp_path):
    (tmp_path / "mask.png").write_text("no image")
    images = np.zeros((1, 72, 99), np.uint8)
    with pytest.raises(FrameSourceError, match=r"mask .*mask\.png: not an image"):
        lobula.frames.open(images, mask=tmp_path / "mask.png")
    with pytest.raises(FrameSourceError, match=r"none\.png: No such file"):
        lobula.frames.open(images, mask=tmp_path / "none.png")
    with pytest.raises(ParameterError, match="mask: ignores the whole picture"):
        lobula.frames.open(images, mask=np.zeros((72, 99), np.uint8))
    with pytest.raises(ParameterError, match=r"mask: shape \(72, 99, 3\): must be \(H, W\)"):
        lobula.frames.open(images, mask=np.zeros((72, 99, 3), np.uint8))
