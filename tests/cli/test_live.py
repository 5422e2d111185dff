"""``lobula run`` on cameras that stop, freeze, return and change, over loopback, and killed at random moments."""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time

import av
import numpy as np
import pytest

from lobula.frames import reconnect
from lobula.report.trace_file import read_trace

from ..frames.clips import moving_bar
from ..frames.web_camera import WebCamera

BARS = moving_bar(40, 128, 96)


@pytest.fixture(autouse=True)
def short_waits(monkeypatch):
    """Before a camera is tried again; in this process."""
    monkeypatch.setattr(reconnect, "FIRST_WAIT_S", 0.05)


class Act:
    """Pictures of a moving bar, and something that happens to the camera at picture ``at``."""

    def __init__(self, at, what):
        self.at, self.what, self.camera = at, what, None

    def __call__(self, number):
        if number == self.at:
            self.what(self.camera)
        return BARS[number % 40]


def acted(at, what):
    act = Act(at, what)
    act.camera = WebCamera(act)
    return act.camera


def kinds(records):
    return [(r["type"], r.get("state"), r["phase"]) for r in records if r.get("phase") != "retry"]


def test_cut_off_and_back_as_records(call):
    with acted(15, lambda camera: camera.unplug(2)) as camera:
        done = call("run", camera.address, "--json", "--max-frames", "40", "--trace", "t.csv")
    header, *events, summary = done.records
    assert (done.code, header["source"]) == (0, camera.address)
    around = kinds(events)
    assert around.index(("source", None, "lost")) < around.index(("state", "stale", "start"))
    assert around.index(("state", "stale", "start")) < around.index(("source", None, "back"))
    assert around.index(("source", None, "back")) < around.index(("state", "stale", "end"))
    back = next(r for r in events if r["phase"] == "back")
    assert back["attempt"] == 3  # refused twice
    assert [r["attempt"] for r in events if r["phase"] == "retry"] == [1, 2]
    assert (summary["status"], summary["frames"], summary["lost"], summary["collisions"]) == ("ok", 40, 1, 0)
    assert summary["away_s"] >= 0.3  # three waits, each twice the one before
    assert 0 < summary["latency_ms"] <= summary["latency_ms_worst"]
    trace = read_trace("t.csv")
    assert (np.diff(trace["frame"]) > 0).all()
    assert (np.diff(trace["time_s"]) > 0).all()


def test_cut_off_and_back_in_words(call):
    with acted(15, lambda camera: camera.unplug(1)) as camera:
        done = call("run", camera.address, "--max-frames", "30")
    assert done.code == 0
    assert f"source lost: {camera.address}: " in done.err
    assert "  try 1 failed: " in done.err
    assert "  source back after " in done.err
    last = done.err.splitlines()[-1]
    assert "ms from capture to decision (worst " in last
    assert "; lost 1 time, away " in last


def test_never_reconnecting(call):
    with acted(10, lambda camera: camera.unplug()) as camera:
        done = call("run", camera.address, "--json", "--reconnect", "never")
    assert done.code == 3
    assert (done.records[-1]["status"], done.records[-1]["lost"]) == ("source_failed", 0)
    assert len(done.err.splitlines()) == 1
    assert camera.visits == 1


def test_patience_that_ends(call):
    with acted(10, lambda camera: camera.unplug()) as camera:
        done = call("run", camera.address, "--json", "--reconnect", "0.2")
    assert (done.code, done.records[-1]["status"], done.records[-1]["lost"]) == (3, "source_failed", 1)
    assert "; given up after " in done.err


def test_a_frozen_camera_is_stale_and_no_collision(call):
    def freeze(camera):
        camera.mode = "freeze"
        threading.Timer(1.7, camera.unplug).start()

    with acted(10, freeze) as camera:
        done = call("run", camera.address, "--json", "--reconnect", "never")
    assert ("state", "stale", "start") in kinds(done.records[1:-1])
    assert (done.code, done.records[-1]["collisions"], done.records[-1]["lost"]) == (3, 0, 0)


