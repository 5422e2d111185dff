from __future__ import annotations

import sys

import numpy as np
import pytest

from lobula.errors import MissingExtraError, ParameterError
from lobula.overhead import MarkerParams
from lobula.overhead.markers import INK_GREY, PAPER_GREY, disc_grey, marker_cells

pytest.importorskip("cv2")


def test_pattern_0_is_that_of_the_dictionary():
    """The dictionary's first two bytes are 181 and 50: 1011 0101 0011 0010, white where 1."""
    white = np.array([[1, 0, 1, 1], [0, 1, 0, 1], [0, 0, 1, 1], [0, 0, 1, 0]], bool)
    cells = marker_cells(0)
    assert np.array_equal(~cells[1:5, 1:5], white)
    assert cells[[0, 5]].all()
    assert cells[:, [0, 5]].all()


@pytest.mark.parametrize("marker_id", [-1, 50])
def test_there_are_50_patterns(marker_id):
    with pytest.raises(ParameterError, match=r"must be different numbers in 0\.\.49"):
        marker_cells(marker_id)


def test_a_disc_by_hand():
    """Of a 4 cm disc the square is 2.4 cm wide, a cell 0.4 cm; pattern 0's first inner row is 1011 from the left."""
    marker = MarkerParams()
    forward = np.array([0.6, 0.6, 0.6, 1.1, 0.0, 0.0, 0.0])
    left = np.array([0.6, 0.2, -0.2, 0.0, 1.3, 1.99, 2.01])
    grey = disc_grey(marker_cells(0), forward, left, marker)
    assert grey[:6].tolist() == [PAPER_GREY, INK_GREY, PAPER_GREY, INK_GREY, PAPER_GREY, PAPER_GREY]
    assert np.isnan(grey[6])


def test_without_opencv_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(MissingExtraError, match=r"pip install \"lobula\[opencv\]\""):
        marker_cells(0)


def test_an_opencv_without_the_detector_is_too_old(monkeypatch):
    monkeypatch.setitem(sys.modules, "cv2", type(sys)("cv2"))
    with pytest.raises(MissingExtraError, match=r"4\.9 or newer"):
        marker_cells(0)
