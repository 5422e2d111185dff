"""The loop with a source, a network and outputs that do as they are told."""

from __future__ import annotations

import errno

import pytest

from lobula.errors import FrameSourceError, OutputError, ParameterError, TimeError
from lobula.runtime.loop import run
from lobula.runtime.ndjson import ReaderGoneError
from lobula.runtime.outputs import Outputs
from lobula.runtime.sinks import OutputLapseError
from lobula.runtime.tally import unbegun_summary

from .readings import Network, Sink, Source, frames


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


def test_events_go_out_before_the_frame_is_drawn():
    sink = Sink()
    outcome_of(Source(frames(3)), [sink], Network({1}))
    assert sink.calls == ["open", "frame", "event", "frame", "frame", "event", "close"]


def test_an_output_that_lost_something_goes_on_and_says_so():
    lossy, good = Sink(fails=("frame",), error=OutputLapseError), Sink()
    outcome, said = outcome_of(Source(frames(3)), [lossy, good])
    assert lossy.calls == ["open", "frame", "frame", "frame", "close"]
    assert good.calls == lossy.calls
    assert said == outcome.summary["problems"] == ["cannot frame"] * 3
    assert (outcome.summary["status"], outcome.exit_code) == ("output_failed", 3)


def test_what_an_output_has_to_say_is_told_at_once_and_is_no_failure():
    sink = Sink()
    sink.notes = ["r.part.mp4 was left"]
    outcome, said = outcome_of(Source(frames(3)), [sink, Sink()])
    assert said == outcome.summary["notes"] == sink.summary["notes"] == ["r.part.mp4 was left"]
    assert (outcome.summary["status"], outcome.exit_code) == ("ok", 0)
    assert "problems" not in outcome.summary


class Manager:
    """A service manager that notes what it is told."""

    def __init__(self):
        self.told = []

    def beat(self, words, ready):
        self.told.append((ready, words()))

    def stop(self):
        self.told.append("stopped")


def test_a_service_manager_hears_of_every_frame_and_of_the_end():
    manager = Manager()
    outcome_of(Source([*frames(2), FrameSourceError("cable out")]), [], listeners=[manager])
    assert [t if isinstance(t, str) else t[0] for t in manager.told] == [True, True, "stopped"]
    assert manager.told[1][1] == "ok; collisions 0, dropped 0, lost 0"
