"""Lines for programs: the schema, and what happens when nobody or nothing takes them."""

from __future__ import annotations

import io
import json

import pytest

from lobula.errors import OutputError
from lobula.runtime.ndjson import NdjsonSink, ReaderGoneError

HEADER = {"type": "header", "version": "1", "preset": "default", "neurons": "all", "settings_hash": "abc",
          "engine": "core", "source": "clip.mp4", "width": 99, "height": 72, "fps": 30.0,
          "thresholds": {"lgmd1": 0.7}, "settings": []}  # fmt: skip


def test_one_line_for_each_record_and_none_for_frames():
    out = io.StringIO()
    sink = NdjsonSink(out)
    sink.open(HEADER)
    sink.frame(0, None, None)
    sink.event({"type": "state"})
    sink.close({"type": "summary"})
    records = [json.loads(line) for line in out.getvalue().splitlines()]
    assert [r["type"] for r in records] == ["header", "state", "summary"]
    assert {"version", "preset", "settings_hash", "source", "width", "height", "fps"} <= set(records[0])
    assert "settings" not in records[0]


def test_a_refused_request_has_a_summary_alone_and_every_other_end_a_header_too():
    for status, types in (("refused", ["summary"]), ("interrupted", ["header", "summary"])):
        out = io.StringIO()
        sink = NdjsonSink(out)
        sink.open(HEADER)
        sink.close({"type": "summary", "status": status})
        assert [json.loads(line)["type"] for line in out.getvalue().splitlines()] == types


class Broken(io.StringIO):
    def __init__(self, error):
        super().__init__()
        self.error = error

    def flush(self):
        raise self.error


def test_a_reader_that_has_gone():
    with pytest.raises(ReaderGoneError):
        NdjsonSink(Broken(BrokenPipeError())).event({})


def test_a_full_disk():
    with pytest.raises(OutputError, match="cannot write standard output: the disk is full"):
        NdjsonSink(Broken(OSError(28, "No space left on device"))).event({})
