"""The stream of a live run: everything new in one piece, the newest only, and nobody waited for."""

from __future__ import annotations

import io
import socket
import time
from contextlib import ExitStack

import av
import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed

import lobula
from lobula.dashboard import server, viewer
from lobula.dashboard.about import board_of_trace
from lobula.dashboard.server import Site
from lobula.frames.jpeg import Jpeg
from lobula.types import NEURONS, TRACE_DTYPE

from .stage import Watcher, ask, live, toml

CUTS = pytest.mark.skipif(not hasattr(socket, "TCP_USER_TIMEOUT"), reason="this system cannot cut unread connections")


@pytest.fixture(scope="module")
def movie():
    """Something comes, 2.5 s; contact in the last picture."""
    return lobula.stimuli.looming(scene="arena", speed_cm_s=12.0).images[15:]


@pytest.fixture(scope="module")
def stage(movie):
    with live(movie, rate_hz=60.0) as stage:
        yield stage


def expected(movie, rate_hz, count):
    network = lobula.Network()
    return [network.step(movie[i % len(movie)], i / rate_hz) for i in range(count)]


class TestWhatIsSent:
    def test_first_of_all_what_stays_the_same(self, stage):
        with Watcher(stage.site) as watcher:
            hello = watcher.take().head["hello"]
        assert (hello["mode"], hello["name"]) == ("live", "movie camera")
        assert [n["name"] for n in hello["neurons"]] == list(NEURONS)
        assert [s["name"] for s in hello["states"]] == ["ok", "warming_up", "stale", "flash", "turning"]
        assert {s["path"] for s in hello["settings"]} >= {"decision.collision_spikes", "lptc.sigmoid_grey2"}
        assert "motion" in hello["maps"]["LPTC"]

    def test_every_row_once_and_in_order(self, stage):
        numbers = []
        with Watcher(stage.site) as watcher:
            while len(numbers) < 120:
                message = watcher.take()
                numbers += message.rows["frame"].tolist()
        kept = np.diff(numbers)
        assert (kept >= 1).all()  # a camera's dropped frames leave gaps, rows do not come twice

    def test_rows_are_the_readings(self, movie):
        rows = []
        with live(movie, quick=True) as stage, Watcher(stage.site) as watcher:
            while len(rows) < 90:
                rows += list(watcher.take().rows)
        assert [row["frame"] for row in rows[:90]] == list(range(90))
        for row, reading in zip(rows[:90], expected(movie, 30.0, 90), strict=True):
            assert row["potentials"] == pytest.approx(reading[1:5], abs=1e-6)
            assert row["spikes"].tolist() == list(reading.spikes)

    def test_the_picture_is_the_one_of_the_moment(self, stage, movie):
        with Watcher(stage.site) as watcher:
            message = watcher.until(lambda m: m.jpeg)
        with av.open(io.BytesIO(message.jpeg)) as picture:
            shown = next(picture.decode(video=0)).to_ndarray(format="gray").astype(float)
        number = round(message.head["scene"]["time_s"] * 60)
        columns = np.round(np.linspace(0, shown.shape[1] - 1, 99)).astype(int)  # a JPEG has an even width
        assert np.abs(shown[:, columns] - movie[number % len(movie)]).mean() < 6
        assert message.head["scene"]["box"] == [0, 0, 1, 1]
        assert [c["name"] for c in message.head["scene"]["why"]][:2] == ["warmed up", "not turning"]

    def test_maps_on_demand_only(self, stage):
        with Watcher(stage.site) as watcher:
            assert watcher.until(lambda m: m.jpeg).map is None
            watcher.send({"map": "lgmd1_summation"})
            message = watcher.until(lambda m: m.map is not None and m.map.any())
            assert message.map.shape == (72, 99)
            assert message.head["scene"]["map"]["name"] == "lgmd1_summation"
            assert stage.board.wanted_maps == {"lgmd1_summation"}
            watcher.send({"map": None})
            watcher.until(lambda m: m.jpeg and m.map is None)
            assert stage.board.wanted_maps == frozenset()

    def test_each_viewer_has_its_own_map(self, stage):
        with Watcher(stage.site) as one, Watcher(stage.site) as other:
            one.send({"map": "motion"})
            other.send({"map": "lamina"})
            assert one.until(lambda m: m.map is not None).head["scene"]["map"]["name"] == "motion"
            assert other.until(lambda m: m.map is not None).head["scene"]["map"]["name"] == "lamina"
        deadline_s = time.monotonic() + 10
        while stage.board.wanted_maps and time.monotonic() < deadline_s:
            time.sleep(0.02)
        assert stage.board.wanted_maps == frozenset()  # who leaves wants nothing any more

    def test_a_picture_is_encoded_once_for_all_viewers(self, movie, monkeypatch):
        made, encode = [], Jpeg.__call__

        def counted(self, picture):
            made.append(encode(self, picture))
            return made[-1]

        monkeypatch.setattr(Jpeg, "__call__", counted)
        got = [{} for _ in range(4)]
        with live(movie, rate_hz=60.0) as stage, ExitStack() as stack:
            watchers = [stack.enter_context(Watcher(stage.site)) for _ in got]
            for watcher in watchers:
                watcher.send({"map": "motion"})
            while len(shared := set.intersection(*map(set, got))) < 3:  # each may skip others under load
                for watcher, scenes in zip(watchers, got, strict=True):
                    message = watcher.until(lambda m: m.jpeg and m.map is not None)
                    scenes[message.head["scene"]["number"]] = message.jpeg, message.map.tobytes()
        assert len(made) == stage.board.scene.number  # scenes are numbered from 1
        for number in shared:
            assert {scenes[number] for scenes in got} == {got[0][number]}
            assert got[0][number][0] == made[number - 1]

    def test_how_fast_it_is_and_what_was_dropped(self, stage):
        with Watcher(stage.site) as watcher:
            status = watcher.until(lambda m: m.head["status"].get("latency")).head["status"]
        assert 0 <= status["work"]["median"] <= status["work"]["worst"]
        assert 0 <= status["latency"]["median"] <= status["latency"]["worst"]
        assert status["dropped"] >= 0
        assert status["viewers"] >= 1

    def test_a_quiet_source_is_told_from_a_dead_line(self, monkeypatch):
        monkeypatch.setattr(viewer, "BEAT_S", 0.05)
        trace = np.zeros(3, TRACE_DTYPE)
        trace["state"] = "ok"
        with Site(board_of_trace(trace, {}, "run.npz"), toml) as site, Watcher(site) as watcher:
            watcher.until(lambda m: len(m.rows) == 3)
            later = [watcher.take().head for _ in range(4)]
        assert all(head.keys() == {"status"} for head in later)


