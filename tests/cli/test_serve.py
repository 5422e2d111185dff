"""``lobula serve`` as a user starts it: a process with a page, until it is stopped."""

from __future__ import annotations

import io
import json
import signal
import socket
import subprocess
import sys
import threading
import urllib.error
import urllib.request
from contextlib import nullcontext
from typing import Any

import av
import numpy as np
import pytest

import lobula
from lobula.cli.settings import choose
from lobula.report.trace_file import read_trace

pytest.importorskip("uvicorn", reason="the extra dashboard is not installed")

from ..dashboard.stage import Watcher
from ..frames.clips import moving_bar
from ..frames.web_camera import WebCamera
from ..hooks.listeners import free_port


class Served:
    """A running ``lobula serve``: what it said first, and the way to its page."""

    def __init__(self, process: Any):
        self.process = process
        self.first = json.loads(process.stdout.readline())
        self.url = self.first["url"]
        self.port = int(self.url.rstrip("/").rpartition(":")[2])

    def get(self, path: str, body: Any = None) -> bytes:
        data = None if body is None else json.dumps(body).encode()
        asked = urllib.request.Request(self.url + path, data, {"Content-Type": "application/json"})
        with urllib.request.urlopen(asked, timeout=20) as answer:
            return answer.read()

    def stop(self, number: int = signal.SIGINT) -> tuple[int, list[Any], str]:
        self.process.send_signal(number)
        out, err = self.process.communicate(timeout=30)
        return self.process.returncode, [json.loads(line) for line in out.splitlines()], err


@pytest.fixture
def serve(spawn):
    return lambda *arguments, **how: Served(spawn("serve", *arguments, "--json", "--port", 0, **how))


def size_of(jpeg: bytes) -> tuple[int, int]:
    with av.open(io.BytesIO(jpeg)) as picture:
        return picture.streams.video[0].width, picture.streams.video[0].height


def rows_of(watcher: Watcher, count: int, version: int) -> np.ndarray:
    """The whole of a recording, as of a version of its analysis or a later one."""
    rows: dict[int, Any] = {}
    while True:
        message = watcher.take()
        about = message.head.get("rows", {"version": -1})
        if about["version"] >= version:
            rows |= {about["first"] + i: row for i, row in enumerate(message.rows)}
        if len(rows) == count and message.head["status"].get("complete"):
            return np.array([rows[i] for i in range(count)])


class TestARecording:
    def test_it_is_the_run_and_changes_with_the_settings(self, serve, call, clip, tmp_path):
        served = serve(clip)
        assert {**served.first, "url": ""} == {"type": "serving", "mode": "recording", "source": str(clip), "url": ""}
        assert call("run", clip, "--trace", "plain.npz").code == 0
        trace = read_trace(tmp_path / "plain.npz")
        with Watcher(served) as watcher:
            rows = rows_of(watcher, 91, 1)
            assert rows["frame"].tolist() == trace["frame"].tolist()
            np.testing.assert_array_equal(rows["time_s"], trace["time_s"])
            np.testing.assert_allclose(rows["potentials"][:, 0], trace["lgmd1"], rtol=1e-6)
            assert rows["collision"].tolist() == trace["collision"].tolist()
            watcher.send({"map": "lgmd2_summation", "show": 80})
            scene = watcher.until(lambda m: m.map is not None)
            assert (scene.head["scene"]["number"], scene.jpeg[:2]) == (80, b"\xff\xd8")

            now = json.loads(served.get("settings", {"decision.collision_spikes": 40, "lgmd1.spiking.threshold": 0.6}))
            changed = rows_of(watcher, 91, 2)
            assert not changed["collision"].any()
            assert (changed["spikes"][:, 0] > rows["spikes"][:, 0]).any()
            (tmp_path / "mine.toml").write_bytes(served.get("settings.toml"))
        assert call("run", clip, "--config", "mine.toml", "--trace", "changed.npz").code == 0
        again = read_trace(tmp_path / "changed.npz")
        assert changed["spikes"][:, 0].tolist() == again["spikes_lgmd1"].tolist()
        assert changed["collision"].tolist() == again["collision"].tolist()

        code, records, err = served.stop()
        assert code == 130
        assert "interrupted (SIGINT)" in err
        assert records == [
            {
                "type": "settings",
                "changed": {"decision.collision_spikes": 40, "lgmd1.spiking.threshold": 0.6},
                "settings_hash": now["settings_hash"],
            }
        ]
        assert choose(config=tmp_path / "mine.toml").params.decision.collision_spikes == 40

    def test_a_stretch_of_it(self, serve, clip):
        served = serve(clip, "--start", 1.0, "--end", 2.0, "--stride", 2, "--size", "64x48")
        with Watcher(served) as watcher:
            hello = watcher.take().head["hello"]
            assert (hello["facts"]["width"], hello["facts"]["height"]) == (64, 48)
        with Watcher(served) as watcher:
            rows = rows_of(watcher, 15, 1)
        assert rows["frame"].tolist() == list(range(30, 60, 2))
        assert served.stop(signal.SIGTERM)[0] == 143

    def test_a_file_of_images_is_no_trace(self, serve, movie, tmp_path):
        np.savez(tmp_path / "movie.npz", images=movie.images[:20], times_s=movie.times_s[:20])
        served = serve("movie.npz")
        assert served.first["mode"] == "recording"
        with Watcher(served) as watcher:
            assert len(rows_of(watcher, 20, 1)) == 20


