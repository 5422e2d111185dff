"""The MP4: what a browser plays, at the times it was given, checked before it is there."""

import itertools
import math
import struct
from pathlib import Path

import av
import numpy as np
import pytest

from lobula.errors import OutputError, ShapeError
from lobula.report.h264 import H264Encoder
from lobula.report.mp4 import Mp4Writer, check_h264

TIMES_S = [10.0, 10.04, 10.05, 10.3, 11.0, 11.0333]  # uneven on purpose


def write(path: Path, times_s: list[float] = TIMES_S) -> Path:
    video = Mp4Writer(path, 64, 48, fps=30.0, about={"settings_hash": "0123456789ab"})
    for number, time_s in enumerate(times_s):
        video.write(np.full((48, 64, 3), (200, 40 * number, 30), np.uint8), time_s)
    video.finish()
    return path


def boxes(data: bytes) -> list[str]:
    """Names of the top-level boxes of an MP4, in order (ISO/IEC 14496-12: size, then name)."""
    names, at = [], 0
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at : at + 8])
        names.append(name.decode())
        at += size
    return names


def test_a_browser_plays_it(tmp_path: Path) -> None:
    path = write(tmp_path / "v.mp4")
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        assert (stream.codec_context.name, stream.codec_context.pix_fmt) == ("h264", "yuv420p")
        assert stream.frames == len(TIMES_S)
        assert "0123456789ab" in container.metadata["comment"]
    names = boxes(path.read_bytes())
    assert names.index("moov") < names.index("mdat")  # faststart: the index comes first
    assert "moof" not in names
    assert list(tmp_path.iterdir()) == [path]


def test_frames_keep_their_times_and_colours(tmp_path: Path) -> None:
    with av.open(str(write(tmp_path / "v.mp4"))) as container:
        frames = list(container.decode(video=0))
        length_s = float(container.streams.video[0].duration * container.streams.video[0].time_base)
    assert [f.time for f in frames] == pytest.approx([t - TIMES_S[0] for t in TIMES_S], abs=1 / 90_000)
    assert length_s == pytest.approx(11.0333 - 10.0 + 0.0333, abs=2 / 90_000)  # the last one shows as long as its gap
    for number, frame in enumerate(frames):
        middle = frame.to_ndarray(format="rgb24")[24, 32].astype(int)
        assert np.abs(middle - (200, 40 * number, 30)).max() <= 8


def test_part_is_fragmented_and_plays_before_the_end(tmp_path: Path) -> None:
    video = Mp4Writer(tmp_path / "v.mp4", 64, 48, fps=10.0)
    for number in range(60):
        video.write(np.full((48, 64, 3), number, np.uint8), number / 10)
    assert not (tmp_path / "v.mp4").exists()
    data = video.part.read_bytes()
    assert boxes(data)[:3] == ["ftyp", "moov", "moof"]
    with av.open(str(video.part)) as container:
        assert sum(1 for _ in container.decode(video=0)) >= 54  # all but the open half second
    video.abandon()


def test_same_tick_moves_on_by_one(tmp_path: Path) -> None:
    with av.open(str(write(tmp_path / "v.mp4", [0.0, 1e-7, 2e-7]))) as container:
        assert [frame.pts for frame in container.decode(video=0)] == [0, 1, 2]


LIMIT_S = (2**31 - 1) / 90_000  # from here on, 6.6 h, FFmpeg sets the stamps itself


@pytest.mark.parametrize("pause_s", [20_000.0, LIMIT_S - 1 / 90_000, LIMIT_S, 30_000.0, 86_400.0, 31 * 86_400.0])
def test_a_pause_of_any_length_is_a_still_picture(tmp_path: Path, pause_s: float) -> None:
    times_s = [0.0, 0.04, 0.08, 0.08 + pause_s, 0.12 + pause_s, 0.12 + 2 * pause_s]
    with av.open(str(write(tmp_path / "v.mp4", times_s))) as container:
        shown = [(f.time, int(f.to_ndarray(format="rgb24")[24, 32, 1])) for f in container.decode(video=0)]
    for number, (time_s, until_s) in enumerate(itertools.pairwise([*times_s, math.inf])):
        greens = [green for at_s, green in shown if time_s - 1e-4 < at_s < until_s - 1e-4]
        assert greens == pytest.approx([40 * number] * len(greens), abs=8)
        assert any(at_s == pytest.approx(time_s, abs=2e-5) for at_s, _ in shown)
    assert max(np.diff([at_s for at_s, _ in shown])) <= 2**30 / 90_000 + 1e-4
    assert shown[-1][0] == pytest.approx(times_s[-1], abs=2e-5)


