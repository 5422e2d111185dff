"""The borders: which images and times come in, and what is said of the others."""

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.checks import MIN_HEIGHT, MIN_WIDTH, require_images, require_later, require_not_unit_range
from lobula.errors import LobulaError, ShapeError, TimeError

HERE = "Network.step"


def refused(images, ndims=(2,)):
    with pytest.raises(ShapeError, match=f"^{HERE}: ") as caught:
        require_images(images, ndims, HERE)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def grey(*shape, value=100, dtype=np.uint8):
    return np.full(shape, value, dtype)


def test_bytes_come_in_as_they_are():
    image = grey(24, 32)
    assert require_images(image, (2,), HERE) is image


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
def test_floats_come_in_as_float32(dtype):
    image = require_images(grey(24, 32, dtype=dtype), (2,), HERE)
    assert image.dtype == np.float32
    assert (image == 100).all()


def test_float32_is_not_copied():
    image = grey(24, 32, dtype=np.float32)
    assert require_images(image, (2,), HERE) is image


def test_views_and_lists_come_in():
    wide = grey(48, 64)
    assert require_images(wide[::2, ::2], (2,), HERE).shape == (24, 32)
    assert require_images(wide.T, (2,), HERE).shape == (64, 48)
    assert require_images(grey(24, 32, dtype=float).tolist(), (2,), HERE).dtype == np.float32


def test_blocks_and_batches():
    assert require_images(grey(5, 24, 32), (3, 4), HERE).shape == (5, 24, 32)
    assert require_images(grey(2, 5, 24, 32), (3, 4), HERE).shape == (2, 5, 24, 32)


def test_0_and_255_belong_to_the_range():
    image = np.linspace(0, 255, 24 * 32).reshape(24, 32)
    assert require_images(image, (2,), HERE).max() == 255


@pytest.mark.parametrize(
    ("shape", "ndims", "wanted"),
    [((24,), (2,), r"must be (H, W) luminance"), ((5, 24, 32), (2,), r"must be (H, W) luminance"),
     ((24, 32), (3, 4), r"must be (T, H, W) or (S, T, H, W) luminance"), ((), (2,), r"must be (H, W)")],
)  # fmt: skip
def test_rank(shape, ndims, wanted):
    assert f"shape {shape}: {wanted}" in refused(grey(*shape), ndims)


@pytest.mark.parametrize("channels", [3, 4])
@pytest.mark.parametrize(("leading", "ndims"), [((), (2,)), ((), (3, 4)), ((7,), (3, 4)), ((2, 7), (3, 4))])
def test_colour_is_refused_with_its_conversion(channels, leading, ndims):
    image = np.random.default_rng(0).integers(0, 256, (*leading, 24, 32, channels), np.uint8)
    message = refused(image, ndims)
    assert message.endswith("; colour: use image[..., :3] @ [0.299, 0.587, 0.114]")
    mended = image[..., :3] @ [0.299, 0.587, 0.114]
    assert require_images(mended, (len(leading) + 2,), HERE).shape == (*leading, 24, 32)


def test_the_conversion_of_white_is_white():
    assert require_images(grey(24, 32, 3, value=255) @ [0.299, 0.587, 0.114], (2,), HERE).max() == 255


@pytest.mark.parametrize("shape", [(23, 32), (24, 31), (1, 1), (3, 1000)])
def test_too_small(shape):
    assert refused(grey(*shape)).endswith(f"{shape[1]} x {shape[0]} px (width x height): must be at least 32 x 24")
    assert (MIN_WIDTH, MIN_HEIGHT) == (32, 24)


@pytest.mark.parametrize("shape", [(0, 32), (24, 0), (0, 0)])
def test_empty(shape):
    assert f"shape {shape}" in refused(grey(*shape))


@pytest.mark.parametrize("dtype", [np.int8, np.int32, np.uint16, np.int64, bool, complex, "U3", object])
def test_other_dtypes_are_refused_with_their_conversion(dtype):
    message = refused(np.zeros((24, 32), dtype))
    assert f"dtype {np.dtype(dtype)}: must be uint8 or float in 0..255" in message
    assert "astype('float32')" in message


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
def test_one_value_that_is_not_finite(bad, dtype):
    image = grey(24, 32, dtype=dtype)
    image[11, 13] = bad
    assert "holds NaN or infinity" in refused(image)


@pytest.mark.parametrize(("bad", "said"), [(-0.5, "values -0.5..100"), (255.5, "values 100..255.5")])
def test_one_value_outside(bad, said):
    image = grey(24, 32, dtype=np.float32)
    image[11, 13] = bad
    assert refused(image).endswith(f"{said}: must lie in 0..255")


def test_unit_range_is_refused_with_its_conversion():
    with pytest.raises(ShapeError, match=r"Network\.step: float values 0\.1\.\.0\.9 look like 0\.\.1: .* image \* 255"):
        require_not_unit_range(np.linspace(0.1, 0.9, 768).reshape(24, 32), HERE)


@pytest.mark.parametrize("image", [
    grey(24, 32, value=0, dtype=np.float32),  # black
    grey(24, 32, value=1, dtype=np.float32),  # one dark grey
    grey(24, 32) // 100,  # bytes are never 0..1
    np.linspace(0, 1.1, 768).reshape(24, 32),
])  # fmt: skip
def test_dark_pictures_are_not_unit_range(image):
    require_not_unit_range(image, HERE)


def test_time_comes_in_as_a_float():
    assert type(require_later(np.float32(1.5), None, HERE)) is float
    assert require_later(2, 1.5, HERE) == 2.0
    assert require_later(-5.0, -6.0, HERE) == -5.0


@pytest.mark.parametrize(
    ("time_s", "previous_s", "said"),
    [(1.0, 1.0, "time stands still: 1.000000 s after 1.000000 s: must increase"),
     (0.5, 1.0, "time runs backwards: 0.500000 s after 1.000000 s: must increase"),
     (math.nan, None, "time nan s: must be finite"), (math.inf, 1.0, "time inf s: must be finite")],
)  # fmt: skip
def test_time_that_does_not_run(time_s, previous_s, said):
    with pytest.raises(TimeError, match=f"^{HERE}: {re.escape(said)}$"):
        require_later(time_s, previous_s, HERE)


@settings(max_examples=50, deadline=None, derandomize=True)
@given(st.floats(), st.floats())
def test_time_only_increases(previous_s, time_s):
    try:
        assert require_later(time_s, previous_s, HERE) > previous_s or math.isnan(previous_s)
    except TimeError:
        assert not math.isfinite(time_s) or time_s <= previous_s


def test_errors_are_values_errors_and_our_own():
    for error in (ShapeError, TimeError):
        assert issubclass(error, ValueError)
        assert issubclass(error, LobulaError)


@pytest.mark.parametrize("bad", ["a", [1.0, 2.0], {}])
def test_a_time_that_is_no_number(bad):
    with pytest.raises(TimeError, match="must be a number of seconds"):
        require_later(bad, None, HERE)