class TestAlarm:
    def test_it_is_an_event_a_row_and_a_reason(self, movie):
        with live(movie, quick=True) as stage, Watcher(stage.site) as watcher:
            rows = watcher.until(lambda m: m.rows["collision"].any()).rows
            assert rows["spikes"][rows["collision"] == 1].any()
            records = watcher.until(lambda m: any(e["type"] == "collision" for e in m.head.get("events", ()))).head
        assert any(e["type"] == "collision" and e["phase"] == "start" for e in records["events"])

    def test_a_threshold_that_nothing_reaches_silences_it_at_once(self, movie):
        with live(movie, rate_hz=60.0, quick=True) as stage, Watcher(stage.site) as watcher:
            watcher.until(lambda m: m.rows["collision"].any())
            assert ask(stage.site, "/settings", "POST", {"lgmd2.spiking.threshold": 0.99}).status == 200
            told = watcher.until(lambda m: "settings" in m.head and m.head["settings"]["version"] == 1)
            assert told.head["settings"]["thresholds"]["lgmd2"] == 0.99
            decided = len(stage.board.rows)  # what is decided later is decided with it
            later = []
            while len(later) < 150:  # the movie twice, after the alarm of before has run out
                later += [row for row in watcher.take().rows if row["frame"] > decided + 60]
            assert not any(row["collision"] for row in later)
        ((_, after),) = stage.changes
        assert after.lgmd2.spiking.threshold == 0.99

    def test_what_the_network_remembers_outlives_a_change(self):
        """A change that changes nothing of the numbers leaves the run as it is."""
        images = lobula.stimuli.looming(scene="arena", speed_cm_s=12.0)
        from lobula.dashboard.live_settings import LiveSettings
        from lobula.dashboard.tunable_network import TunableNetwork

        settings = LiveSettings(lobula.preset(), "default")
        network = TunableNetwork(settings, wanted=frozenset, on_change=lambda before, after: None)
        plain = lobula.Network()
        for frame in images.frames():
            if frame.index % 10 == 5:  # a limit that is never met in this movie
                settings.change({"decision.turning_deg_s": 50.0 + frame.index})
            assert network.step(frame)[:8] == plain.step(frame)[:8]


