"""What lies outside the picture."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from lobula.model.borders import replicate

from .pictures import few, signed


def test_golden_one_pixel_wider():
    image = np.array([[1, 2], [3, 4]], np.float32)
    assert replicate(image, 1).tolist() == [[1, 1, 2, 2], [1, 1, 2, 2], [3, 3, 4, 4], [3, 3, 4, 4]]


@few
@given(signed, st.integers(1, 5))
def test_inside_stays_and_corners_repeat(image, margin):
    before = image.copy()
    wide = replicate(image, margin)
    assert wide.dtype == np.float32
    assert np.array_equal(wide[margin:-margin, margin:-margin], image)
    assert (wide[:margin, :margin] == image[0, 0]).all()
    assert (wide[-margin:, -margin:] == image[-1, -1]).all()
    assert np.array_equal(image, before)
