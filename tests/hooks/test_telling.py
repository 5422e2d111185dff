"""What the reader of a run is told of its hooks."""

from __future__ import annotations

from lobula.hooks import PostOffice, RefusedError, Telling

from .office import HEADER, START, SUMMARY, Scripted, opened, reading, wait_until


class Reader:
    def __init__(self):
        self.calls = []

    def open(self, header):
        self.calls.append(("open", header["type"]))

    def frame(self, index, reading, picture):
        self.calls.append(("frame", index))

    def event(self, record):
        self.calls.append(("event", record))

    def close(self, summary):
        self.calls.append(("close", summary))


def test_trouble_is_a_record_with_the_frame_at_which_it_is_told():
    reader, hook = Reader(), Scripted(plan=[RefusedError("no")])
    office = opened(hook)
    telling = Telling(reader, office)
    telling.open(HEADER)
    office.event(START)
    wait_until(lambda: office.tallies()[0]["failures"])
    telling.frame(4, reading(0.1333333333), None)
    telling.event(START)
    office.close(SUMMARY)
    telling.close(SUMMARY)
    trouble = {"type": "hook", "hook": "scripted", "phase": "start", "problem": "no", "frame": 4, "time_s": 0.133333}
    over = {"type": "hook", "hook": "scripted", "phase": "end", "failures": 1, "dropped": 1}
    tally = {"hook": "scripted", "sent": 1, "dropped": 1, "failures": 1, "problem": "no"}
    assert reader.calls == [
        ("open", "header"),
        ("frame", 4),
        ("event", trouble),
        ("event", START),
        ("event", over | {"frame": 4, "time_s": 0.133333}),
        ("close", SUMMARY | {"hooks": [tally]}),
    ]


def test_news_is_told_while_no_frame_comes_to_the_reader_and_who_else_wants_it():
    reader, page, hook = Reader(), [], Scripted(plan=[RefusedError("no")])
    office = opened(hook)
    telling = Telling(reader, office, also=page.append)
    telling.frame(4, reading(0.1333333333), None)
    office.event(START)
    wait_until(lambda: office.tallies()[0]["failures"])
    telling.silence(4, 7.25)
    telling.silence(4, 7.35)
    told = {"type": "hook", "hook": "scripted", "phase": "start", "problem": "no", "frame": 4, "time_s": 7.25}
    assert reader.calls == [("frame", 4), ("event", told)]
    assert page == [told]
    office.close(SUMMARY)


def test_a_refused_run_has_a_summary_alone():
    reader, office = Reader(), PostOffice([Scripted()])
    refused = {"type": "summary", "status": "refused", "frames": 0}
    telling = Telling(reader, office)
    office.close(refused)
    telling.close(refused)
    assert reader.calls == [("close", refused)]
