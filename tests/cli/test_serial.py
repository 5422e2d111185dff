"""``lobula run`` and ``serve`` on a robot's line, a pseudo-terminal: what is told, recorded, shown and refused."""

from __future__ import annotations

import json
import signal
import threading
import time
import urllib.request

import numpy as np
import pytest
from websockets.sync.client import connect

from lobula.report.trace_file import read_about, read_trace

from ..dashboard.stage import taken_apart
from ..telemetry import oracle
from ..telemetry.robots import Robot, frame_of, reading


@pytest.fixture
def robot(tmp_path_factory):
    robot = Robot(tmp_path_factory.mktemp("line"))
    yield robot
    robot.close()


def greeted(robot, *steps):
    """Hello, then the steps, once somebody listens."""
    robot.then(lambda: robot.say(oracle.hello()), *steps)


def test_events_trace_and_summary_are_the_robot_s(call, robot, tmp_path):
    greeted(robot, lambda: robot.tell(1000, 1199))
    done = call("run", robot.port, "--json", "--trace", "t.npz", "--max-frames", 200, "--hook", "ndjson:events.ndjson")
    assert (done.code, done.err) == (0, "")
    header, *events, summary = done.records
    assert header == {
        "type": "header", "version": "0.1.0", "preset": "default", "neurons": "all", "settings_hash": "0123456789ab",
        "engine": "robot", "source": robot.port, "width": 99, "height": 72, "fps": 30.0,
    }  # fmt: skip
    potentials = {"lgmd1": 0.75, "lgmd2": 0.875, "lptc_r": 0.0, "lptc_l": -0.125}
    assert events == [
        {"type": "motor", "action": "forward", "frame": 0, "time_s": 0.0},
        {"type": "motor", "action": "stop", "frame": 60, "time_s": 0.6},
        {"type": "collision", "phase": "start", "id": 1, "frame": 60, "time_s": 0.6, **potentials},
        {"type": "motor", "action": "forward", "frame": 80, "time_s": 0.8},
        {"type": "collision", "phase": "end", "id": 1, "frame": 80, "time_s": 0.8, "peak_frame": 60},
    ]
    assert summary.pop("hooks")[0]["dropped"] == 0
    assert summary == {
        "type": "summary", "status": "ok", "frames": 200, "dropped": 0, "damaged": 0, "collisions": 1,
        "duration_s": 2.0, "ms_per_frame": 2.5, "ms_worst": 2.5, "lost": 0, "away_s": 0.0,
    }  # fmt: skip
    trace = read_trace("t.npz")
    assert trace["frame"].tolist() == list(range(200))
    assert trace["lgmd2"].tolist() == [0.875 if 60 <= k < 80 else 0.5 for k in range(200)]
    assert trace["spikes_lgmd2"].tolist() == [3 if 60 <= k < 80 else 0 for k in range(200)]
    about = read_about("t.npz")
    assert (about["settings_hash"], about["engine"]) == ("0123456789ab", "robot")
    assert about["thresholds"]["lptc_l"] == pytest.approx(-0.2)
    told = [json.loads(line) for line in (tmp_path / "events.ndjson").read_text().splitlines()]
    assert [record["type"] for record in told if record["type"] == "collision"] == ["collision"] * 2


def test_in_words_and_as_a_report(call, robot, tmp_path):
    frames = [bytearray(frame_of(reading(number))) for number in range(200)]
    frames[20][10] ^= 4
    greeted(robot, lambda: robot.say(*map(bytes, frames)))
    done = call("run", robot.port, "--max-frames", 199, "--report", "report")
    assert done.code == 0, done.err
    first, *lines = done.err.splitlines()
    assert first == (
        f"{robot.port}: 99 x 72 px, preset default, neurons all, settings 0123456789ab, engine robot"
    )  # fmt: skip
    assert [line.split(maxsplit=4)[4] for line in lines[:3]] == [
        "wheels: forward", "wheels: stop", "COLLISION 1: LGMD-1 0.75, LGMD-2 0.88",
    ]  # fmt: skip
    assert lines[-1] == "ok: 199 frames, 1 collision, 1 dropped, 1 damaged, 2.500 ms a frame (worst 2.5)"
    assert len(read_trace("report/trace.csv")) == 199
    assert "COLLISION" in (tmp_path / "report" / "index.html").read_text().upper()


def test_silence_is_stale_and_a_restart_is_told(call, robot):
    greeted(robot, lambda: robot.tell(60, 65), lambda: time.sleep(2.0), lambda: robot.tell(0, 30))
    done = call("run", robot.port, "--json", "--max-frames", 37)
    kinds = [(r["type"], r.get("state"), r.get("phase")) for r in done.records[1:-1] if r["type"] != "motor"]
    assert kinds == [
        ("collision", None, "start"), ("collision", None, "end"), ("state", "stale", "start"),
        ("source", None, "restarted"), ("state", "stale", "end"),
    ]  # fmt: skip
    assert (done.records[-1]["lost"], done.records[-1]["dropped"]) == (0, 0)