class TestASavedTrace:
    def test_it_is_shown_as_it_was_saved(self, serve, call, clip, tmp_path):
        assert call("run", clip, "--trace", "run.npz", "--set", "lptc.spiking.threshold=0.3").code == 0
        trace = read_trace(tmp_path / "run.npz")
        served = serve("run.npz")
        assert served.first["mode"] == "trace"
        with Watcher(served) as watcher:
            message = watcher.take()
            hello = message.head["hello"]
            assert hello["name"] == "run.npz"
            assert hello["facts"]["source"] == str(clip)
            assert hello["thresholds"]["lptc_l"] == -0.3
            assert hello["settings"] == []
            np.testing.assert_allclose(message.rows["potentials"][:, 1], trace["lgmd2"], rtol=1e-6)
            watcher.send({"show": 3})  # a page may ask; there is nothing to show
            assert not any("scene" in message.head for message in watcher.all(0.3))
        with pytest.raises(urllib.error.HTTPError, match="404"):
            served.get("settings.toml")
        assert served.stop()[0] == 130


class TestAPipe:
    def test_it_is_watched_live_with_the_records_of_run(self, spawn, movie):
        raw = ("-", "--pixel-format", "gray8", "--input-size", "99x72", "--rate", 30)
        process = spawn("serve", *raw, "--json", "--port", 0, stdin=subprocess.PIPE, text=False)
        writer = threading.Thread(target=process.stdin.write, args=[movie.images.tobytes()])
        writer.start()
        served = Served(process)
        assert served.first["mode"] == "live"
        with Watcher(served) as watcher:
            watcher.until(lambda m: m.rows["collision"].any())
        writer.join(20)
        out, _ = process.communicate(timeout=30)
        assert process.returncode == 0
        records = [json.loads(line) for line in out.splitlines()]
        kinds = [record["type"] for record in records]
        assert (kinds[0], kinds[-1]) == ("header", "summary")
        assert "collision" in kinds
        assert records[-1]["frames"] == len(movie)

    def test_hooks_get_what_they_get_of_run_and_the_page_hears_of_their_trouble(self, spawn, movie, tmp_path):
        raw = ("-", "--pixel-format", "gray8", "--input-size", "99x72", "--rate", 30)
        dead = f"tcp:127.0.0.1:{free_port()}"
        hooks = ("--hook", "ndjson:out.ndjson", "--hook", dead, "--hook-rate", 10)
        process = spawn("serve", *raw, *hooks, "--json", "--port", 0, stdin=subprocess.PIPE, text=False)
        pictures = movie.images.tobytes()
        process.stdin.write(pictures[: len(pictures) // 2])
        process.stdin.flush()
        served = Served(process)
        with Watcher(served) as watcher:
            writer = threading.Thread(target=process.stdin.write, args=[pictures[len(pictures) // 2 :]])
            writer.start()
            told = watcher.until(lambda m: any(e["type"] == "hook" for e in m.head.get("events", ())))
        writer.join(20)
        process.stdin.close()
        process.stdin = None  # or its end would close it again
        records = [json.loads(line) for line in process.stdout]
        process.wait(30)
        (trouble,) = [e for e in told.head["events"] if e["type"] == "hook"]
        assert (trouble["hook"], trouble["phase"], trouble["problem"]) == (dead, "start", "Connection refused")
        assert (process.returncode, trouble in records) == (0, True)
        assert [(h["hook"], h["sent"] > 0) for h in records[-1]["hooks"]] == [
            ("ndjson:out.ndjson", True), (dead, False),
        ]  # fmt: skip
        got = [json.loads(line) for line in (tmp_path / "out.ndjson").read_text().splitlines()]
        assert [r["frame"] for r in got if r["type"] == "reading"] == list(range(0, len(movie), 3))
        kinds = [(r["type"], r.get("phase")) for r in records if r["type"] != "hook"]
        assert [(r["type"], r.get("phase")) for r in got if r["type"] != "reading"] == kinds


class TestACameraThatGoesAway:
    def test_the_page_tells_and_goes_on_though_the_pictures_have_another_size(self, serve):
        def image(number):
            return now["bars"][number % 40]

        now = {"bars": moving_bar(40, 128, 96)}
        with WebCamera(image) as camera:
            served = serve(camera.address)
            with Watcher(served) as watcher:
                before = watcher.until(lambda m: m.jpeg)
                assert size_of(before.jpeg) == (128, 96)
                camera.unplug(1)
                watcher.until(lambda m: m.head["status"].get("state") == "stale")
                now["bars"] = moving_bar(40, 192, 144)
                after = watcher.until(lambda m: m.jpeg and size_of(m.jpeg) == (192, 144))
                assert after.head["scene"]["time_s"] > before.head["scene"]["time_s"]
                events = watcher.until(lambda m: "back" in [e["phase"] for e in m.head.get("events", ())])
            told = [e["phase"] for e in events.head["events"] if e["type"] == "source"]
            assert told[:3] == ["lost", "retry", "back"]
            code, records, _ = served.stop()
        assert (code, records[-1]["status"], records[-1]["lost"]) == (130, "interrupted", 1)


@pytest.mark.parametrize("live", [True, False])
def test_a_page_goes_on_when_its_reader_has_gone(serve, clip, live):
    bars = moving_bar(40, 128, 96)
    with WebCamera(lambda n: bars[n % 40]) if live else nullcontext() as camera:
        served = serve(camera.address if live else clip)
        served.process.stdout.close()
        for spikes in (40, 41, 42):
            served.get("settings", {"decision.collision_spikes": spikes})
            with Watcher(served) as watcher:
                watcher.take()
        assert b"collision_spikes = 42" in served.get("settings.toml")
        served.process.send_signal(signal.SIGINT)
        assert served.process.wait(30) == 130


class TestBadInput:
    @pytest.mark.parametrize(
        ("arguments", "says"),
        [
            (["nowhere.mp4"], "nowhere.mp4: no such file or folder"),
            (["nowhere.csv"], "trace nowhere.csv: cannot be read: no such file"),
            (["empty.csv"], "trace empty.csv: has no rows: nothing to show"),
            (["nan.csv"], "trace nan.csv: column lgmd2, row 2: nan: must be finite"),
            (["broken.npz"], "trace broken.npz: is not a .npz file"),
            (["clip", "--host", "192.0.2.1"], "--host 192.0.2.1, --port 8040: must be an address of this machine"),
            (["clip", "--host", "no such name"], "--host no such name: must be an address or a name of this machine"),
            (["clip", "--port", "taken"], "taken: must be free, or 0 for any that is"),
            (["clip", "--port", "65536"], "should be less than or equal to 65535"),
            (["clip", "--token", "short"], "token of 5 characters: must be at least 12"),
            (["clip", "--preset", "papr"], "preset 'papr': must be one of"),
            (["clip", "--set", "decision.collision_spikes=0"], "must be int in [1, 100]"),
            (["clip", "--size", "99"], "--size '99': must be WIDTHxHEIGHT"),
            (["clip", "--start", "9"], "no frame from 9 s"),
            (["clip", "--yaw", "none.csv"], "yaw file none.csv: no such file"),
            (["clip", "--engine", "gpu"], "engine 'gpu': must be one of"),
            (["clip", "--reconnect", "never"], "--reconnect never: "),
            (["clip", "--timeout", "3"], "is not live: must be a camera or a stream"),
            (["clip", "--hook", "tcp:h:1"], "--hook tcp:h:1: "),
            (["clip", "--hook", "ndjson:out"], "is replayed: must be a camera, an address or a pipe; lobula run has"),
            (["empty.csv", "--hook", "tcp:h:1"], "--hook tcp:h:1: empty.csv is replayed: must be a camera, an address"),
            (["clip", "--hook-rate", "3"], "--hook-rate 3: must have a --hook to go with"),
            (["-", "--hook", "ndjson:no/out"], "cannot write no/out: no such folder no"),
        ],
    )
    def test_one_line_says_what_is_wrong(self, call, clip, tmp_path, arguments, says):
        columns = ",".join(lobula.types.TRACE_DTYPE.names) + "\n"
        (tmp_path / "empty.csv").write_text(columns)
        rows = [f"{i},{i / 30},0.5,{lgmd2},0,0,0,0,0,0,0,ok\n" for i, lgmd2 in enumerate(["0.5", "nan"])]
        (tmp_path / "nan.csv").write_text(columns + "".join(rows))
        (tmp_path / "broken.npz").write_bytes(b"no archive")
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = taken.getsockname()[1]
            done = call("serve", *({"clip": clip, "taken": port}.get(a, a) for a in arguments))
        assert done.code == 2
        assert says in done.err
        assert done.out == ""
        assert [line for line in done.err.splitlines() if not line.startswith("lobula: ")] == []
        assert "is shown at" not in done.err

    def test_without_the_extra(self, call, clip, monkeypatch):
        for name in [name for name in sys.modules if name.startswith("lobula.dashboard")]:
            monkeypatch.delitem(sys.modules, name)
        monkeypatch.setitem(sys.modules, "uvicorn", None)
        done = call("serve", clip)
        assert done.code == 2
        assert 'the page needs starlette, uvicorn and websockets: pip install "lobula[dashboard]"' in done.err


class TestTheToken:
    def test_away_from_loopback_it_is_made_and_shown_once_to_people(self, serve, clip):
        served = serve(clip, "--host", "0.0.0.0")
        assert "token" not in json.dumps(served.first)
        with pytest.raises(urllib.error.HTTPError, match="401"):
            served.get("app.js")
        code, records, err = served.stop()
        assert (code, records) == (130, [])
        assert err.count("?token=") == 1

    def test_behind_a_proxy_it_is_made_too(self, serve, clip):
        served = serve(clip, "--allow-host", "cam.example")
        proxied = {"Host": "cam.example", "Origin": "https://cam.example"}
        with pytest.raises(urllib.error.HTTPError, match="401"):
            urllib.request.urlopen(urllib.request.Request(served.url + "settings.toml", headers=proxied), timeout=20)
        assert served.stop()[2].count("?token=") == 1

    def test_it_is_taken_from_the_environment_and_another_name_may_be_allowed(self, serve, clip):
        served = serve(clip, "--allow-host", "robot.example", environment={"LOBULA_TOKEN": "correct horse battery"})
        with pytest.raises(urllib.error.HTTPError, match="401"):
            served.get("app.js")
        assert b"<h1" in served.get("?token=correct%20horse%20battery")
        bearer = {"Authorization": "Bearer correct horse battery"}
        for host, status in (("robot.example", 200), ("evil.example", 421)):
            asked = urllib.request.Request(served.url, headers={"Host": host, **bearer})
            try:
                with urllib.request.urlopen(asked, timeout=20) as answer:
                    found = answer.status
            except urllib.error.HTTPError as error:
                found = error.code
            assert found == status
        assert served.stop()[0] == 130
