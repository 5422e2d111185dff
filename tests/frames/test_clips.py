"""Every real clip opens, decodes to its end and keeps increasing stamps; skipped where the clips are not at hand."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import lobula.frames

FOLDER = Path(os.environ.get("LOBULA_CLIPS") or Path(__file__).parents[3] / "shared" / "clips")
CLIPS = sorted(p for p in FOLDER.glob("*") if p.suffix in (".mp4", ".avi")) if FOLDER.is_dir() else []

pytestmark = pytest.mark.skipif(not CLIPS, reason="no real clips: set LOBULA_CLIPS to their folder")


@pytest.mark.parametrize("path", CLIPS, ids=[p.stem for p in CLIPS])
def test_opens_and_gives_sane_frames(path):
    with lobula.frames.open(path, max_frames=40) as frames:
        got = list(frames)
        assert frames.damaged == 0
    assert len(got) > 20
    times_s = np.array([f.time_s for f in got])
    assert times_s[0] == 0
    assert (np.diff(times_s) > 0).all()
    np.testing.assert_allclose(np.diff(times_s), 1 / frames.fps, rtol=0.5)
    assert [f.index for f in got] == list(range(len(got)))
    for frame in got:
        assert frame.image.shape == (72, 99)
        assert 0 <= frame.image.min() < frame.image.max() <= 255


def test_all_frames_announced_are_delivered():
    path = min(CLIPS, key=lambda p: p.stat().st_size)
    with lobula.frames.open(path) as frames:
        assert len(list(frames)) == frames.frame_count