def test_a_silent_camera_is_stale_then_lost(call):
    def hush(camera):
        camera.mode = "silent"

    with acted(10, hush) as camera:
        done = call("run", camera.address, "--json", "--timeout", "1.6", "--reconnect", "0.1")
    around = kinds(done.records[1:-1])
    assert around.index(("state", "stale", "start")) < around.index(("source", None, "lost"))
    assert done.code == 3


def test_pictures_of_another_size_after_the_return_go_into_every_output(call, tmp_path):
    def swap(camera):
        camera.image = lambda number: wide[number % 40]
        camera.unplug(1)

    wide = moving_bar(40, 192, 144)
    with acted(10, swap) as camera:
        done = call("run", camera.address, "--max-frames", "40", "--trace", "t.csv", "--annotate", "a.mp4",
                    "--record", "r.mp4", "--keep", "clips", "--report", "report")  # fmt: skip
    assert done.code == 0, done.err
    assert "pictures are 192 x 144 px now: the network begins anew" in done.err
    for name in ("a.mp4", "r.mp4"):
        with av.open(str(tmp_path / name)) as video:
            assert sum(1 for _ in video.decode(video=0)) == 40
    assert len(read_trace("report/trace.csv")) == 40


def test_another_size_without_the_region_ends_it_in_one_line(call):
    def swap(camera):
        camera.image = lambda number: moving_bar(1, 96, 64)[0]
        camera.unplug(1)

    with acted(10, swap) as camera:
        done = call("run", camera.address, "--json", "--roi", "10,10,110,80")
    assert (done.code, done.records[-1]["status"]) == (3, "source_failed")
    assert len(done.err.splitlines()) == 1
    assert "roi = (10, 10, 110, 80): must be (x, y, width, height) inside the 96 x 64 px" in done.err


def test_a_full_disk_stops_neither_a_live_run_nor_its_other_outputs(call, tmp_path):
    (tmp_path / "full.csv").symlink_to("/dev/full")
    with WebCamera(lambda n: BARS[n % 40], rate_hz=50) as camera:
        done = call("run", camera.address, "--json", "--trace", "full.csv", "--record", "r.mp4", "--max-frames", "45")
    assert (done.code, done.records[-1]["status"], done.records[-1]["frames"]) == (3, "output_failed", 45)
    assert done.err == "lobula: cannot write full.csv: the disk is full\n"
    assert len(times_of(tmp_path / "r.mp4")) == 45


def test_a_signal_while_it_reconnects(spawn, tmp_path):
    with acted(15, lambda camera: camera.unplug()) as camera:
        process = spawn("run", camera.address, "--json", "--trace", "t.npz", "--record", "r.mp4")
        for line in process.stdout:
            if json.loads(line).get("phase") == "retry":
                break
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=30)
    assert (process.returncode, err) == (130, "lobula: interrupted (SIGINT)\n")
    summary = json.loads(out.splitlines()[-1])
    assert (summary["status"], summary["lost"]) == ("interrupted", 1)
    assert summary["away_s"] > 0
    assert len(read_trace(tmp_path / "t.npz")) == summary["frames"]
    with av.open(str(tmp_path / "r.mp4")) as video:
        assert sum(1 for _ in video.decode(video=0)) == summary["frames"]


@pytest.mark.parametrize(("scheme", "number", "code"), [("http", signal.SIGTERM, 143), ("rtsp", signal.SIGINT, 130)])
def test_a_signal_while_nobody_answers(spawn, scheme, number, code):
    with socket.create_server(("127.0.0.1", 0)) as listener:
        process = spawn("run", f"{scheme}://127.0.0.1:{listener.getsockname()[1]}/x", "--json")
        link, _ = listener.accept()
        with link:
            link.recv(1)  # it has asked, and now waits for ten seconds
            process.send_signal(number)
            out, err = process.communicate(timeout=30)
    assert (process.returncode, err) == (code, f"lobula: interrupted ({number.name})\n")
    assert json.loads(out)["status"] == "interrupted"


