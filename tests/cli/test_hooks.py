"""``lobula run --hook``: what arrives, what the run tells of its hooks, and that its answer stays its own."""

from __future__ import annotations

import json
import os
import shlex
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from ..frames.clips import moving_bar
from ..frames.web_camera import WebCamera
from ..hooks.listeners import LineServer, free_port
from ..hooks.office import wait_until


def lines(path):
    return [json.loads(line) for line in Path(path).read_text().splitlines()]


def plain(records):
    return [{k: v for k, v in r.items() if k not in ("unix_s", "hooks")} for r in records if r["type"] != "reading"]


def test_a_file_and_a_socket_get_what_json_prints_and_readings(call, clip):
    server = LineServer()
    tcp = f"tcp:127.0.0.1:{server.at[1]}"
    done = call("run", clip, "--json", "--hook", "ndjson:out.ndjson", "--hook", tcp)
    wait_until(lambda: server.ends)
    server.close()
    assert (done.code, done.err) == (0, "")
    for records in (lines("out.ndjson"), server.records[0]):
        assert plain(records) == plain(done.records)
        frames = [r["frame"] for r in records if r["type"] == "reading"]
        assert frames == list(range(0, 91, 6))  # five a second of thirty
        assert all(r["unix_s"] > 1_600_000_000 for r in records)
    sent = len(lines("out.ndjson")) - 1  # the header is part of the connection
    fine = {"sent": sent, "dropped": 0, "failures": 0}
    assert done.records[-1]["hooks"] == [{"hook": "ndjson:out.ndjson"} | fine, {"hook": tcp} | fine]


@pytest.mark.parametrize(("rate", "readings"), [("0", 0), ("10", 31), ("1000", 91)])
def test_the_rate_of_readings(call, clip, rate, readings):
    assert call("run", clip, "--json", "--hook", "ndjson:out", "--hook-rate", rate).code == 0
    assert len([r for r in lines("out") if r["type"] == "reading"]) == readings


def test_a_program_and_people(call, clip):
    command = (
        f"""{shlex.quote(sys.executable)} -c 'import sys; print("got", sys.stdin.read(), file=open("got", "a"))'"""
    )
    done = call("run", clip, "--hook", f"exec:{command}")
    assert done.code == 0
    got = [json.loads(line.removeprefix("got ")) for line in Path("got").read_text().splitlines() if line]
    assert [(r["type"], r["phase"]) for r in got] == [
        ("state", "start"), ("state", "end"), ("collision", "start"), ("collision", "end"),
    ]  # fmt: skip


def test_a_dead_hook_is_told_and_changes_nothing_else(call, clip):
    alone = call("run", clip, "--json").records
    tcp = f"tcp:127.0.0.1:{free_port()}"
    done = call("run", clip, "--json", "--hook", tcp)
    assert (done.code, done.err) == (0, "")
    events = [r for r in done.records if r["type"] in ("state", "collision")]
    assert events == alone[1:-1]
    (trouble,) = [r for r in done.records if r["type"] == "hook"]
    assert {k: trouble[k] for k in ("hook", "phase", "problem")} == {
        "hook": tcp, "phase": "start", "problem": "Connection refused",
    }  # fmt: skip
    assert {"frame", "time_s"} < set(trouble)
    summary = done.records[-1]
    assert (summary["status"], summary["collisions"]) == ("ok", 1)
    assert "problems" not in summary
    (tally,) = summary["hooks"]
    assert (tally["sent"], tally["dropped"]) == (0, len(events) + 16 + 1)
    told = call("run", clip, "--hook", tcp).err
    assert f"hook {tcp}: Connection refused\n" in told
    assert told.endswith(f"hook {tcp}: 0 sent, {tally['dropped']} lost: Connection refused\n")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_under_a_hook_is_no_failure_of_the_run(call, clip, tmp_path):
    (tmp_path / "full").symlink_to("/dev/full")
    done = call("run", clip, "--json", "--hook", "ndjson:full", "--trace", "t.csv")
    assert done.code == 0
    assert done.records[-1]["hooks"][0]["problem"] == "No space left on device"


def test_the_reader_leaves_and_the_hook_still_gets_everything(spawn, clip, tmp_path):
    reading, writing = os.pipe()
    os.close(reading)
    process = spawn("run", clip, "--json", "--hook", "ndjson:out", stdout=writing)
    os.close(writing)
    _, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (0, "")
    assert lines(tmp_path / "out")[-1]["frames"] == 91


