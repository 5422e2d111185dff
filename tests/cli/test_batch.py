"""``lobula batch`` as a user calls it, and as the system, the terminal or a full disk stops it."""

from __future__ import annotations

import csv
import json
import os
import pty
import resource
import shutil
import signal
import struct
import time
from pathlib import Path

import numpy as np
import pytest

from lobula.cli.batch_text import MOST_CLIPS
from lobula.report.grey_clip import write_grey_clip
from lobula.report.trace_file import read_trace

FRAMES, CLIPS = 600, 6
PATIENCE_S = 300
"""On a busy machine all takes longer; what hangs, hangs longer."""

VOLATILE = ("seconds", "date")
"""Columns that differ from run to run."""


def copy_as_another(source, target):
    """Copy an MP4 and add a box that nobody reads, which holds the new name: the same pictures, another content."""
    note = target.name.encode()
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(source.read_bytes() + struct.pack(">I4s", 8 + len(note), b"free") + note)


@pytest.fixture
def folder(clip, tmp_path):
    """Two clips, one of them a folder down, and a file that is none."""
    copy_as_another(clip, tmp_path / "clips" / "a.mp4")
    copy_as_another(clip, tmp_path / "clips" / "deep" / "b.mp4")
    return tmp_path / "clips"


@pytest.fixture(scope="session")
def long_clip(tmp_path_factory):
    """Twenty seconds, so that there is a middle in which to be stopped."""
    path = tmp_path_factory.mktemp("long") / "long.mp4"
    noise = np.random.default_rng(0).integers(0, 255, (10, 72, 99), np.uint8)
    write_grey_clip(path, (noise[i % 10] for i in range(FRAMES)), [i / 30 for i in range(FRAMES)], 30)
    return path


@pytest.fixture
def many(long_clip, tmp_path):
    """``CLIPS`` clips that take a while."""
    for i in range(CLIPS):
        copy_as_another(long_clip, tmp_path / "many" / f"{i}.mp4")
    return tmp_path / "many"


def table(out):
    with (out / "clips.csv").open(newline="") as file:
        return [{k: v for k, v in row.items() if k not in VOLATILE} for row in csv.DictReader(file)]


def manifest(out):
    return [json.loads(line) for line in (out / "manifest.ndjson").read_text().splitlines()]


def done_once(out, count=CLIPS):
    contents = [row["content"] for row in manifest(out) if row["status"] == "ok"]
    assert len(contents) == len(set(contents)) == count
    for row in table(out):
        assert len(read_trace(out / row["trace"])) == int(row["frames"])
        assert json.loads((out / row["events"]).read_text().splitlines()[-1])["status"] == "ok"


