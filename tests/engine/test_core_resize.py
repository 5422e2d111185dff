"""The core's area average against the NumPy one, and against means taken by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lobula.engine.library import available
from lobula.errors import ShapeError
from lobula.frames import AreaAverage, Rect

if not available():
    pytest.skip("the C core was not built", allow_module_level=True)

from lobula.engine.resize import CoreAreaAverage

LIMITED = (255 / 219, -16 * 255 / 219)


def test_means_by_hand():
    plane = np.array([[0, 10, 20, 30, 99], [40, 50, 60, 70, 99], [99, 99, 99, 99, 99]], np.uint8)
    halved = CoreAreaAverage(3, 5, Rect(0, 0, 4, 2), 1, 2)(plane)
    assert halved.tolist() == [[25.0, 45.0]]  # (0 + 10 + 40 + 50) / 4, (20 + 30 + 60 + 70) / 4
    thirds = CoreAreaAverage(3, 5, Rect(0, 0, 4, 1), 1, 3)(plane)
    assert thirds[0] == pytest.approx([2.5, 15.0, 27.5])  # 4 / 3 px each: (0 + 10 / 3) / (4 / 3), ...


def test_limited_range_becomes_full():
    plane = np.array([[16, 235, 0, 255]] * 4, np.uint8)
    image = CoreAreaAverage(4, 4, Rect(0, 0, 4, 4), 4, 4, *LIMITED)(plane)
    assert image[0] == pytest.approx([0, 255, 0, 255], abs=1e-4)


@given(st.data())
def test_the_same_as_numpy(data):
    height, width = data.draw(st.integers(1, 60)), data.draw(st.integers(1, 60))
    x, y = data.draw(st.integers(0, width - 1)), data.draw(st.integers(0, height - 1))
    crop = Rect(x, y, data.draw(st.integers(1, width - x)), data.draw(st.integers(1, height - y)))
    out = data.draw(st.integers(1, 20)), data.draw(st.integers(1, 20))
    luma = data.draw(st.sampled_from([(1.0, 0.0), LIMITED]))
    rng = np.random.default_rng(data.draw(st.integers(0, 99)))
    plane = rng.integers(0, 256, (height, width + 7), np.uint8)[:, :width]  # a decoder pads its rows
    ours = CoreAreaAverage(height, width, crop, *out, *luma)(plane)
    np.testing.assert_allclose(ours, AreaAverage(height, width, crop, *out, *luma)(plane), atol=2e-3)
    assert ours.dtype == np.float32
    assert ours.min() >= 0
    assert ours.max() <= 255


def test_columns_that_do_not_lie_side_by_side():
    wide = np.arange(48, dtype=np.uint8).reshape(4, 12)
    apart = wide[:, ::2]
    resize = CoreAreaAverage(4, 6, Rect(0, 0, 6, 4), 2, 3)
    assert np.array_equal(resize(apart), resize(np.ascontiguousarray(apart)))


def test_what_it_refuses():
    with pytest.raises(ShapeError, match="must lie inside the source"):
        CoreAreaAverage(10, 10, Rect(5, 5, 6, 5), 2, 2)
    with pytest.raises(ValueError, match=r"plane of \(9, 10\): made for \(10, 10\)"):
        CoreAreaAverage(10, 10, Rect(0, 0, 10, 10), 2, 2)(np.zeros((9, 10), np.uint8))
