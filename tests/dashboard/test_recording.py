"""A recording by row: the frames that a run through it gives, however they are asked for and however few are kept."""

from __future__ import annotations

import numpy as np
import pytest

import lobula
from lobula.dashboard.recording import BLOCK, Cursor
from lobula.errors import FrameSourceError

from .clips import approach, recording


@pytest.fixture(scope="module")
def clip(tmp_path_factory):
    return approach(tmp_path_factory.mktemp("clips") / "approach.mp4")


HOW = [{}, {"start_s": 0.5, "end_s": 2.4}, {"stride": 3, "max_frames": 20}, {"start_s": 1.0, "stride": 2}]


@pytest.mark.parametrize("memory_bytes", [1 << 28, 0, 72 * 99 * BLOCK])
@pytest.mark.parametrize("how", HOW)
def test_blocks_hold_what_a_run_gives_the_first_time_and_again(clip, how, memory_bytes):
    with lobula.open(clip, **how) as frames:
        expected = list(frames)
    found = recording(clip, memory_bytes, **how)
    for _ in range(2):
        number, images, times_s, indices = 0, [], [], []
        while (block := found.block(number)) is not None:
            assert block.first == number * BLOCK
            images += list(block.images)
            times_s += block.times_s.tolist()
            indices += block.frames.tolist()
            number += 1
        np.testing.assert_array_equal(images, [frame.image for frame in expected])
        assert times_s == [frame.time_s for frame in expected]
        assert indices == [frame.index for frame in expected]
    assert len(found) == len(expected)
    assert (found.complete, found.problem) == (True, None)
    found.close()


@pytest.mark.parametrize("how", HOW)
def test_a_cursor_goes_anywhere(clip, how):
    with lobula.open(clip, **how) as frames:
        expected = [(frame, frames.picture()) for frame in frames]
    found = recording(clip, **how)
    while found.block(len(found) // BLOCK) is not None and not found.complete:
        pass
    cursor = Cursor(found)
    last = len(expected) - 1
    for row in (0, 1, 5, 5, last, last - 1, 2, min(40, last), 3):
        frame, picture = expected[row]
        shown = cursor.frame(row)
        assert (shown.index, shown.time_s) == (frame.index, frame.time_s)
        np.testing.assert_array_equal(shown.image, frame.image)
        decoded = cursor.decoded(row)
        assert (decoded.data.height, decoded.data.width) == picture.shape[:2]
    cursor.close()
    found.close()


def test_a_damaged_one_is_kept_as_far_as_it_goes(clip, tmp_path):
    torn = tmp_path / "torn.mkv"
    movie = lobula.stimuli.looming(scene="arena")
    import av

    with av.open(str(torn), "w") as container:
        stream = container.add_stream("ffv1", rate=30)
        stream.height, stream.width, stream.pix_fmt = 72, 99, "gray"
        for i, image in enumerate(movie.images[:80]):
            frame = av.VideoFrame.from_ndarray(image, "gray")
            frame.pts = i
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    data = torn.read_bytes()
    torn.write_bytes(data[: len(data) * 3 // 4])
    found = recording(torn)
    number = 0
    while found.block(number) is not None:
        number += 1
    assert 20 < len(found) < 80
    assert found.complete
    assert found.problem is None or "torn.mkv" in found.problem


def test_one_without_a_frame_is_refused(clip):
    found = recording(clip, start_s=60.0)
    with pytest.raises(FrameSourceError, match="no frame from 60 s"):
        found.block(0)


def test_a_file_that_has_gone(clip, tmp_path):
    here = tmp_path / "here.mp4"
    here.write_bytes(clip.read_bytes())
    found = recording(here)
    found.block(0)
    here.unlink()
    with pytest.raises(FrameSourceError, match=r"here.mp4: no such file"):
        Cursor(found).frame(0)
