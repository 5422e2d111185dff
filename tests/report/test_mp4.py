"""The MP4: what a browser plays, at the times it was given, checked before it is there."""

import struct
from pathlib import Path

import av
import numpy as np
import pytest

from lobula.errors import OutputError, ShapeError
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
    check_h264(path, len(TIMES_S))
    with pytest.raises(OutputError, match=r"reads back as \('h264', 'yuv420p', 6\)"):
        check_h264(path, 7)
    with av.open(str(tmp_path / "w.mp4"), "w") as container:
        stream = container.add_stream("mpeg4", rate=30)
        stream.width, stream.height, stream.pix_fmt = 64, 48, "yuv420p"
        container.mux(stream.encode(av.VideoFrame(64, 48, "yuv420p")))
        container.mux(stream.encode(None))
    with pytest.raises(OutputError, match="reads back as"):
        check_h264(tmp_path / "w.mp4", 1)
    (tmp_path / "x.mp4").write_bytes(b"no video")
    with pytest.raises(OutputError):
        check_h264(tmp_path / "x.mp4", 1)


def test_failed_check_keeps_the_old_video_and_the_part(tmp_path: Path) -> None:
    (tmp_path / "v.mp4").write_bytes(b"old")
    video = Mp4Writer(tmp_path / "v.mp4", 64, 48)
    video.write(np.zeros((48, 64, 3), np.uint8), 0.0)
    video.frames += 1  # a frame got lost
    with pytest.raises(OutputError, match=r"v\.part\.mp4 holds what was encoded"):
        video.finish()
    assert (tmp_path / "v.mp4").read_bytes() == b"old"
    check_h264(video.part, 1)