def times_of(path):
    with av.open(str(path)) as video:
        return [frame.time for frame in video.decode(video=0)]


def left_behind(folder, to):
    """Copy what a run has written so far; rows first, so that pictures are not the older ones."""
    for path in sorted(folder.rglob("*.*"), key=lambda path: path.suffix != ".csv"):
        (to / path.relative_to(folder)).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, to / path.relative_to(folder))
    return to


def lost_s(rows, video):
    """How much sooner than the rows of its trace a video ends."""
    return rows["time_s"][-1] - rows["time_s"][0] - times_of(video)[-1]


def test_killed_at_any_moment_everything_reads_but_for_the_last_second(spawn, tmp_path, movie):
    """What lies there at a random moment is what SIGKILL would leave; the last moment is that of a real one."""
    images = np.ascontiguousarray(movie.images[45:, :, :98])  # an even width; the alarm comes after about a second
    chance, run, moments = random.Random(0), tmp_path / "run", []
    awaited = [("collision", "start"), ("state", "end")]
    run.mkdir()
    with WebCamera(lambda n: images[n % len(images)], rate_hz=30) as camera:
        process = spawn("run", camera.address, "--json", "--trace", "run/t.csv", "--annotate", "run/a.mp4",
                        "--record", "run/r.mp4", "--keep", "run/clips", "--keep-before", "1",
                        "--report", "run/report")  # fmt: skip
        for line in process.stdout:
            record = json.loads(line)
            if (record["type"], record.get("phase")) == awaited[-1]:
                awaited.pop()
                for _ in range(2):
                    time.sleep(chance.uniform(0.3, 0.6))
                    moments.append(left_behind(run, tmp_path / f"moment {len(moments)}"))
            if not awaited:
                break
        time.sleep(chance.uniform(0.0, 0.5))
        process.kill()
        process.communicate(timeout=30)
    for folder in (*moments[1:], run):  # in the first there may not be half a second yet
        rows = read_trace(folder / "t.csv")
        assert len(rows) > 1
        assert len(read_trace(folder / "report" / "trace.csv")) >= len(rows) - 1
        # half a second, and the picture whose coming ends it
        most_s = 0.5 + 2 * np.diff(rows["time_s"]).max()
        for name in ("a.part.mp4", "r.part.mp4"):
            assert lost_s(rows, folder / name) <= most_s, (folder.name, name)
        for clip in folder.glob("clips/*.part.mp4"):
            kept = read_trace(clip.with_name(clip.name.replace(".part.mp4", ".csv")))
            assert kept["collision"].any()
            assert lost_s(kept, clip) <= most_s, folder.name
    assert any(list(folder.glob("clips/*.part.mp4")) for folder in (*moments, run))


def test_clips_of_a_recording_and_the_pictures_as_they_were(call, clip, tmp_path):
    done = call("run", clip, "--keep", "clips", "--keep-before", "1", "--keep-after", "0.2", "--record", "r.mp4")
    assert done.code == 0, done.err
    assert len(times_of(tmp_path / "r.mp4")) == 91
    (kept,) = (tmp_path / "clips").glob("*.mp4")
    part = read_trace(kept.with_suffix(".csv"))
    assert part["collision"].any()
    assert len(times_of(kept)) == len(part)
    again = call("run", "r.mp4", "--json")
    assert again.records[-1]["collisions"] == 1  # what was recorded says the same


