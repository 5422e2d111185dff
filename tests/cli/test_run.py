"""``lobula run``: what a user gets, from every kind of source."""

from __future__ import annotations

import json
import os
import subprocess

import numpy as np
import pytest

import lobula
from lobula.report.trace_file import read_trace
from lobula.types import NEURONS, STATES, TRACE_DTYPE

HEADER = {"type", "version", "preset", "neurons", "settings_hash", "engine", "source", "width", "height", "fps"}
STATE = {"type", "state", "phase", "frame", "time_s"}
START = {"type", "phase", "id", "frame", "time_s", *NEURONS}
END = {"type", "phase", "id", "frame", "time_s", "peak_frame"}
SUMMARY = {"type", "status", "frames", "dropped", "damaged", "collisions", "duration_s", "ms_per_frame", "ms_worst"}


@pytest.fixture
def expected(movie):
    """The same movie through the library."""
    return lobula.Network().run(movie.images, movie.times_s)


def test_records_in_order_and_to_the_letter(call, clip):
    done = call("run", clip, "--json")
    assert done.code == 0
    header, *events, summary = done.records
    assert set(header) == HEADER
    assert (header["width"], header["height"], header["fps"], header["source"]) == (99, 72, 30.0, str(clip))
    assert set(summary) == SUMMARY
    assert (summary["status"], summary["frames"], summary["duration_s"]) == ("ok", 91, pytest.approx(91 / 30))
    for record in events:
        wanted = STATE if record["type"] == "state" else START if record["phase"] == "start" else END
        assert set(record) == wanted
        assert record["phase"] in ("start", "end")
        assert record.get("state", "ok") in STATES
    (start,) = [r for r in events if r["type"] == "collision" and r["phase"] == "start"]
    assert start["time_s"] < 3.0  # before contact
    assert summary["collisions"] == 1


def test_a_clip_an_array_and_the_trace_agree(call, clip, expected):
    assert call("run", clip, "--trace", "t.npz").code == 0
    trace = read_trace("t.npz")
    assert trace.dtype == TRACE_DTYPE
    assert trace["time_s"] == pytest.approx(expected["time_s"])
    for name in set(TRACE_DTYPE.names) - {"time_s"}:
        if trace[name].dtype.kind == "f":  # 2.7666666 s from a file's ticks is not to the bit 83 / 30
            assert trace[name] == pytest.approx(expected[name], abs=1e-9)
        else:
            assert np.array_equal(trace[name], expected[name]), name


def test_a_folder_a_pattern_and_a_pipe_give_the_same_events(call, clip, movie, tmp_path, spawn):
    events = [r for r in call("run", clip, "--json").records if r["type"] == "collision"]
    assert call("stimulus", "looming", "--set", "scene=arena", "--set", "speed_cm_s=12", "--out", "shots").code == 0
    for source in ("shots", "shots/*.png"):
        assert [r for r in call("run", source, "--json").records if r["type"] == "collision"] == events
    raw = spawn("run", "-", "--json", "--pixel-format", "gray8", "--input-size", "99x72", "--rate", 30,
                stdin=subprocess.PIPE, text=False)  # fmt: skip
    out, err = raw.communicate(movie.images.tobytes(), timeout=30)
    assert (raw.returncode, err) == (0, b"")
    assert [r for r in map(json.loads, out.splitlines()) if r["type"] == "collision"] == events


def test_without_json_standard_output_is_empty_and_people_are_told(call, clip):
    done = call("run", clip)
    assert (done.code, done.out) == (0, "")
    assert "COLLISION 1" in done.err
    assert "ok: 91 frames, 1 collision," in done.err


def test_all_outputs_at_once(call, clip, tmp_path):
    files = ["--trace", "t.csv", "--annotate", "r/out.mp4", "--report", "r"]
    done = call("run", clip, "--json", *files, "--max-frames", 30)
    assert (done.code, done.err) == (0, "")
    assert len(read_trace(tmp_path / "t.csv")) == 30
    assert "out.mp4" in (tmp_path / "r" / "index.html").read_text()
    with lobula.open(tmp_path / "r" / "out.mp4") as video:
        assert len(list(video)) == 30


def test_settings_reach_the_network(call, clip):
    plain, lgmds, strict, file = (
        call("run", clip, "--json", *options).records
        for options in ([], ["--neurons", "lgmds"], ["--set", "decision.collision_spikes=90"], ["--sensitivity", "0"])
    )
    assert len({r[0]["settings_hash"] for r in (plain, lgmds, strict, file)}) == 4
    assert lgmds[0]["neurons"] == "lgmds"
    assert strict[-1]["collisions"] == 0


def test_a_settings_file(call, clip, tmp_path):
    (tmp_path / "own.toml").write_text('preset = "paper"\n[decision]\ncollision_spikes = 90\n')
    header, *_, summary = call("run", clip, "--json", "--config", "own.toml").records
    assert (header["preset"], summary["collisions"]) == ("paper", 0)
    header, *_, summary = call(
        "run", clip, "--json", "--config", "own.toml", "--set", "decision.collision_spikes=4"
    ).records
    assert summary["collisions"] == 1


def test_the_part_of_the_clip_and_of_the_picture(call, clip):
    summary = call("run", clip, "--json", "--start", "1", "--end", "2", "--stride", "2").records[-1]
    assert summary["frames"] == 15
    header, *_, summary = call(
        "run", clip, "--json", "--size", "64x48", "--roi", "10,5,80,60", "--max-frames", "7"
    ).records
    assert (header["width"], header["height"], summary["frames"]) == (64, 48, 7)


def test_both_engines_agree(call, clip):
    events = [
        [(r["type"], r["phase"], r["frame"]) for r in call("run", clip, "--json", "--engine", engine).records[1:-1]]
        for engine in ("auto", "reference")
    ]
    assert events[0] == events[1]


def test_scaled_kernels_are_in_the_settings(call, clip):
    hashes = [
        call("run", clip, "--json", "--size", "198x144", "--max-frames", "5", *more).records[0]["settings_hash"]
        for more in ([], ["--scale-kernels"])
    ]
    assert hashes[0] != hashes[1]


def test_python_m_lobula_and_a_reader_that_leaves(spawn, clip):
    process = spawn("run", clip, "--json")
    assert json.loads(process.stdout.readline())["type"] == "header"
    process.stdout.close()
    assert process.wait(30) == 0
    assert process.stderr.read() == ""


@pytest.mark.parametrize("arguments", [["config", "show"], ["stimulus", "--list"], ["run", "none.mp4", "--json"]])
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_reader_that_left_before_is_no_fault(spawn, arguments, unbuffered):
    reading, writing = os.pipe()
    os.close(reading)
    process = spawn(*arguments, stdout=writing, environment={"PYTHONUNBUFFERED": unbuffered})
    os.close(writing)
    _, err = process.communicate(timeout=30)
    assert process.returncode == (2 if "none.mp4" in arguments else 0)
    assert err == ("lobula: none.mp4: no such file or folder\n" if "none.mp4" in arguments else "")