class TestSilence:
    def test_a_camera_that_falls_silent_is_told_though_no_row_comes(self, movie):
        with live(movie) as stage, Watcher(stage.site) as watcher:
            watcher.until(lambda m: m.head["status"].get("state") == "ok")
            stage.camera.silent.set()
            watcher.until(lambda m: m.head["status"].get("state") == "stale")
            stage.camera.silent.clear()
            watcher.until(lambda m: m.head["status"].get("state") == "ok")


class TestViewersWhoDoNoGood:
    @pytest.mark.parametrize(
        "wish",
        ["", "{", "[]", "{}", '{"map": 1}', '{"map": "../etc"}', '{"show": -1}', '{"show": 1.5}', '{"show": true}',
         '{"show": 99999999999}', '{"quit": 1}', "[" * 3000, b"\x00"],
    )  # fmt: skip
    def test_a_wish_that_is_none_ends_the_stream(self, stage, wish):
        with Watcher(stage.site) as watcher:
            watcher.socket.send(wish)
            assert watcher.end() == 1008

    def test_a_huge_wish_ends_the_stream(self, stage):
        with Watcher(stage.site) as watcher:
            watcher.socket.send(" " * 100_000)
            assert watcher.end() == 1009

    def test_too_many(self, stage, monkeypatch):
        monkeypatch.setattr(viewer, "MOST_VIEWERS", 1)
        with Watcher(stage.site) as first, Watcher(stage.site) as second:
            first.take()
            with pytest.raises(ConnectionClosed, match="1 viewers are the most"):
                second.take()
            first.take()

    @pytest.mark.parametrize(("send_s", "unread_s"), [(0.7, 60.0), pytest.param(60.0, 1.0, marks=CUTS)])
    def test_one_that_never_reads_holds_up_nobody_and_is_let_go(self, movie, monkeypatch, send_s, unread_s):
        """Its socket's buffers fill; after that nothing more is kept for it than one message."""
        monkeypatch.setattr(viewer, "SEND_S", send_s)
        monkeypatch.setattr(server, "UNREAD_S", unread_s)
        with live(movie, rate_hz=60.0) as stage:
            stage.site._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4096)  # filled the sooner
            with Watcher(stage.site) as good, silent(stage.site.port):
                good.until(lambda m: m.head["status"]["viewers"] == 2)
                rows, deadline_s, behind = 0, time.monotonic() + 60, 0
                while len(viewers := set(stage.board.viewers)) == 2:
                    rows += len(good.take().rows)
                    behind = max(behind, len(stage.board.rows) - min(v.row_number for v in viewers))
                    assert time.monotonic() < deadline_s
                assert rows >= behind  # the good one was served all the while
                if send_s < unread_s:  # the other got nothing; what it lacks is not queued, its place is remembered
                    assert behind > 5
                frames = len(stage.board.rows)
                good.until(lambda m: len(stage.board.rows) > frames + 30)

    def test_one_that_never_reads_does_not_keep_the_program_from_ending(self, movie):
        with live(movie) as stage, silent(stage.site.port):
            while stage.board.status.get("viewers") != 1:
                time.sleep(0.02)
            begun_s = time.monotonic()
        assert time.monotonic() - begun_s < 15


class silent:  # noqa: N801 - reads as a function where it is used
    """A viewer that shakes hands and never reads another byte."""

    def __init__(self, port: int):
        self.socket = socket.socket()
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        self.socket.connect(("127.0.0.1", port))
        self.socket.sendall(
            b"GET /stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
        )

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.socket.close()