def test_a_live_pipe(spawn, movie):
    raw = ("run", "-", "--live", "--pixel-format", "gray8", "--input-size", "99x72")
    process = spawn(*raw, "--json", stdin=subprocess.PIPE, text=False)
    process.stdin.write(movie.images[0].tobytes())
    process.stdin.flush()
    for image in movie.images[1:40]:
        process.stdin.write(image.tobytes())
        process.stdin.flush()
        time.sleep(0.01)
    time.sleep(1.5)  # nothing comes, and it is not taken for a still scene
    out, err = process.communicate(timeout=30)
    *records, summary = map(json.loads, out.splitlines())
    assert ("state", "stale", "start") in kinds(records[1:])
    assert (process.returncode, summary["status"], err) == (3, "source_failed", b"lobula: -: the stream ended\n")
    assert summary["latency_ms"] > 0
    assert summary["frames"] + summary["dropped"] == 40


def test_a_pipe_cannot_be_opened_again(call, movie, monkeypatch):
    reading, writing = os.pipe()
    with open(reading) as pipe, open(writing, "wb", buffering=0) as feed:
        monkeypatch.setattr(sys, "stdin", pipe)
        feed.write(movie.images[0].tobytes())
        feed.close()
        done = call("run", "-", "--live", "--pixel-format", "gray8", "--input-size", "99x72", "--reconnect", "5")
    assert (done.code, done.err) == (2, "lobula: --reconnect 5: - is a pipe: must be a camera or a stream\n")


def test_word_to_a_service_manager(spawn, tmp_path):
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager, WebCamera(lambda n: BARS[n % 40]) as camera:
        manager.bind(str(tmp_path / "notify"))
        manager.settimeout(30)
        process = spawn("run", camera.address, "--json", environment={"NOTIFY_SOCKET": str(tmp_path / "notify")})
        told = []
        while not any(text.startswith("READY") for text in told):
            told.append(manager.recv(4096).decode())
        while not told[-1].startswith("WATCHDOG=1\nSTATUS="):
            told.append(manager.recv(4096).decode())
        process.terminate()
        while not told[-1].startswith("STOPPING"):
            told.append(manager.recv(4096).decode())
        process.communicate(timeout=30)
        assert process.returncode == 143


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--reconnect", "sometimes"], "--reconnect sometimes: must be forever, never or seconds above 0"),
        (["--reconnect", "0"], "--reconnect 0: must be forever, never or seconds above 0"),
        (["--reconnect", "nan"], "--reconnect nan: must be forever, never or seconds above 0"),
        (["--reconnect", "30"], "--reconnect 30: clip.mp4 is not live: must be a camera or a stream"),
        (["--live"], "live: clip.mp4 is a file: may be given only for a pipe"),
        (["--timeout", "0"], "--timeout 0: must be seconds above 0"),
        (["--timeout", "5"], "--timeout 5.0: clip.mp4 is not live: must be a camera or a stream"),
        (["--keep-before", "5"], "--keep-before 5: must have a --keep DIR to go with"),
        (["--keep-after", "5"], "--keep-after 5: must have a --keep DIR to go with"),
        (["--keep", "clips", "--keep-before", "-1"], "(--keep-before): -1: must be 0 to 600"),
        (["--keep", "clip.mp4"], "--keep clip.mp4: clip.mp4 is a file, must be a folder"),
        (["--record", "r.avi"], "video r.avi: must end in .mp4"),
        (["--record", "none/r.mp4"], "cannot write none/r.mp4: no such folder none"),
        (["--record", "clip.mp4"], "--record clip.mp4: would overwrite clip.mp4, which is the source"),
        (["--record", "a.mp4", "--annotate", "a.mp4"], "is written by --annotate too: must be another file"),
    ],
)
def test_wrong_requests_in_one_line(call, clip, tmp_path, arguments, says):
    (tmp_path / "clip.mp4").write_bytes(clip.read_bytes())
    done = call("run", "clip.mp4", *arguments)
    assert done.code == 2
    assert len(done.err.splitlines()) == 1
    assert says in done.err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["clip.mp4"]
