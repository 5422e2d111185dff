"""PNG against FFmpeg's decoder, and what is no picture."""

from __future__ import annotations

import av
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from lobula.errors import OutputError, ShapeError
from lobula.report.png import encode_png, write_png

SHAPES = st.tuples(st.integers(1, 9), st.integers(1, 9))


def decoded(data: bytes, pixel_format: str):
    frame = next(iter(av.CodecContext.create("png", "r").decode(av.Packet(data))))
    return frame.to_ndarray(format=pixel_format)


@given(SHAPES.flatmap(lambda shape: arrays.arrays(np.uint8, shape)))
def test_grey_comes_back_as_it_was(picture):
    assert np.array_equal(decoded(encode_png(picture), "gray"), picture)


@given(SHAPES.flatmap(lambda shape: arrays.arrays(np.uint8, (*shape, 3))))
def test_colour_comes_back_as_it_was(picture):
    assert np.array_equal(decoded(encode_png(picture), "rgb24"), picture)


@pytest.mark.parametrize("shape", [(4,), (4, 4, 4), (2, 3, 1)])
def test_other_shapes_are_refused(shape):
    with pytest.raises(ShapeError, match="must be uint8"):
        encode_png(np.zeros(shape, np.uint8))


def test_other_types_are_refused():
    with pytest.raises(ShapeError, match="float64"):
        encode_png(np.zeros((4, 4)))


def test_no_such_folder(tmp_path):
    with pytest.raises(OutputError, match="no such folder"):
        write_png(tmp_path / "no" / "a.png", np.zeros((4, 4), np.uint8))