class TestWhatTheUserSees:
    def test_a_table_and_files(self, call, folder, tmp_path):
        done = call("batch", "clips", "--out", "out", "--workers", 2)
        assert (done.code, done.err) == (0, "")
        lines = done.out.splitlines()
        assert lines[0].split() == ["clip", "status", "frames", "duration_s", "collisions", "alarms_s"]
        assert lines[1].split()[:3] == ["clips/a.mp4", "ok", "91"]
        assert lines[2].split()[:3] == ["clips/deep/b.mp4", "ok", "91"]
        assert lines[4].startswith("2 clips: 2 ok; 2 collisions in 0.1 minutes of video")
        done_once(tmp_path / "out", 2)

    def test_the_numbers_are_those_of_run(self, call, folder, tmp_path):
        options = ("--preset", "published", "--set", "decision.collision_spikes=6", "--size", "64x48", "--stride", 2)
        assert call("batch", "clips", "--out", "out", *options).code == 0
        for row in table(tmp_path / "out"):
            done = call("run", row["file"], "--json", "--trace", "t.csv", *options)
            assert (tmp_path / "t.csv").read_bytes() == (tmp_path / "out" / row["trace"]).read_bytes()
            events = [json.loads(line) for line in (tmp_path / "out" / row["events"]).read_text().splitlines()]
            assert events[:-1] == done.records[:-1]
            starts = [r["time_s"] for r in done.records if r["type"] == "collision" and r["phase"] == "start"]
            assert [float(text) for text in row["alarms_s"].split()] == starts

    def test_again(self, call, folder, tmp_path):
        call("batch", "clips", "--out", "out")
        before = table(tmp_path / "out")
        shutil.move(folder / "a.mp4", folder / "deep" / "renamed.mp4")
        done = call("batch", "clips", "--out", "out")
        assert "2 clips: 2 ok, 2 of them not done again" in done.out
        assert len(manifest(tmp_path / "out")) == 2
        rows = {row.pop("file"): row for row in table(tmp_path / "out")}
        assert rows["clips/deep/renamed.mp4"] == {k: v for k, v in before[0].items() if k != "file"}

    def test_failures_by_name_in_one_line_each(self, call, folder):
        (folder / "empty.mp4").touch()
        (folder / "text.mp4").write_text("nothing")
        done = call("batch", "clips", "--out", "out")
        assert done.code == 4
        assert sorted(done.err.splitlines()) == [
            "lobula: clips/empty.mp4: is empty: must be a file that FFmpeg decodes",
            "lobula: clips/text.mp4: not a video: must be a file that FFmpeg decodes, not cut off before its index",
        ]
        assert "4 clips: 2 ok, 2 failed" in done.out

    def test_json(self, call, folder):
        (folder / "empty.mp4").touch()
        done = call("batch", "clips", "--out", "out", "--json", "--trace", "none")
        assert done.code == 4
        assert (done.document["ok"], done.document["failed"], done.document["status"]) == (2, 1, "some_failed")
        assert [row["frames"] for row in done.document["rows"]] == [91, 91, 0]
        assert {row["trace"] for row in done.document["rows"]} == {""}

    def test_many_clips_are_told_by_folder(self, call, tmp_path):
        for i in range(MOST_CLIPS + 1):
            (tmp_path / "clips" / ("odd" if i % 2 else "even")).mkdir(parents=True, exist_ok=True)
            (tmp_path / "clips" / ("odd" if i % 2 else "even") / f"{i}.mp4").touch()
        done = call("batch", "clips", "--out", "out", "--workers", 1)
        lines = [line.split() for line in done.out.splitlines()]
        assert lines[0] == ["folder", "clips", "failed", "frames", "minutes", "collisions", "alarmed"]
        assert [line[:3] for line in lines[1:4]] == [
            ["clips/even", "16", "16"],
            ["clips/odd", "15", "15"],
            ["all", "31", "31"],
        ]

    def test_a_bar_on_a_terminal(self, spawn, folder):
        ours, theirs = pty.openpty()
        process = spawn("batch", "clips", "--out", "out", stderr=theirs)
        os.close(theirs)
        shown = b""
        while True:
            try:
                shown += os.read(ours, 4096)
            except OSError:
                break
        os.close(ours)
        assert process.wait(PATIENCE_S) == 0
        assert b"clips" in shown
        assert b"2/2" in shown


