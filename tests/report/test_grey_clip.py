"""Grey clips come back bit for bit, at any size and with their own stamps."""

from __future__ import annotations

import numpy as np
import pytest

import lobula
from lobula.errors import OutputError, ParameterError
from lobula.report.grey_clip import write_grey_clip


@pytest.mark.parametrize("suffix", [".mp4", ".mkv"])
@pytest.mark.parametrize("size", [(33, 25), (99, 72), (64, 48)])
def test_noise_over_the_whole_range_comes_back_to_the_bit(tmp_path, suffix, size):
    rng = np.random.default_rng(1)
    images = rng.integers(0, 256, (12, size[1], size[0]), np.uint8)
    times_s = np.cumsum(rng.integers(1, 5, 12)) / 25  # uneven, in whole 1/25 s
    times_s -= times_s[0]
    path = tmp_path / f"a{suffix}"
    write_grey_clip(path, images, times_s.tolist(), 25.0)
    with lobula.open(path, size=size) as frames:
        read = list(frames)
    assert np.array_equal([f.image for f in read], images)
    assert [f.time_s for f in read] == pytest.approx(times_s.tolist(), abs=1e-6)


def test_floats_are_rounded(tmp_path):
    images = np.full((3, 48, 64), 99.6, np.float32)
    write_grey_clip(tmp_path / "a.mp4", images, [0.0, 0.1, 0.2], 10.0)
    with lobula.open(tmp_path / "a.mp4", size=(64, 48)) as frames:
        assert next(frames).image.max() == 100


def test_other_files_are_refused(tmp_path):
    with pytest.raises(ParameterError, match=r"must end in \.mp4, \.mkv"):
        write_grey_clip(tmp_path / "a.avi", [], [], 30.0)
    with pytest.raises(OutputError, match="no such folder"):
        write_grey_clip(tmp_path / "no" / "a.mp4", np.zeros((2, 48, 64), np.uint8), [0.0, 0.1], 30.0)
