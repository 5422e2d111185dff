"""A reader may sleep, fail or go: the run hears of it and never waits."""

from __future__ import annotations

import io
import json
import threading

import pytest

from lobula.errors import OutputError
from lobula.runtime import carried
from lobula.runtime.carried import Carried
from lobula.runtime.courier import Courier
from lobula.runtime.ndjson import NdjsonSink, ReaderGoneError
from lobula.runtime.sinks import OutputLapseError

HEADER = {"type": "header", "source": "camera 0"}
SUMMARY = {"type": "summary", "status": "ok"}


class Sleeper(io.StringIO):
    """A stream whose reader sleeps until it is woken."""

    def __init__(self):
        super().__init__()
        self.reached, self.woken = threading.Event(), threading.Event()

    def write(self, text):
        self.reached.set()
        self.woken.wait(30)
        return super().write(text)


def test_all_arrives_in_order_and_of_the_frames_the_first():
    stream = io.StringIO()
    sink = Carried(NdjsonSink(stream), "standard output")
    sink.open(HEADER)
    for index in range(3):
        sink.frame(index, None, lambda: pytest.fail("nobody needs a picture"))
    sink.event({"type": "state"})
    sink.close(SUMMARY)
    assert [json.loads(line)["type"] for line in stream.getvalue().splitlines()] == ["header", "state", "summary"]


def test_a_sleeping_reader_holds_nobody_up_and_what_is_lost_is_told(monkeypatch):
    monkeypatch.setattr(carried, "Courier", lambda name: Courier(name, most=3))
    stream = Sleeper()
    sink = Carried(NdjsonSink(stream), "standard output", patience_s=0.01)
    sink.open(HEADER)
    sink.frame(0, None, None)
    assert stream.reached.wait(30)  # it hangs in the header
    for number in range(3):
        sink.event({"type": "state", "number": number})
    sink.silence(1, 0.1)  # nothing is lost yet
    for number in range(3, 5):
        sink.event({"type": "state", "number": number})
    with pytest.raises(OutputLapseError, match="standard output: nobody reads it as fast as it comes: lines are lost"):
        sink.silence(1, 0.1)
    sink.frame(1, None, None)  # told once
    with pytest.raises(OutputLapseError, match=r"standard output: nobody read all of it: 7 lines are lost"):
        sink.close(SUMMARY)  # three of five, the one it hangs in, the two that waited, the summary
    stream.woken.set()


@pytest.mark.parametrize(("error", "kind"), [(BrokenPipeError(), ReaderGoneError), (OSError(28, ""), OutputError)])
def test_a_reader_that_fails_is_heard_of_with_the_next_frame(error, kind):
    class Broken(io.StringIO):
        def write(self, text):
            raise error

    sink = Carried(NdjsonSink(Broken()), "standard output")
    sink.open(HEADER)
    sink.frame(0, None, None)
    sink._courier.close()  # wait until it has tried
    sink.event({"type": "state"})  # whoever has a record to tell is not troubled
    calls = (sink.frame, 1, None, None), (sink.silence, 1, 0.1), (sink.close, SUMMARY)
    for call, *arguments in calls:
        with pytest.raises(kind):
            call(*arguments)
