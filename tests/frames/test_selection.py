"""Which frames of a source come out."""

from __future__ import annotations

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError, ParameterError
from lobula.frames.selection import Picture, Selection, increasing

IMAGES = np.zeros((10, 24, 32), np.uint8)


def indices(**wanted):
    """Numbers that come out of ten frames, one every 0.5 s."""
    with lobula.frames.open(IMAGES, times_s=np.arange(10) * 0.5, size=(32, 24), **wanted) as frames:
        return [frame.index for frame in frames]


def test_stretch_of_time_has_its_start_and_not_its_end():
    assert indices(start_s=1.0, end_s=2.5) == [2, 3, 4]


def test_stretches_side_by_side_make_the_whole():
    assert indices(end_s=2.2) + indices(start_s=2.2) == list(range(10))


def test_stride_and_limit():
    assert indices(stride=3) == [0, 3, 6, 9]
    assert indices(start_s=1.0, stride=2, max_frames=3) == [2, 4, 6]


def test_nothing_in_the_stretch_is_said():
    with pytest.raises(FrameSourceError, match="array: no frame from 60 s: must lie inside"):
        indices(start_s=60)


def test_expected_counts():
    assert Selection().expected(100, 30.0) == 100
    assert Selection(start_s=1.0, end_s=2.0).expected(100, 30.0) == 30
    assert Selection(stride=4, max_frames=20).expected(100, 30.0) == 20
    assert Selection(stride=4).expected(100, 30.0) == 25
    assert Selection().expected(None, 30.0) is None
    assert Selection(end_s=2.0).expected(None, 30.0) == 60


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"start_s": -1}, "start_s = -1"),
        ({"end_s": float("nan")}, "end_s = nan"),
        ({"start_s": 2.0, "end_s": 2.0}, "end_s = 2: must be after start_s = 2"),
        ({"stride": 0}, "stride = 0: must be a whole number of 1 or more"),
        ({"stride": None}, "stride = None"),
        ({"max_frames": 0}, "max_frames = 0"),
        ({"max_frames": 2.5}, "max_frames = 2.5"),
    ],
)
def test_refuses(arguments, message):
    with pytest.raises(ParameterError, match=message):
        Selection(**arguments)


@pytest.mark.parametrize(
    ("times_s", "message"),
    [
        ([0.0, 0.1, 0.1], r"clip\.mp4: frame 2: time stands still: 0\.100000 s after 0\.100000 s: must increase"),
        ([0.0, 0.2, 0.1], r"clip\.mp4: frame 2: time runs backwards: 0\.100000 s after 0\.200000 s: must increase"),
        ([0.0, float("nan")], r"frame 1: time runs backwards: nan s"),
    ],
)
def test_stamps_must_increase(times_s, message):
    pictures = (Picture(None, t, i) for i, t in enumerate(times_s))
    with pytest.raises(FrameSourceError, match=message) as caught:
        list(increasing(pictures, "clip.mp4"))
    assert caught.value.on_the_way
