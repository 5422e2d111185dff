"""What can be wrong with a request or its input: one line, the documented exit code, files that stay usable."""

from __future__ import annotations

import sys

import av
import numpy as np
import pytest

import lobula
from lobula.errors import LobulaError
from lobula.report.png import write_png
from lobula.report.trace_file import read_trace


def write(path, pictures, codec="ffv1", **options):
    """A clip at 30 Hz."""
    with av.open(str(path), "w", options=options) as container:
        stream = container.add_stream(codec, rate=30)
        stream.height, stream.width = pictures[0].shape
        stream.pix_fmt = "gray"
        for i, picture in enumerate(pictures):
            frame = av.VideoFrame.from_ndarray(picture, "gray")
            frame.pts = i
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    return path


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["nowhere.mp4"], "nowhere.mp4: no such file or folder"),
        (["notes.mp4"], "notes.mp4"),
        (["empty.mp4"], "empty.mp4"),
        (["folder"], "folder: no images in it"),
        (["none*.png"], "none*.png"),
        (["tiny.mkv"], "tiny.mkv: picture of 1 x 1 px: must be at least 32 x 24"),
        (["clip", "--preset", "papr"], "preset 'papr': must be one of default,"),
        (["clip", "--neurons", "some"], "must be str one of all, lgmds, lgmd2"),
        (["clip", "--set", "lamina.dog.sigma=2"], "unknown setting lamina.dog.sigma: did you mean sigma_px?"),
        (["clip", "--set", "lamina.dog.sigma_px=-2"], "sigma_px = -2: must be float in [0.3, 32] px"),
        (["clip", "--set", "lamina"], "must be PATH=VALUE"),
        (["clip", "--config", "none.toml"], "settings file none.toml: no such file"),
        (["clip", "--config", "wrong.toml"], "file wrong.toml: unknown setting decison: did you mean decision?"),
        (["clip", "--config", "notes.mp4"], "settings file notes.mp4: is not TOML"),
        (["clip", "--sensitivity", "1.5"], "sensitivity = 1.5: must be in [0, 1]"),
        (["clip", "--engine", "gpu"], "engine 'gpu': must be one of auto, core, reference"),
        (["clip", "--size", "99"], "--size '99': must be WIDTHxHEIGHT"),
        (["clip", "--size", "8x8"], "size = (8, 8): must be (width, height) of at least 32 x 24"),
        (["clip", "--fit", "zoom"], "fit = 'zoom': must be one of crop, squeeze, pad"),
        (["clip", "--roi", "1,2,3"], "--roi '1,2,3': must be X,Y,WIDTH,HEIGHT"),
        (["clip", "--roi", "90,0,40,40"], "roi = (90, 0, 40, 40): must be"),
        (["clip", "--rotate", "45"], "rotate = 45: must be one of 0, 90, 180, 270"),
        (["clip", "--flip", "x"], "flip = 'x': must be one of h, v, hv"),
        (["clip", "--mask", "none.png"], "none.png"),
        (["clip", "--start", "9"], "no frame from 9 s: must lie inside the source"),
        (["clip", "--start", "2", "--end", "1"], "must be after start_s"),
        (["clip", "--stride", "0"], "stride = 0: must be a whole number of 1 or more"),
        (["clip", "--pixel-format", "gray8"], "pixel_format"),
        (["clip", "--trace", "t.txt"], "trace t.txt: must end in .csv"),
        (["clip", "--annotate", "t.avi"], "must end in .mp4"),
        (["clip", "--trace", "no/t.csv"], "cannot write no/t.csv: no such folder no"),
    ],
)  # fmt: skip
def test_a_wrong_request(call, clip, tmp_path, arguments, says):
    (tmp_path / "notes.mp4").write_text("not a video\n")
    (tmp_path / "empty.mp4").write_bytes(b"")
    (tmp_path / "folder").mkdir()
    (tmp_path / "wrong.toml").write_text("[decison]\nneurons = 'all'\n")
    write(tmp_path / "tiny.mkv", [np.zeros((1, 1), np.uint8)] * 3)
    done = call("run", *(clip if a == "clip" else a for a in arguments), "--json")
    assert done.code == 2
    assert done.err.startswith("lobula: ")
    assert done.err.count("\n") == 1
    assert says in done.err
    (summary,) = done.records  # one, even now, and no header
    assert (summary["type"], summary["status"]) == ("summary", "refused")
    assert summary["problems"] == [done.err.removeprefix("lobula: ").strip()]


