"""The loop with a source, a network and outputs that do as they are told."""

from __future__ import annotations

import errno

import numpy as np
import pytest

from lobula.errors import FrameSourceError, OutputError, ParameterError, TimeError
from lobula.frames import open as open_frames
from lobula.runtime import tally, watch
from lobula.runtime.loop import run
from lobula.runtime.ndjson import ReaderGoneError
from lobula.runtime.outputs import Outputs
from lobula.runtime.tally import unbegun_summary

from .readings import Clock, LiveSource, Network, Sink, Source, frames


def outcome_of(source, sinks, network=None, **how):
    said: list[str] = []
    outputs = Outputs(sinks, said.append)
    return run(source, network or Network(), outputs, {"type": "header"}, **how), said


def test_every_frame_of_a_recording_and_one_summary():
    sink = Sink()
    source = Source(frames(120))
    outcome, said = outcome_of(source, [sink], Network({50, 51}))
    assert sink.calls.count("frame") == 120
    assert sink.calls[0] == "open"
    assert sink.calls[-1] == "close"
    assert sink.calls.count("event") == 2
    summary = outcome.summary
    assert (summary["status"], summary["frames"], summary["collisions"]) == ("ok", 120, 1)
    assert summary["duration_s"] == pytest.approx(4.0)  # 120 frames at 30 Hz, the last one included
    assert (outcome.exit_code, outcome.message, said, source.closed) == (0, None, [], 1)


def test_the_summary_has_the_keys_of_the_contract():
    outcome, _ = outcome_of(Source(frames(2)), [])
    keys = {"type", "status", "frames", "dropped", "collisions", "duration_s", "ms_per_frame"}
    assert keys <= set(outcome.summary)
    assert set(outcome.summary) | {"problems"} == set(unbegun_summary("refused", "no"))


def test_a_source_that_fails_on_the_way():
    sink = Sink()
    source = Source([*frames(5), FrameSourceError("cable out", on_the_way=True)])
    outcome, _ = outcome_of(source, [sink], Network({4}))
    assert (outcome.summary["status"], outcome.exit_code, outcome.message) == ("source_failed", 3, "cable out")
    assert outcome.summary["problems"] == ["cable out"]
    assert sink.calls.count("event") == 2  # the alarm under way was ended
    assert sink.calls.count("close") == 1


def test_a_source_without_a_first_frame_was_a_wrong_request():
    outcome, _ = outcome_of(Source([FrameSourceError("no frame from 9 s")]), [])
    assert (outcome.summary["status"], outcome.exit_code) == ("refused", 2)


def test_times_that_run_backwards():
    outcome, _ = outcome_of(Source([*frames(2), TimeError("time runs backwards")]), [])
    assert (outcome.summary["status"], outcome.exit_code) == ("source_failed", 3)


@pytest.mark.parametrize("call", ["frame", "event", "close"])
def test_an_output_that_fails_is_reported_once_and_the_others_go_on(call):
    bad, good = Sink(fails=(call,)), Sink()
    outcome, said = outcome_of(Source(frames(60)), [bad, good], Network({5}))
    assert (outcome.summary["status"], outcome.exit_code) == ("output_failed", 3)
    assert said == [f"cannot {call}"]
    assert good.calls.count("frame") == 60
    assert bad.calls.count("close") == 1
    assert good.summary["status"] == "output_failed"  # closed later, so it knows
    assert good.summary["problems"] == [f"cannot {call}"]


def test_a_failed_output_is_not_called_again():
    bad = Sink(fails=("frame",))
    outcome_of(Source(frames(10)), [bad, Sink()])
    assert bad.calls == ["open", "frame", "close"]


def test_an_output_that_cannot_be_started_refuses_the_run():
    bad, last = Sink(fails=("open",)), Sink()
    source = Source(frames(10))
    outcome, _ = outcome_of(source, [bad, last])
    assert (outcome.summary["status"], outcome.exit_code, outcome.summary["frames"]) == ("refused", 2, 0)
    assert bad.calls == ["open", "close"]
    assert last.summary["status"] == "refused"  # opened first, so the summary is not lost


def disk_full(message):
    error = OutputError(message)
    error.__cause__ = OSError(errno.ENOSPC, "full")
    return error


def test_a_full_disk_at_the_start_does_not_stop_the_others():
    bad, good = Sink(fails=("open",), error=disk_full), Sink()
    outcome, said = outcome_of(Source(frames(10)), [bad, good])
    assert (outcome.summary["status"], outcome.exit_code, said) == ("output_failed", 3, ["cannot open"])
    assert good.calls.count("frame") == 10


def test_a_reader_that_goes_away_is_no_fault_and_ends_the_run_if_it_was_the_last():
    source = Source(frames(10))
    outcome, said = outcome_of(source, [Sink(fails=("frame",), error=ReaderGoneError)])
    assert (outcome.exit_code, said, outcome.summary["frames"]) == (0, [], 1)


def test_a_reader_that_goes_away_does_not_stop_a_file():
    good = Sink()
    outcome, _ = outcome_of(Source(frames(10)), [good, Sink(fails=("frame",), error=ReaderGoneError)])
    assert (outcome.exit_code, good.calls.count("frame")) == (0, 10)


def test_a_fault_of_our_own_is_raised_after_the_outputs_were_closed():
    sink, source = Sink(), Source([*frames(3), ZeroDivisionError("bug")])
    with pytest.raises(ZeroDivisionError):
        outcome_of(source, [sink])
    assert sink.summary["status"] == "crashed"
    assert source.closed == 1


def test_every_frame_moves_the_bar():
    seen = []
    outcome_of(Source(frames(4)), [], on_frame=lambda: seen.append(1))
    assert len(seen) == 4


def test_the_network_is_told_the_yaw_rate_of_each_frames_time():
    network = Network()
    outcome_of(Source(frames(4)), [], network, yaw_rate_deg_s=lambda time_s: 30 * time_s)
    assert network.rates_deg_s == pytest.approx([0, 1, 2, 3])
    outcome_of(Source(frames(2)), [], network)
    assert network.rates_deg_s[4:] == [None, None]


@pytest.mark.parametrize(("known_until_s", "status", "code"), [(-1, "refused", 2), (0.05, "source_failed", 3)])
def test_a_frame_without_a_yaw_rate(known_until_s, status, code):
    def rate(time_s):
        if time_s > known_until_s:
            raise ParameterError("no rate")
        return 0.0

    sink = Sink()
    outcome, _ = outcome_of(Source(frames(9)), [sink], yaw_rate_deg_s=rate)
    assert (outcome.summary["status"], outcome.exit_code, outcome.message) == (status, code, "no rate")
    assert sink.calls.count("close") == 1


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