def test_the_part_keeps_the_times_of_a_pause_too(tmp_path: Path) -> None:
    video = Mp4Writer(tmp_path / "v.mp4", 64, 48)
    for time_s in (0.0, 30_000.0, 30_000.5, 30_001.0, 30_001.5, 30_002.0):
        video.write(np.zeros((48, 64, 3), np.uint8), time_s)
    with av.open(str(video.part)) as container:
        times_s = [frame.time for frame in container.decode(video=0)]
    assert len(times_s) >= 6  # 0 s, two repeats, and all but the last half second
    assert set(times_s) - {2**30 / 90_000, 2**31 / 90_000} <= {0.0, 30_000.0, 30_000.5, 30_001.0, 30_001.5, 30_002.0}
    video.abandon()


def test_a_stamp_months_ahead_is_refused_at_once(tmp_path: Path) -> None:
    video = Mp4Writer(tmp_path / "v.mp4", 64, 48)
    video.write(np.zeros((48, 64, 3), np.uint8), 0.0)
    with pytest.raises(OutputError, match=r"^cannot write .*v\.mp4: a picture comes 19676 days after the one"):
        video.write(np.zeros((48, 64, 3), np.uint8), 1.7e9)  # from the time since the start to that since 1970
    video.abandon()
    assert video.part.exists()


def test_stamps_that_were_not_kept_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(H264Encoder, "repeats", lambda self, time_s: ())
    with pytest.raises(OutputError, match=r"reads back as \('h264', 'yuv420p', 3, \d+\), not as .*, 3, 2700003000\)"):
        write(tmp_path / "v.mp4", [0.0, 30_000.0, 30_000 + 1 / 30])
    assert [path.name for path in tmp_path.iterdir()] == ["v.part.mp4"]


def test_odd_size_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ShapeError, match="65 x 48 px: width and height must be even"):
        Mp4Writer(tmp_path / "v.mp4", 65, 48)


def test_without_the_encoder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(av, "codecs_available", {"mpeg4"})
    with pytest.raises(OutputError, match="no libx264 encoder"):
        Mp4Writer(tmp_path / "v.mp4", 64, 48)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("path", ["none/v.mp4", "/dev/full/v.mp4"])
def test_folder_that_is_none(tmp_path: Path, path: str) -> None:
    with pytest.raises(OutputError, match=r"^cannot write .*v\.mp4: ") as caught:
        Mp4Writer(tmp_path / path, 64, 48)
    assert "\n" not in str(caught.value)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_full_disk(tmp_path: Path) -> None:
    (tmp_path / "v.part.mp4").symlink_to("/dev/full")
    with pytest.raises(OutputError, match="the disk is full"):
        write(tmp_path / "v.mp4")
    assert not (tmp_path / "v.mp4").exists()


def test_check_finds_a_wrong_count_and_a_wrong_codec(tmp_path: Path) -> None:
    path = write(tmp_path / "v.mp4")
    last_tick = round((TIMES_S[-1] - TIMES_S[0]) * 90_000)
    check_h264(path, len(TIMES_S), last_tick)
    for frames, tick in ((7, last_tick), (6, last_tick + 1)):
        with pytest.raises(OutputError, match=rf"reads back as \('h264', 'yuv420p', 6, {last_tick}\)"):
            check_h264(path, frames, tick)
    with av.open(str(tmp_path / "w.mp4"), "w") as container:
        stream = container.add_stream("mpeg4", rate=30)
        stream.width, stream.height, stream.pix_fmt = 64, 48, "yuv420p"
        container.mux(stream.encode(av.VideoFrame(64, 48, "yuv420p")))
        container.mux(stream.encode(None))
    with pytest.raises(OutputError, match="reads back as"):
        check_h264(tmp_path / "w.mp4", 1, 0)
    (tmp_path / "x.mp4").write_bytes(b"no video")
    with pytest.raises(OutputError):
        check_h264(tmp_path / "x.mp4", 1, 0)


def test_failed_check_keeps_the_old_video_and_the_part(tmp_path: Path) -> None:
    (tmp_path / "v.mp4").write_bytes(b"old")
    video = Mp4Writer(tmp_path / "v.mp4", 64, 48)
    video.write(np.zeros((48, 64, 3), np.uint8), 0.0)
    video.frames += 1  # a frame got lost
    with pytest.raises(OutputError, match=r"v\.part\.mp4 holds what was encoded"):
        video.finish()
    assert (tmp_path / "v.mp4").read_bytes() == b"old"
    check_h264(video.part, 1, 0)