def test_a_truncated_clip_is_used_as_far_as_it_goes(call, movie, tmp_path):
    whole = write(tmp_path / "whole.mp4", list(movie.images), "libx264", movflags="faststart").read_bytes()
    (tmp_path / "cut.mp4").write_bytes(whole[: len(whole) // 2])
    done = call("run", "cut.mp4", "--json", "--trace", "t.csv")
    summary = done.records[-1]
    assert done.code == 3
    assert (summary["type"], summary["status"]) == ("summary", "source_failed")
    assert 0 < summary["frames"] < 91
    assert len(read_trace(tmp_path / "t.csv")) == summary["frames"]
    assert done.err.startswith("lobula: cut.mp4: damaged or cut off after ")


def test_a_clip_that_ends_early_without_a_fault_is_noted(call, movie, tmp_path):
    whole = write(tmp_path / "whole.mkv", list(movie.images)).read_bytes()
    (tmp_path / "cut.mkv").write_bytes(whole[: len(whole) // 2])
    done = call("run", "cut.mkv", "--json")
    assert done.code == 0
    assert "before the end its header names" in done.err
    assert done.records[-1]["notes"] == [done.err.removeprefix("lobula: ").strip()]


def test_a_picture_that_changes_size(call, tmp_path):
    for i in range(6):
        shape = (72, 99) if i < 4 else (60, 80)
        write_png(tmp_path / f"{i}.png", np.full(shape, 40 * i, np.uint8))
    done = call("run", tmp_path, "--json", "--trace", "t.csv")
    assert done.code == 3
    assert "picture is 80 x 60 px after 99 x 72: must stay the same" in done.err
    assert (done.records[-1]["status"], done.records[-1]["frames"]) == ("source_failed", 4)
    assert len(read_trace("t.csv")) == 4


@pytest.mark.parametrize(("third", "says"), [("0.1", "stands still"), ("0.05", "runs backwards")])
def test_stamps_that_do_not_increase(call, tmp_path, third, says):
    for i in range(3):
        write_png(tmp_path / f"{i}.png", np.full((72, 99), 40 * i, np.uint8))
    (tmp_path / "times.csv").write_text(f"file,time_s\n0.png,0\n1.png,0.1\n2.png,{third}\n")
    done = call("run", tmp_path)
    assert done.code == 2
    assert f"times.csv: line 4: time {says}" in done.err


@pytest.mark.parametrize(
    ("image", "says"),
    [
        (np.full((72, 99), np.nan), "holds NaN or infinity"),
        (np.zeros((72, 99), np.int32), "dtype int32: must be uint8 or float in 0..255"),
        (np.zeros((72, 99, 3), np.uint8), "must be (H, W)"),
        (np.linspace(0, 1, 72 * 99).reshape(72, 99), "must be 0..255; use image * 255"),
        (np.full((72, 99), 300.0), "must lie in 0..255"),
        (np.zeros((1, 1), np.uint8), "must be at least 32 x 24"),
    ],
)
def test_arrays_that_are_no_luminance(image, says):
    with pytest.raises(LobulaError) as refused:
        lobula.Network().step(image, 0.0)
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("name", ["full.csv", "full.jsonl"])
def test_a_full_disk_under_the_trace(call, clip, tmp_path, name):
    (tmp_path / name).symlink_to("/dev/full")
    done = call("run", clip, "--json", "--trace", name, "--annotate", "out.mp4", "--max-frames", 20)
    assert done.code == 3
    assert done.err == f"lobula: cannot write {name}: the disk is full\n"
    assert (done.records[-1]["status"], done.records[-1]["frames"]) == ("output_failed", 20)
    with lobula.open("out.mp4") as video:  # the other output is whole
        assert len(list(video)) == 20


def test_a_full_disk_under_standard_output(spawn, clip):
    with open("/dev/full", "w") as full:
        process = spawn("run", clip, "--json", "--trace", "t.csv", stdout=full)
        _, err = process.communicate(timeout=30)
        assert (process.returncode, err) == (3, "lobula: cannot write standard output: the disk is full\n")
        other = spawn("config", "show", stdout=full)
        _, err = other.communicate(timeout=30)
    assert other.returncode == 3
    assert err.startswith("lobula: cannot write standard output")
    assert err.count("\n") == 1


def test_a_pipe_that_holds_nothing(call, monkeypatch):
    with open("/dev/null") as nothing:
        monkeypatch.setattr(sys, "stdin", nothing)
        done = call("run", "-", "--json")
    assert done.code == 2
    assert done.err.startswith("lobula: -: not a stream that FFmpeg recognises")
    assert [record["status"] for record in done.records] == ["refused"]


def test_a_pattern_without_quotes(call):
    names = [f"{i}.png" for i in range(100)]
    line = call("run", *names).err
    assert 'quote a pattern, as in "shots/*.png"' in line
    assert "(1.png ...)" in line
    assert "2.png" not in line
    assert "(b.png)" in call("run", "a.png", "b.png").err


def test_an_empty_file_is_called_that(call, tmp_path):
    (tmp_path / "empty.mp4").write_bytes(b"")
    assert call("run", "empty.mp4").err == "lobula: empty.mp4: is empty: must be a file that FFmpeg decodes\n"