def test_the_robot_s_own_states_are_told(call, robot):
    states = ["warming_up"] * 3 + ["ok"] * 3 + ["turning"] * 3 + ["stale"] * 3 + ["ok"]
    steps = [frame_of(reading(k, state=state)) for k, state in enumerate(states)]
    greeted(robot, lambda: robot.say(*steps))
    done = call("run", robot.port, "--json", "--max-frames", 13)
    told = [(r["state"], r["phase"], r["frame"]) for r in done.records if r["type"] == "state"]
    assert told == [
        ("warming_up", "start", 0), ("warming_up", "end", 3), ("turning", "start", 6), ("turning", "end", 9),
        ("stale", "start", 9), ("stale", "end", 12),
    ]  # fmt: skip


def test_pulled_out_and_put_back(call, robot):
    def swap():
        time.sleep(0.5)
        robot.unplug()
        time.sleep(0.6)
        robot.plug()
        robot.heard()
        robot.tell(200, 219)

    greeted(robot, lambda: robot.tell(0, 9), swap)
    done = call("run", robot.port, "--max-frames", 30)
    assert done.code == 0
    assert f"source lost: {robot.link}: the device went away" in done.err
    assert "source back after " in done.err
    assert done.err.splitlines()[-1].startswith("lost 1 time, away ")


def test_gone_for_good(call, robot):
    greeted(robot, lambda: robot.tell(0, 9), lambda: time.sleep(0.5), robot.unplug)
    done = call("run", robot.port, "--json", "--reconnect", "never", "--trace", "t.csv")
    assert (done.code, done.records[-1]["status"]) == (3, "source_failed")
    assert done.err == f"lobula: {robot.link}: the device went away\n"
    assert len(read_trace("t.csv")) == 10


def test_damage_of_every_kind_and_only_what_was_sent_is_recorded(call, robot):
    """A tenth of the frames hit at random: every row of the trace was sent, and nothing that came whole is missing."""
    noise = np.random.default_rng(7)
    whole, parts = [], []
    for number in range(400):
        frame = bytearray(frame_of(reading(number)))
        kind = noise.integers(40)
        at = int(noise.integers(1, 40))
        if kind == 0:
            frame[at] ^= 1 << int(noise.integers(8))
        elif kind == 1:
            del frame[at : at + int(noise.integers(1, 6))]
        elif kind == 2:
            frame[at:at] = noise.bytes(int(noise.integers(1, 60)))
        elif kind == 3:
            frame.clear()
        else:
            whole.append(number)
        parts.append(bytes(frame))
    greeted(robot, lambda: robot.say(*parts))
    done = call("run", robot.port, "--json", "--max-frames", len(whole), "--trace", "t.csv")
    assert read_trace("t.csv")["frame"].tolist() == whole
    assert done.records[-1]["dropped"] == whole[-1] + 1 - len(whole)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_ends_it_cleanly(spawn, robot, tmp_path, number, code):
    greeted(robot, lambda: robot.drive(0, 99))
    process = spawn("run", robot.port, "--json", "--trace", "t.npz")
    for line in process.stdout:
        if json.loads(line)["type"] == "collision":
            break
    process.send_signal(number)
    out, err = process.communicate(timeout=30)
    assert (process.returncode, err) == (code, f"lobula: interrupted ({number.name})\n")
    summary = json.loads(out.splitlines()[-1])
    assert summary["status"] == "interrupted"
    assert len(read_trace(tmp_path / "t.npz")) == summary["frames"]


def test_a_signal_while_nobody_speaks(spawn, robot):
    process = spawn("run", robot.port, "--json")
    robot.heard()
    process.terminate()
    out, err = process.communicate(timeout=30)
    assert (process.returncode, err) == (143, "lobula: interrupted (SIGTERM)\n")
    assert json.loads(out)["status"] == "interrupted"