def test_trouble_is_told_while_the_camera_is_silent(spawn):
    server = LineServer()
    pictures = moving_bar(40, 128, 96)
    with WebCamera(lambda number: pictures[number % 40]) as camera:
        process = spawn("run", camera.address, "--json", "--hook", f"tcp:127.0.0.1:{server.at[1]}")
        wait_until(lambda: server.records and len(server.records[0]) > 2)
        camera.mode = "silent"
        server.close()

        def next_of_hook():
            return next(r for r in map(json.loads, process.stdout) if r["type"] == "hook")

        trouble = next_of_hook()  # the state "stale" finds nobody
        server = LineServer(server.at)
        over = next_of_hook()
        assert camera.mode == "silent"
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
    server.close()
    assert (trouble["phase"], over["phase"], over["frame"]) == ("start", "end", trouble["frame"])
    assert over["time_s"] > trouble["time_s"]
    assert process.returncode == 130
    assert json.loads(out.splitlines()[-1])["hooks"][0]["dropped"] == 0


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_ends_it_with_what_was_queued_delivered(spawn, movie, tmp_path, number, code):
    server = LineServer()
    dead = f"tcp:127.0.0.1:{free_port()}"
    process = spawn("run", "-", "--json", "--pixel-format", "gray8", "--input-size", "99x72", "--hook", dead,
                    "--hook", f"tcp:127.0.0.1:{server.at[1]}", stdin=subprocess.PIPE, text=False)  # fmt: skip
    process.stdin.write(movie.images[:40].tobytes())
    process.stdin.flush()
    wait_until(lambda: server.records and len(server.records[0]) > 3)
    process.send_signal(number)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, err.decode()) == (code, f"lobula: interrupted ({signal.Signals(number).name})\n")
    assert json.loads(out.splitlines()[-1])["hooks"][0]["problem"] == "Connection refused"
    wait_until(lambda: server.ends)
    assert server.records[0][-1]["status"] == "interrupted"
    server.close()


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--hook", "pigeon:nest"], "hook 'pigeon': must be one of ndjson:FILE, unix:PATH, tcp:HOST:PORT, "),
        (["--hook", "tcp:9000"], "hook tcp:9000: must be tcp:HOST:PORT, port 1 to 65535"),
        (["--hook", "exec:no-such-program"], "hook exec:no-such-program: no program: must be executable"),
        (["--hook", "http://me:secret@host:x/"], "hook http://...: must be http[s]://[user:password@]host[:port]/path"),
        (["--hook", "ndjson:no/out"], "cannot write no/out: no such folder no"),
        (["--hook", "ndjson:."], "hook 1 .: is a folder, must be a file"),
        (["--hook", "tcp:h:1", "--hook", "tcp:h:1"], "--hook tcp:h:1: given twice: must be another target"),
        (["--hook", "ndjson:a", "--hook", "ndjson:./a"], "hook 2 a: is written by hook 1 too: must be another file"),
        (["--hook", "ndjson:a.csv", "--trace", "a.csv"], "is written by --trace too: must be another file"),
        (["--hook-rate", "3"], "--hook-rate 3: must have a --hook to go with"),
        (["--hook", "tcp:h:1", "--hook-rate", "-1"], "--hook-rate -1: must be 0 or more readings a second"),
        (["--hook", "tcp:h:1", "--hook-rate", "nan"], "--hook-rate nan: must be 0 or more readings a second"),
        (["--hook", "exec:true", "--hook-rate", "3"], "must have a hook that carries readings, exec:true"),
    ],
)  # fmt: skip
def test_hooks_that_cannot_be_are_refused_before_the_first_frame(call, clip, arguments, says):
    done = call("run", clip, "--json", *arguments)
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert says in done.err
    assert "secret" not in done.err
    assert [r["status"] for r in done.records] == ["refused"]
    assert "hooks" not in done.records[0]


def test_a_hook_never_overwrites_the_source(call, clip):
    done = call("run", clip, "--hook", f"ndjson:{clip}")
    assert (done.code, "which is the source itself: must be another file" in done.err) == (2, True)


def test_a_library_that_is_missing(call, clip, monkeypatch):
    monkeypatch.delitem(sys.modules, "lobula.hooks.mqtt", raising=False)
    monkeypatch.setitem(sys.modules, "paho.mqtt.client", None)
    done = call("run", clip, "--hook", "mqtt://host/topic")
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert 'pip install "lobula[mqtt]"' in done.err


def test_a_source_that_is_refused_reaches_no_hook(call):
    server = LineServer()
    done = call("run", "none.mp4", "--json", "--hook", f"tcp:127.0.0.1:{server.at[1]}")
    server.close()
    assert (done.code, server.heard) == (2, [])
