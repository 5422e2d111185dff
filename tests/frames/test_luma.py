"""Luma is 0..255 whatever the pixel format and range of the source."""

from __future__ import annotations

import av
import numpy as np
import pytest

from lobula.frames.luma import Luma

BLACK, GREY, WHITE = 16, 126, 235  # limited-range levels
LEVELS = np.tile(np.array([BLACK, GREY, WHITE, 60], np.uint8), (48, 16))  # (48, 64)
LIMITED_LUMA = (LEVELS.astype(float) - 16) * 255 / 219


def frame_of(pixel_format, *planes, width=64, height=48, color_range=0):
    """A frame whose planes hold the given rows, whatever padding the lines have."""
    frame = av.VideoFrame(width, height, pixel_format)
    for plane, rows in zip(frame.planes, planes, strict=True):
        data = np.zeros((plane.buffer_size // plane.line_size, plane.line_size), np.uint8)
        as_bytes = np.ascontiguousarray(rows).view(np.uint8).reshape(len(rows), -1)
        data[: len(rows), : as_bytes.shape[1]] = as_bytes
        plane.update(data.tobytes())
    if color_range:
        frame.color_range = color_range
    return frame


def luma_of(frame):
    luma = Luma(frame)
    return luma.plane(frame) * luma.gain + luma.offset


def chroma(height, width):
    return np.full((height, width), 128, np.uint8)


@pytest.mark.parametrize("color_range", [0, 1])
def test_yuv_is_limited_unless_it_says_full(color_range):
    frame = frame_of("yuv420p", LEVELS, chroma(24, 32), chroma(24, 32), color_range=color_range)
    np.testing.assert_allclose(luma_of(frame), LIMITED_LUMA, atol=1e-9)


@pytest.mark.parametrize(("pixel_format", "color_range"), [("yuv420p", 2), ("yuvj420p", 0), ("yuvj420p", 2)])
def test_full_range_is_taken_as_it_is(pixel_format, color_range):
    frame = frame_of(pixel_format, LEVELS, chroma(24, 32), chroma(24, 32), color_range=color_range)
    np.testing.assert_array_equal(luma_of(frame), LEVELS)


def test_grey_is_full_unless_it_says_limited():
    np.testing.assert_array_equal(luma_of(frame_of("gray", LEVELS)), LEVELS)
    np.testing.assert_allclose(luma_of(frame_of("gray", LEVELS, color_range=1)), LIMITED_LUMA, atol=1e-9)


def test_semi_planar_and_packed():
    nv12 = frame_of("nv12", LEVELS, chroma(24, 64))
    packed = np.full((48, 128), 128, np.uint8)
    packed[:, 0::2] = LEVELS
    np.testing.assert_allclose(luma_of(nv12), LIMITED_LUMA, atol=1e-9)
    np.testing.assert_allclose(luma_of(frame_of("yuyv422", packed)), LIMITED_LUMA, atol=1e-9)
    np.testing.assert_allclose(luma_of(frame_of("uyvy422", np.roll(packed, 1, axis=1))), LIMITED_LUMA, atol=1e-9)


@pytest.mark.parametrize(
    ("pixel_format", "shift"), [("yuv420p10le", 2), ("yuv420p12le", 4), ("yuv420p10be", 2), ("p010le", 8)]
)
def test_deep_yuv_is_read_as_eight_bits(pixel_format, shift):
    order = ">u2" if pixel_format.endswith("be") else "<u2"
    deep = (LEVELS.astype(np.uint16) << shift).astype(order)
    planes = [deep, *(np.zeros((24, 32), order) for _ in range(2))]
    if pixel_format == "p010le":
        planes = [deep, np.zeros((24, 64), order)]
    np.testing.assert_allclose(luma_of(frame_of(pixel_format, *planes)), LIMITED_LUMA, atol=1e-9)


def test_deep_grey_is_full():
    np.testing.assert_array_equal(luma_of(frame_of("gray16be", (LEVELS.astype(np.uint16) * 257).astype(">u2"))), LEVELS)


def test_rgb_is_weighted_as_luma():
    colours = np.array([[255, 255, 255], [255, 0, 0], [0, 255, 0], [0, 0, 255], [0, 0, 0], [10, 20, 30]], np.uint8)
    picture = np.tile(np.repeat(colours, 8, axis=0), (32, 1, 1))
    expected = picture @ np.array([0.299, 0.587, 0.114])  # ITU-R BT.601
    for pixel_format in ("rgb24", "bgr24", "rgba"):
        frame = av.VideoFrame.from_ndarray(picture, "rgb24").reformat(format=pixel_format)
        np.testing.assert_allclose(luma_of(frame), expected, atol=1)


def test_alpha_beside_grey_is_not_luma():
    both = np.full((48, 128), 77, np.uint8)
    both[:, 0::2] = LEVELS
    np.testing.assert_array_equal(luma_of(frame_of("ya8", both)), LEVELS)


@pytest.mark.parametrize(("width", "height"), [(33, 25), (97, 71)])
def test_odd_sizes(width, height):
    y = np.random.default_rng(0).integers(16, 236, (height, width), np.uint8)
    half = chroma((height + 1) // 2, (width + 1) // 2)
    frame = frame_of("yuv420p", y, half, half, width=width, height=height)
    np.testing.assert_array_equal(Luma(frame).plane(frame), y)


def test_planar_luma_is_not_copied():
    frame = frame_of("yuv420p", LEVELS, chroma(24, 32), chroma(24, 32))
    address = Luma(frame).plane(frame).__array_interface__["data"][0]
    assert address == frame.planes[0].buffer_ptr


def test_colour_picture():
    picture = np.random.default_rng(1).integers(0, 256, (48, 64, 3), np.uint8)
    frame = av.VideoFrame.from_ndarray(picture, "rgb24")
    np.testing.assert_array_equal(Luma(frame).rgb(frame), picture)
    np.testing.assert_array_equal(Luma(LEVELS).rgb(LEVELS)[:, :, 1], LEVELS)