BAD = {
    "no --out": (["clips"], "batch: Missing option '--out'"),
    "no source": (["--out", "out"], "batch: Missing argument"),
    "a folder that is not there": (["gone", "--out", "out"], "gone: no such file or folder"),
    "a folder without clips": (["none", "--out", "out"], "none: no clip in it: must hold"),
    "a pattern that matches nothing": (["*.avi", "--out", "out"], "*.avi: nothing matches"),
    "a camera": (["0", "--out", "out"], "0: no such file or folder"),
    "the output is the input": (["clips", "--out", "clips"], "--out clips: is the folder of the clips itself"),
    "the output is a file": (["clips", "--out", "file"], "--out file: file is a file, must be a folder"),
    "trace": (["clips", "--out", "out", "--trace", "xls"], "--trace xls: must be one of csv, npz, parquet, none"),
    "workers": (["clips", "--out", "out", "--workers", "0"], "workers = 0: must be 1 to 256"),
    "setting": (["clips", "--out", "out", "--set", "lamina.dog.sigma=2"], "unknown setting lamina.dog.sigma: did you"),
    "size": (["clips", "--out", "out", "--size", "99"], "--size '99': must be WIDTHxHEIGHT"),
    "fit": (["clips", "--out", "out", "--fit", "odd"], "fit = 'odd': must be one of"),
    "mask": (["clips", "--out", "out", "--mask", "gone.png"], "mask gone.png: no such file"),
    "stretch": (["clips", "--out", "out", "--start", "2", "--end", "1"], "end_s = 1: must be after start_s = 2"),
    "engine": (["clips", "--out", "out", "--engine", "gpu"], "engine 'gpu': must be one of"),
    "cluster": (
        ["clips", "--out", "out", "--cluster", "nonsense"],
        "--cluster nonsense: must be dask, or an address such as tcp://10.0.0.1:8786",
    ),
    "workers of a local cluster": (
        ["clips", "--out", "out", "--cluster", "dask", "--workers", "0"],
        "workers = 0: must be 1 to 256",
    ),
    "workers of a cluster": (
        ["clips", "--out", "out", "--cluster", "tcp://127.0.0.1:1", "--workers", "2"],
        "--workers 2 with --cluster tcp://127.0.0.1:1: the cluster has as many as it has",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_line_and_leaves_nothing(call, folder, tmp_path, case):
    arguments, message = BAD[case]
    (tmp_path / "none").mkdir()
    (tmp_path / "file").touch()
    done = call("batch", *arguments)
    assert (done.code, done.out) == (2, "")
    assert done.err.startswith(f"lobula: {message}")
    assert done.err.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_nobody_at_the_address_of_the_cluster(call, folder, monkeypatch):
    pytest.importorskip("distributed", reason="needs the extra dask, too large for the tests")
    monkeypatch.setattr("lobula.batch.cluster._ANSWERS_IN_S", 0.5)
    done = call("batch", "clips", "--out", "out", "--cluster", "tcp://127.0.0.1:1")
    assert (done.code, done.out) == (2, "")
    assert done.err.startswith("lobula: --cluster tcp://127.0.0.1:1: no Dask scheduler answers: ")
    assert done.err.count("\n") == 1


def test_a_folder_that_cannot_be_written_into(call, folder):
    done = call("batch", "clips", "--out", "/proc/out")
    assert done.code in (2, 3)
    assert done.err.startswith("lobula: cannot write /proc/out")


def wait_for_rows(out, count):
    """Return when so many clips are finished."""
    deadline_s = time.monotonic() + PATIENCE_S
    while not (out / "manifest.ndjson").exists() or len(manifest(out)) < count:
        assert time.monotonic() < deadline_s
        time.sleep(0.005)


def children(pid):
    return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def workers(pid):
    return [child for child in children(pid) if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()]


def gone(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"
    except FileNotFoundError:
        return True


@pytest.fixture(scope="module")
def whole(tmp_path_factory, long_clip):
    """The table of a run that nobody stopped."""
    from lobula.cli import main

    here = tmp_path_factory.mktemp("whole")
    for i in range(CLIPS):
        copy_as_another(long_clip, here / "many" / f"{i}.mp4")
    before = Path.cwd()
    os.chdir(here)
    try:
        assert main(["batch", "many", "--out", "out"]) == 0
    finally:
        os.chdir(before)
    return table(here / "out")


class TestStopped:
    @pytest.fixture(autouse=True)
    def _linux(self):
        if not Path("/proc/self/task").exists():
            pytest.skip("looks for the workers in /proc")

    def resume(self, call, out, whole):
        assert call("batch", "many", "--out", "out").code == 0
        assert table(out) == whole
        done_once(out)
        assert list((out / ".batch" / "work").iterdir()) == []

    @pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
    def test_by_a_signal_to_all_of_them(self, spawn, call, many, tmp_path, whole, number, code):
        process = spawn("batch", "many", "--out", "out", "--workers", 2, start_new_session=True)
        wait_for_rows(tmp_path / "out", 1)
        os.killpg(process.pid, number)  # as a terminal does
        out, err = process.communicate(timeout=PATIENCE_S)
        assert process.returncode == code
        assert err == f"lobula: interrupted ({number.name}): the same command goes on from here\n"
        assert "not finished" in out
        statuses = [row["status"] for row in table(tmp_path / "out")]
        assert statuses.count("ok") == len(manifest(tmp_path / "out")) >= 1
        assert statuses.count("unfinished") == CLIPS - statuses.count("ok")
        self.resume(call, tmp_path / "out", whole)

    def test_by_sigkill(self, spawn, call, many, tmp_path, whole):
        process = spawn("batch", "many", "--out", "out", "--workers", 2)
        wait_for_rows(tmp_path / "out", 1)
        orphans = workers(process.pid)
        process.kill()
        process.wait()
        deadline_s = time.monotonic() + PATIENCE_S
        while not all(map(gone, orphans)):
            assert time.monotonic() < deadline_s
            time.sleep(0.01)
        assert len(orphans) == 2
        self.resume(call, tmp_path / "out", whole)

    def test_by_sigkill_of_its_workers(self, spawn, many, tmp_path, whole):
        process = spawn("batch", "many", "--out", "out", "--workers", 2)
        wait_for_rows(tmp_path / "out", 1)
        for pid in workers(process.pid):
            os.kill(pid, signal.SIGKILL)
        _, err = process.communicate(timeout=PATIENCE_S)
        assert (process.returncode, err) == (0, "")
        assert table(tmp_path / "out") == whole
        done_once(tmp_path / "out")

    def test_two_runs_at_once_share_the_work(self, spawn, many, tmp_path, whole):
        both = [spawn("batch", "many", "--out", "out", "--workers", 1) for _ in range(2)]
        printed = [process.communicate(timeout=PATIENCE_S) for process in both]
        assert [process.returncode for process in both] == [0, 0]
        assert [err for _, err in printed] == ["", ""]
        assert table(tmp_path / "out") == whole
        done_once(tmp_path / "out")

    def test_with_a_cluster_on_this_machine(self, spawn, many, tmp_path, whole):
        pytest.importorskip("distributed", reason="needs the extra dask, too large for the tests")
        command = ("batch", "many", "--out", "out", "--cluster", "dask", "--workers", 2)
        process = spawn(*command, start_new_session=True)
        wait_for_rows(tmp_path / "out", 1)
        os.killpg(process.pid, signal.SIGINT)
        _, err = process.communicate(timeout=PATIENCE_S)
        assert process.returncode == 130
        assert err == "lobula: interrupted (SIGINT): the same command goes on from here\n"
        process = spawn(*command)
        out, err = process.communicate(timeout=PATIENCE_S)
        assert (process.returncode, err) == (0, "")
        assert f"{CLIPS} clips: {CLIPS} ok, " in out
        assert table(tmp_path / "out") == whole
        done_once(tmp_path / "out")

    def test_by_a_full_disk(self, spawn, call, many, tmp_path, whole):
        def small_disk():
            resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

        process = spawn("batch", "many", "--out", "out", "--workers", 1, preexec_fn=small_disk)
        out, err = process.communicate(timeout=PATIENCE_S)
        assert process.returncode == 3
        assert err.startswith("lobula: cannot write ")
        assert err.count("\n") == 1
        assert f"{CLIPS} clips: 0 ok, {CLIPS} not finished" in out
        self.resume(call, tmp_path / "out", whole)
