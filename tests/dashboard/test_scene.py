"""Maps as the page gets them: where they lie on the picture, a signed byte a pixel, a scale that does not flicker."""

from __future__ import annotations

import numpy as np
import pytest

from lobula.dashboard.scene import MAP_GROUPS, MapScale, box_of
from lobula.frames.geometry import View, lay_out
from lobula.model.network import TAPS


def box(view: View, width: int, height: int):
    return box_of(lay_out(view, width, height, 0, "picture"), *view.size)


@pytest.mark.parametrize(
    ("view", "size", "expected"),
    [
        (View(), (198, 144), (0, 0, 1, 1)),  # the same shape
        (View(), (400, 144), (101 / 400, 0, 198 / 400, 1)),  # the middle of a wide one
        (View(fit="squeeze"), (400, 144), (0, 0, 1, 1)),
        (View(fit="pad"), (198, 72), (0, -0.5, 1, 2)),  # 36 rows of picture in 72: grey above and below
        (View(roi=(99, 0, 99, 72)), (198, 144), (0.5, 0, 0.5, 0.5)),
        (View(rotate=90), (144, 198), (0, 0, 1, 1)),
    ],
)
def test_where_a_map_lies(view, size, expected):
    assert box(view, *size) == pytest.approx(expected, abs=0.01)


def test_a_map_in_bytes():
    packet = MapScale()("motion", np.array([[0.5, -2.0], [0.0, 1.0]], np.float32))
    assert (packet.peak, packet.width, packet.height) == (2.0, 2, 2)
    assert np.frombuffer(packet.data, np.int8).tolist() == [32, -127, 0, 64]  # 127 / 4 is 31.75


def test_the_scale_rises_at_once_and_falls_slowly():
    scale = MapScale()
    peaks = [scale("change", np.full((2, 2), v, np.float32)).peak for v in (1.0, 4.0, 0.0, 0.0)]
    assert peaks == pytest.approx([1.0, 4.0, 3.8, 3.61])
    assert scale("lamina", np.zeros((2, 2), np.float32)).peak < 1e-6  # each map has its own


def test_every_map_is_offered_once():
    assert sorted(name for names in MAP_GROUPS.values() for name in names) == sorted(TAPS)
