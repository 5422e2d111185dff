"""Bad input: one clear line, and everything that could be read has been delivered."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError

from .clips import moving_bar, write_clip, write_lossless, write_sizes


def refusal(source, **options):
    """The line with which a source is refused when it is opened."""
    with pytest.raises(FrameSourceError) as caught:
        lobula.frames.open(source, **options)
    assert not caught.value.on_the_way
    assert "\n" not in str(caught.value)
    return str(caught.value)


def read_until_failure(source, **options):
    frames = []
    with lobula.frames.open(source, **options) as opened, pytest.raises(FrameSourceError) as caught:
        frames.extend(opened)
    assert caught.value.on_the_way
    assert "\n" not in str(caught.value)
    return frames, str(caught.value)


def test_missing_file(tmp_path):
    assert refusal(tmp_path / "none.mp4") == f"{tmp_path}/none.mp4: no such file or folder"


@pytest.mark.parametrize("content", [b"not a video\n" * 50, bytes(range(256)) * 40])
@pytest.mark.parametrize("name", ["a.mp4", "a.txt", "a"])
def test_not_a_video(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    assert refusal(tmp_path / name).startswith(f"{tmp_path / name}: not a video")


def test_cut_off_before_its_index(tmp_path):
    path = write_clip(tmp_path / "a.mp4", moving_bar(20))
    path.write_bytes(path.read_bytes()[:900])
    assert "not a video: must be a file that FFmpeg decodes, not cut off before its index" in refusal(path)


def test_no_frames(tmp_path):
    path = write_clip(tmp_path / "a.avi", moving_bar(2), codec="mjpeg", pixel_format="yuvj420p")
    data = path.read_bytes()
    path.write_bytes(data[: data.index(b"movi") + 4])
    assert "a.avi: no" in refusal(path)


def test_one_pixel(tmp_path):
    path = write_lossless(tmp_path / "a.mkv", [np.zeros((1, 1), np.uint8)] * 3)
    assert refusal(path) == f"{path}: picture of 1 x 1 px: must be at least 32 x 24"


def test_truncated_file_delivers_what_it_holds(tmp_path):
    path = write_clip(
        tmp_path / "a.mp4", moving_bar(60), options={"g": "10"}, container_options={"movflags": "faststart"}
    )
    whole = list(lobula.frames.open(path))
    path.write_bytes(path.read_bytes()[: path.stat().st_size * 7 // 10])
    frames, line = read_until_failure(path)
    assert "a.mp4: damaged or cut off after " in line
    assert 10 < len(frames) < 60
    for frame, original in zip(frames[:-1], whole, strict=False):
        assert (frame.index, frame.time_s) == (original.index, original.time_s)
        np.testing.assert_array_equal(frame.image, original.image)


def test_ending_early_without_a_fault_is_noted(tmp_path):
    path = write_clip(tmp_path / "a.mkv", moving_bar(60), codec="ffv1")
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    with lobula.frames.open(path) as frames:
        count = len(list(frames))
        assert 20 < count < 40
        assert len(frames.notes) == 1
        assert "before the end its header names" in frames.notes[0]


def test_damage_in_the_middle_is_counted(tmp_path):
    path = write_clip(tmp_path / "a.avi", moving_bar(40), codec="mjpeg", pixel_format="yuvj420p")
    data = bytearray(path.read_bytes())
    begin = len(data) // 2
    end = data.index(b"\xff\xd8\xff", begin)  # the next JPEG begins here
    again = data.rindex(b"\xff\xd8\xff", 0, begin)
    data[again : end - 8] = bytes(end - 8 - again)  # blank one picture, leave the chunk heads
    path.write_bytes(data)
    with lobula.frames.open(path) as frames:
        got = list(frames)
        assert frames.damaged == 1
    missing = set(range(40)) - {frame.index for frame in got}
    assert len(missing) == 1
    np.testing.assert_allclose([f.time_s for f in got], [f.index / 30 for f in got], atol=1e-6)


def test_damage_all_over_never_upsets_the_order(tmp_path):
    path = write_clip(tmp_path / "a.mp4", moving_bar(60), options={"g": "10", "bf": "2"})
    sound = path.read_bytes()
    for seed in range(12):
        rng = np.random.default_rng(seed)
        data = bytearray(sound)
        for at in rng.integers(60, len(data) * 3 // 4, 40):
            data[at] ^= 0xFF
        path.write_bytes(data)
        previous_s = -1.0
        with suppress(FrameSourceError), lobula.frames.open(path) as frames:
            for frame in frames:
                assert frame.time_s > previous_s
                previous_s = frame.time_s


def test_change_of_size_in_the_middle(tmp_path):
    path = write_sizes(tmp_path / "a.avi", moving_bar(3, 96, 64), moving_bar(3, 128, 96))
    frames, line = read_until_failure(path)
    assert len(frames) == 3
    assert line == f"{path}: frame 3: picture is 128 x 96 px after 96 x 64: must stay the same"


def test_bare_stream_without_a_rate(tmp_path):
    path = write_clip(tmp_path / "a.h264", moving_bar(5))
    assert refusal(path) == f"{path}: holds no time stamps: must be given its rate_hz (--rate)"


def test_standing_stamps(tmp_path):
    # matroska holds whole milliseconds: stamps 0.4 ms apart come to stand still
    path = write_clip(tmp_path / "a.mkv", moving_bar(4), codec="ffv1", rate=2500, stamps=[0, 10, 11, 12])
    frames, line = read_until_failure(path)
    assert "time stands still: 0.004000 s after 0.004000 s: must increase" in line
    assert line.startswith(f"{path}: frame {len(frames)}: ")


def test_a_region_outside_the_picture_closes_the_file(tmp_path):
    path = write_clip(tmp_path / "a.mp4", moving_bar(2))
    with pytest.raises(ValueError, match="roi"):
        lobula.frames.open(path, roi=(0, 0, 400, 400))


@pytest.mark.parametrize("name", ["picture", "decoded"])
def test_picture_before_the_first_frame(name):
    with (
        lobula.frames.open(np.zeros((2, 72, 99), np.uint8)) as frames,
        pytest.raises(FrameSourceError, match="array: no picture before the first frame"),
    ):
        getattr(frames, name)()
