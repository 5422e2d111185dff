"""Live sources that do as they are told, by a clock of their own: silence, freezing, loss and return, latency."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lobula.frames import open as open_frames
from lobula.frames.reconnect import News
from lobula.runtime import tally, watch
from lobula.runtime.loop import run
from lobula.runtime.ndjson import ReaderGoneError
from lobula.runtime.outputs import Outputs

from .readings import Clock, LiveSource, Network, Sink, frames


def outcome_of(source, sinks, network=None):
    return run(source, network or Network(), Outputs(sinks, print), {"type": "header"}), None


def live(monkeypatch, script, network=None):
    clock, sink = Clock(), RecordingSink()
    for module in (watch, tally):
        monkeypatch.setattr(module, "time", clock)
    outcome, _ = outcome_of(LiveSource(script, clock), [sink], network)
    return outcome, sink.records, sink.states


class RecordingSink(Sink):
    def __init__(self):
        super().__init__()
        self.records, self.states = [], []

    def event(self, record):
        self.records.append(record)

    def frame(self, index, reading, picture):
        self.states.append(reading.state)


def test_a_silent_camera_is_stale_until_it_speaks(monkeypatch):
    network = Network()
    script = [*frames(30), *([0.1] * 15), *frames(30, first=75)]
    outcome, records, _ = live(monkeypatch, script, network)
    assert [(r["state"], r["phase"], r["frame"]) for r in records] == [("stale", "start", 29), ("stale", "end", 75)]
    assert records[0]["time_s"] == pytest.approx(29 / 30 + 1.1, abs=0.11)  # told a tenth of a second late at most
    assert network.resets == 1
    assert (outcome.summary["frames"], outcome.summary["dropped"], outcome.exit_code) == (60, 2, 0)


def test_a_sink_that_is_awake_hears_of_silence_with_the_time_of_the_source(monkeypatch):
    class Awake(Sink):
        heard = ()

        def silence(self, index, time_s):
            self.heard = (*self.heard, (index, pytest.approx(time_s)))
            self._called("silence")

    clock = Clock()
    for module in (watch, tally):
        monkeypatch.setattr(module, "time", clock)
    awake, failing, asleep = Awake(), Awake(fails=("silence",)), Sink()
    outcome, _ = outcome_of(LiveSource([*frames(4), 0.25, 0.5, *frames(1, first=40)], clock), [awake, failing, asleep])
    assert awake.heard == ((3, 0.1 + 0.25), (3, 0.1 + 0.75))
    assert failing.calls.count("silence") == 1
    assert (outcome.summary["status"], asleep.calls.count("frame")) == ("output_failed", 5)


def test_a_live_run_that_nobody_listens_to_ends_in_silence_too(monkeypatch):
    clock, gone = Clock(), Sink(fails=("event",), error=ReaderGoneError)
    for module in (watch, tally):
        monkeypatch.setattr(module, "time", clock)
    source = LiveSource([*frames(1), 2.0, *frames(10, first=70)], clock)  # stale, so there is something to tell
    outcome, _ = outcome_of(source, [gone])
    assert (outcome.exit_code, outcome.summary["frames"]) == (0, 1)


def test_a_short_silence_is_nothing(monkeypatch):
    _, records, _ = live(monkeypatch, [*frames(5), *([0.1] * 9), *frames(5, first=35)])
    assert records == []


def test_a_frozen_camera_is_stale(monkeypatch):
    network = Network()
    script = [*frames(10), *frames(60, first=10, value=77), *frames(5, first=70)]
    _, records, states = live(monkeypatch, script, network)
    # 77 first shows in frame 10 at 1/3 s; more than a second later is after frame 40
    assert [(r["phase"], r["frame"]) for r in records] == [("start", 41), ("end", 70)]
    assert states[40:42] == ["ok", "stale"]
    assert states[69:71] == ["stale", "ok"]
    assert network.resets == 1


def test_a_still_recording_is_never_stale():
    sink = RecordingSink()
    images = np.full((90, 72, 99), 100, np.uint8)
    with open_frames(images) as source:
        outcome, _ = outcome_of(source, [sink])
    assert sink.records == []
    assert outcome.summary["frames"] == 90


def test_an_alarm_before_the_silence_is_ended_in_it(monkeypatch):
    _, records, _ = live(monkeypatch, [*frames(10), *([0.1] * 8)], Network({5}))
    assert [(r["type"], r["phase"]) for r in records] == [("collision", "start"), ("collision", "end")]


def news(phase, **facts):
    return News(phase, 0.0, facts)


LOST, BACK = news("lost", reason="cable out"), news("back", attempt=2, away_s=0.5)
RETRY = news("retry", attempt=1, reason="no device")


def kinds(records):
    return [(r["type"], r.get("state"), r["phase"]) for r in records]


def test_a_source_that_went_away_is_stale_at_once_and_the_network_begins_anew(monkeypatch):
    network = Network()
    script = [*frames(30), LOST, 0.3, RETRY, 0.2, BACK, *frames(30, first=45)]
    outcome, records, _ = live(monkeypatch, script, network)
    assert kinds(records) == [
        ("source", None, "lost"), ("state", "stale", "start"), ("source", None, "retry"), ("source", None, "back"),
        ("state", "stale", "end"),
    ]  # fmt: skip
    assert records[0] == {"type": "source", "phase": "lost", "frame": 29, "time_s": 0.966667, "reason": "cable out"}
    assert records[2]["time_s"] == pytest.approx(29 / 30 + 0.3, abs=1e-6)
    assert records[3]["attempt"] == 2
    assert network.resets == 1
    assert outcome.exit_code == 0
    assert (outcome.summary["lost"], outcome.summary["away_s"]) == (1, pytest.approx(0.5))


def test_away_to_the_end(monkeypatch):
    outcome, records, _ = live(monkeypatch, [*frames(3), LOST, 0.7])
    assert (outcome.summary["lost"], outcome.summary["away_s"]) == (1, pytest.approx(0.7))
    assert kinds(records)[-1] == ("state", "stale", "end")
    assert records[-1]["time_s"] == pytest.approx(2 / 30 + 0.7, abs=1e-3)  # not before it started


def test_an_alarm_under_way_ends_with_the_loss(monkeypatch):
    script = [*frames(10), LOST, 2.0, BACK, *frames(10, first=80)]
    _, records, _ = live(monkeypatch, script, Network({7, 8, 9, 85}))
    assert [r["phase"] for r in records if r["type"] == "collision"] == ["start", "end", "start", "end"]
    end = next(r for r in records if (r["type"], r["phase"]) == ("collision", "end"))
    assert (end["frame"], end["time_s"]) == (9, 0.3)
    assert records.index(end) < kinds(records).index(("state", "stale", "start"))


def test_an_alarm_under_way_ends_in_silence(monkeypatch):
    _, records, _ = live(monkeypatch, [*frames(10), *[0.1] * 30], Network({7, 8, 9}))
    assert kinds(records) == [
        ("collision", None, "start"),
        ("collision", None, "end"),
        ("state", "stale", "start"),
        ("state", "stale", "end"),
    ]


def test_a_frozen_picture_is_never_a_collision(monkeypatch):
    script = [*frames(3), *frames(90, first=3, value=77)]
    _, records, states = live(monkeypatch, script, Network(range(93)))
    assert states[-1] == "stale"
    end = next(r for r in records if (r["type"], r["phase"]) == ("collision", "end"))
    assert end["frame"] == states.index("stale")


def test_pictures_of_another_size_meet_a_new_network(monkeypatch):
    network = Network()
    _, records, _ = live(
        monkeypatch, [*frames(5), news("resized", width=320, height=240), *frames(5, first=5)], network
    )
    assert records == [
        {"type": "source", "phase": "resized", "frame": 4, "time_s": 0.133333, "width": 320, "height": 240}
    ]
    assert network.resets == 1


def test_latency_from_capture_to_decision_in_the_summary(monkeypatch):
    # the clock of the source moves on a thirtieth of a second with each frame: frame n is polled at (n + 1) / 30
    late_s = [0.010, 0.020, 0.030, 0.200, 0.020]
    script = [replace(f, captured_s=(f.index + 1) / 30 - s) for f, s in zip(frames(5), late_s, strict=True)]
    outcome, _, _ = live(monkeypatch, script)
    assert outcome.summary["latency_ms"] == 20.0
    assert outcome.summary["latency_ms_worst"] == 200.0


def test_without_stamps_of_capture_there_is_no_latency(monkeypatch):
    outcome, _, _ = live(monkeypatch, frames(5))
    assert "latency_ms" not in outcome.summary
    assert (outcome.summary["lost"], outcome.summary["away_s"]) == (0, 0.0)


def test_a_recording_has_neither_losses_nor_latency():
    with open_frames(np.zeros((5, 72, 99), np.uint8)) as source:
        outcome, _ = outcome_of(source, [])
    assert not {"latency_ms", "lost", "away_s"} & set(outcome.summary)