class TestThePage:
    def test_rows_events_and_losses_without_a_picture(self, spawn, robot):
        stop = threading.Event()

        def talk():
            number = 0
            while not stop.wait(0.01):
                if number % 32 == 0:
                    robot.say(oracle.hello())
                if number % 50 != 49:  # one of fifty is lost
                    robot.tell(number, number)
                number += 1

        robot.then(talk)
        try:
            process = spawn("serve", robot.port, "--json", "--port", 0)
            first = json.loads(process.stdout.readline())
            assert {**first, "url": ""} == {"type": "serving", "mode": "robot", "source": robot.port, "url": ""}
            with connect(first["url"].replace("http", "ws") + "stream", max_size=None) as socket:
                messages = [taken_apart(socket.recv(20))]
                while not (
                    messages[-1].head["status"].get("dropped") and any(m.rows["collision"].any() for m in messages)
                ):
                    messages.append(taken_apart(socket.recv(20)))
            hello = messages[0].head["hello"]
            assert (hello["mode"], hello["name"], hello["settings"], hello["maps"]) == ("robot", robot.port, [], {})
            assert hello["thresholds"]["lptc_l"] == pytest.approx(-0.2)
            assert hello["facts"]["settings_hash"] == "0123456789ab"
            rows = np.concatenate([m.rows for m in messages])
            alarmed = rows[rows["collision"] == 1]
            assert alarmed["potentials"][0].tolist() == [0.75, 0.875, 0.0, -0.125]
            assert alarmed["spikes"][0].tolist() == [2, 3, 0, 0]
            assert not any("scene" in m.head for m in messages)
            status = messages[-1].head["status"]
            assert status["motor"] in ("forward", "stop")
            assert status["work"]["median"] == 2.5
            with pytest.raises(urllib.error.HTTPError, match="404"):
                urllib.request.urlopen(first["url"] + "settings.toml", timeout=20)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=30)
        finally:
            stop.set()
        assert process.returncode == 130
        assert "is shown at http://127.0.0.1:" in err
        assert json.loads(out.splitlines()[-1])["status"] == "interrupted"


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--annotate", "a.mp4"], "--annotate: "),
        (["--record", "r.mp4"], "--record: "),
        (["--keep", "clips"], "--keep: "),
        (["--preset", "paper"], "--preset: "),
        (["--set", "decision.collision_spikes=5"], "--set: "),
        (["--size", "99x72"], "--size: "),
        (["--engine", "core"], "--engine: "),
        (["--live"], "--live: "),
        (["--rate", "30"], "--rate: "),
    ],
)
def test_what_is_about_pictures_or_settings_is_refused(call, robot, arguments, says):
    done = call("run", robot.port, "--json", *arguments)
    why = f"{says}{robot.port} is a robot, which decides by itself and sends no pictures: may be given only for sources"
    assert (done.code, done.records[-1]["status"]) == (2, "refused")
    assert done.err.startswith(f"lobula: {why}")
    assert len(done.err.splitlines()) == 1


@pytest.mark.parametrize("option", [["--preset", "paper"], ["--yaw", "yaw.csv"], ["--size", "64x48"]])
def test_the_page_refuses_them_too(call, robot, option):
    done = call("serve", robot.port, *option)
    assert done.code == 2
    assert done.err.startswith(f"lobula: {option[0]}: {robot.port} is a robot")


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["run", "serial:"], "serial:: must be serial:PORT or serial:PORT@BAUD"),
        (["run", "serial:nowhere"], "nowhere: no such device"),
        (["run", "serial:nowhere@9601"], "9601 baud: must be one of"),
        (["serve", "serial:nowhere"], "nowhere: no such device"),
        (["run", "serial:clip.mp4"], "clip.mp4: is no serial line"),
        (["run", "serial:nowhere", "--timeout", "0"], "--timeout 0: must be seconds above 0"),
        (["run", "serial:nowhere", "--reconnect", "now"], "--reconnect now: must be forever, never or seconds"),
        (["run", "serial:nowhere", "--max-frames", "0"], "max_frames = 0: must be a whole number of 1 or more"),
        (["run", "serial:nowhere", "--trace", "t.txt"], "trace t.txt: must end in"),
        (["run", "serial:nowhere", "--trace", "none/t.csv"], "cannot write none/t.csv: no such folder"),
        (["explain", "serial:nowhere", "--at", "1"], "a robot sends readings, no pictures: only lobula run and serve"),
    ],
)
def test_wrong_requests_in_one_line(call, tmp_path, arguments, says):
    (tmp_path / "clip.mp4").write_bytes(b"no line")
    done = call(*arguments)
    assert done.code == 2
    assert says in done.err
    assert len(done.err.splitlines()) == 1


def test_nobody_there(call, robot):
    done = call("run", robot.port, "--timeout", "0.2")
    assert (done.code, len(done.err.splitlines())) == (2, 1)
    assert "in 0.2 s nothing came: must be a robot that sends" in done.err


def test_an_output_cannot_take_the_place_of_the_line(call, robot):
    done = call("run", robot.port, "--trace", f"{robot.link}.csv", "--hook", f"ndjson:{robot.link}")
    assert done.code == 2
    assert f"would overwrite {robot.link}" in done.err
