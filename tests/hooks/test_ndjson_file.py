"""Records in a file: whole lines whatever the disk does."""

from __future__ import annotations

import errno
import json
import os
import threading
from pathlib import Path

import pytest

from lobula.errors import OutputError
from lobula.hooks import make_hook, ndjson_file

from .office import END, HEADER, START, SUMMARY, delivered, event, opened, reading, wait_until


def records(path):
    return [json.loads(line) for line in Path(path).read_text().splitlines()]


def test_header_records_and_summary_as_lines(tmp_path):
    path = tmp_path / "a.ndjson"
    path.write_text("an older run\n")
    tally = delivered(make_hook(f"ndjson:{path}"), START, END, readings=[reading(0.0)])
    header, *rest = records(path)
    assert {key: header[key] for key in ("type", "version", "source")} == {k: HEADER[k] for k in header if k in HEADER}
    assert "settings" not in header
    assert [r["type"] for r in rest] == ["reading", "collision", "collision", "summary"]
    assert all(r.pop("unix_s") > 1_600_000_000 for r in rest)
    assert rest[1:] == [START, END, SUMMARY]
    assert tally["sent"] == 4


@pytest.mark.parametrize("place", ["none/a", ".", "/proc/a"])
def test_a_place_where_nothing_can_be_written_is_told_before_the_first_frame(tmp_path, monkeypatch, place):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(OutputError, match=f"cannot write {place}: "):
        opened(make_hook(f"ndjson:{place}"))


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_is_a_failure_and_no_more(tmp_path):
    (tmp_path / "full").symlink_to("/dev/full")
    tally = delivered(make_hook(f"ndjson:{tmp_path / 'full'}"), START)
    assert (tally["sent"], tally["dropped"], tally["problem"]) == (0, 2, "No space left on device")


def test_a_disk_that_fills_up_inside_a_line_leaves_no_half_of_it(tmp_path, monkeypatch):
    write, room = os.write, [10_000, 20, None]  # a whole line, twenty bytes of one, no room; then room again

    def narrow(file, data):
        left = room.pop(0) if room else 10_000
        if left is None:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(file, data[:left])

    monkeypatch.setattr(ndjson_file.os, "write", narrow)
    path = tmp_path / "a"
    office = opened(make_hook(f"ndjson:{path}"))
    office.event(START)
    office.close(SUMMARY)
    assert [r["type"] for r in records(path)] == ["header", "collision", "summary"]  # one header only
    assert [r["phase"] for r in office.news()] == ["start", "end"]


def test_a_named_pipe_nobody_reads_and_one_that_is_read(tmp_path, monkeypatch):
    path = tmp_path / "pipe"
    os.mkfifo(path)
    unread = delivered(make_hook(f"ndjson:{path}"), START)
    assert (unread["dropped"], unread["problem"]) == (2, "nobody reads it")
    heard = []
    reader = threading.Thread(target=lambda: heard.extend(path.read_text().splitlines()))
    reader.start()
    assert delivered(make_hook(f"ndjson:{path}"), START)["dropped"] == 0
    reader.join(30)
    assert [json.loads(one)["type"] for one in heard] == ["header", "collision", "summary"]


def test_a_named_pipe_whose_reader_is_asleep(tmp_path, monkeypatch):
    monkeypatch.setattr(ndjson_file, "TIMEOUT_S", 0.05)
    path = tmp_path / "pipe"
    os.mkfifo(path)
    asleep = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    office = opened(make_hook(f"ndjson:{path}"), close_s=0.05)
    for number in range(1500):  # far more than the 64 KiB a pipe holds
        office.event(event(number))
    wait_until(lambda: office.tallies()[0]["failures"])
    office.close(SUMMARY)
    os.close(asleep)
    (tally,) = office.tallies()
    assert tally["problem"] == "nobody reads it"
    assert tally["sent"] + tally["dropped"] == 1501
    assert tally["dropped"] > 0
