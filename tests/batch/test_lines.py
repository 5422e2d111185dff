"""Lines that were added are there, whoever adds, and whatever stops them."""

from __future__ import annotations

import errno
import fcntl
import resource
import threading

import pytest

from lobula.batch import lines as module
from lobula.batch.lines import Lines
from lobula.errors import OutputError


@pytest.fixture
def lines(tmp_path):
    return Lines(tmp_path / "lines.ndjson")


def test_only_what_is_new(lines):
    other = Lines(lines.path)
    assert lines.new() == []
    lines.add({"a": 1})
    assert other.new() == [{"a": 1}]
    other.add({"a": 2})
    assert other.new() == [{"a": 2}]
    assert lines.new() == [{"a": 1}, {"a": 2}]
    assert lines.new() == []


def test_a_line_torn_anywhere_costs_that_line_alone(lines):
    lines.add({"name": "first"})
    whole = lines.path.read_bytes()
    for cut in range(len(whole)):
        lines.path.write_bytes(whole + whole[:cut])
        assert Lines(lines.path).new() == [{"name": "first"}]
        Lines(lines.path).add({"name": "next"})
        assert Lines(lines.path).new()[-1] == {"name": "next"}
        assert len(Lines(lines.path).new()) == 2 + (cut == len(whole) - 1)  # without its line break it is whole


def test_a_line_that_is_being_written_comes_when_it_is_whole(lines):
    lines.path.write_text('{"a":1}\n{"a"')
    assert lines.new() == [{"a": 1}]
    with lines.path.open("a") as file:
        file.write(":2}\n")
    assert lines.new() == [{"a": 2}]


def test_a_file_that_was_emptied_is_read_from_its_beginning(lines):
    lines.add({"a": 1})
    lines.new()
    lines.path.write_text("")
    assert lines.new() == []
    lines.add({"b": 1})
    assert lines.new() == [{"b": 1}]


def test_many_at_once(lines):
    def add(who):
        own = Lines(lines.path)
        for i in range(20):
            own.add({"who": who, "i": i})

    threads = [threading.Thread(target=add, args=(who,)) for who in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    records = lines.new()
    for who in range(4):
        assert [r["i"] for r in records if r["who"] == who] == list(range(20))


def test_a_full_disk_leaves_the_file_as_it_was(lines):
    lines.add({"a": 1})
    before = lines.path.read_bytes()
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(before) + 5, hard))  # room for half a line
    try:
        with pytest.raises(OutputError, match=r"^cannot write .*lines.ndjson: "):
            lines.add({"b": 2})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert lines.path.read_bytes() == before


def test_a_file_system_without_locks_is_named(lines, monkeypatch):
    def no_locks(descriptor, how):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(module.fcntl, "flock", no_locks)
    with pytest.raises(OutputError, match=r"its file system has no locks .*: --out must be on one that has$"):
        lines.add({"a": 1})


def test_a_file_that_cannot_be_read(tmp_path):
    with pytest.raises(OutputError, match=r"^cannot read .*: Is a directory$"):
        Lines(tmp_path).new()


def test_locks_are_given_back(lines):
    lines.add({"a": 1})
    with lines.path.open() as file:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
