"""A program for each event: one that works, fails, hangs, prints, starts others, does not exist."""

from __future__ import annotations

import json
import os
import shlex
import signal
import sys
from pathlib import Path

import pytest

from lobula.errors import ParameterError
from lobula.hooks import make_hook
from lobula.hooks.program import Program

from .office import END, START, SUMMARY, delivered, event, opened, reading, wait_until


def script(tmp_path, text):
    path = tmp_path / "own program.sh"
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


def test_it_runs_once_for_each_event_with_the_record_on_its_standard_input(tmp_path):
    path = script(tmp_path, 'cat >> "$2"; echo "$#" >> "$2"')
    out = tmp_path / "it's out"
    hook = make_hook(f"exec:{shlex.quote(str(path))} 'two words' {shlex.quote(str(out))} $HOME")
    tally = delivered(hook, START, END, readings=[reading(0.0)])
    lines = out.read_text().splitlines()
    assert lines[1::2] == ["3", "3"]  # $HOME is a word like any other: no shell
    got = [json.loads(one) for one in lines[0::2]]
    assert [r.pop("unix_s") > 0 for r in got] == [True, True]
    assert got == [START, END]
    assert tally == {"hook": "exec:own program.sh", "sent": 2, "dropped": 0, "failures": 0}


def test_what_it_prints_goes_to_standard_error(tmp_path, capfd):
    path = script(tmp_path, "echo said")
    delivered(make_hook(f"exec:{shlex.quote(str(path))}"), START)
    assert capfd.readouterr() == ("", "said\n")


@pytest.mark.parametrize(("text", "says"), [("exit 3", "exit code 3"), ("kill -9 $$", "ended by SIGKILL")])
def test_a_program_that_fails(tmp_path, text, says):
    tally = delivered(Program([str(script(tmp_path, text))]), START, END)
    assert (tally["sent"], tally["dropped"], tally["failures"], tally["problem"]) == (0, 2, 2, says)


def test_a_program_that_does_not_read(tmp_path):
    big = event(0) | {"text": "x" * 200_000}  # more than a pipe holds
    assert delivered(Program(["true"]), big)["failures"] == 0


def test_a_program_that_hangs_is_killed_with_all_it_started(tmp_path):
    pids = tmp_path / "pids"
    path = script(tmp_path, f"sleep 1000 & echo $$ $! >> {shlex.quote(str(pids))}; wait")
    tally = delivered(Program([str(path)], limit_s=0.2), START)
    assert (tally["sent"], tally["dropped"], tally["problem"]) == (0, 1, "killed after 0.2 s")
    wait_until(lambda: not any(alive(int(pid)) for pid in pids.read_text().split()))


def test_at_the_end_a_hanging_program_is_killed_and_no_other_started(tmp_path):
    pids = tmp_path / "pids"
    path = script(tmp_path, f"echo $$ >> {shlex.quote(str(pids))}; sleep 1000")
    office = opened(Program([str(path)]), close_s=0.1)
    office.event(START)
    office.event(END)
    wait_until(pids.exists)
    wait_until(pids.read_text)
    office.close(SUMMARY)
    wait_until(lambda: not any(alive(int(pid)) for pid in pids.read_text().split()))
    assert len(pids.read_text().split()) == 1
    assert (office.tallies()[0]["sent"], office.tallies()[0]["dropped"]) == (0, 2)


def test_at_the_end_a_program_that_cannot_be_killed_is_not_waited_for(tmp_path, monkeypatch):
    hook = Program([str(script(tmp_path, "exec sleep 1000"))])
    office = opened(hook, close_s=0.05)
    office.event(START)
    wait_until(lambda: hook._process)
    process, kill = hook._process, os.killpg
    monkeypatch.setattr(os, "killpg", lambda *_: None)  # as one that waits for a disk that is gone
    office.close(SUMMARY)
    assert process.poll() is None
    kill(process.pid, signal.SIGKILL)
    process.wait(30)


def test_a_program_that_has_gone_since(tmp_path):
    path = script(tmp_path, "true")
    hook = make_hook(f"exec:{shlex.quote(str(path))}")
    path.unlink()
    assert delivered(hook, START)["problem"] == "cannot be started: No such file or directory"


@pytest.mark.parametrize(
    ("target", "says"),
    [
        ("exec:", "no program is named"),
        ("exec:'open", "No closing quotation"),
        ("exec:no-such-program --password secret", "hook exec:no-such-program: no program: must be executable"),
    ],
)
def test_commands_that_cannot_be(target, says):
    with pytest.raises(ParameterError, match=says) as refused:
        make_hook(target)
    assert "secret" not in str(refused.value)


def test_arguments_are_not_part_of_its_name():
    assert make_hook(f"exec:{shlex.quote(sys.executable)} --token=secret").name == f"exec:{Path(sys.executable).name}"


def alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as stat:
            return stat.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        if not os.path.isdir("/proc/self"):
            try:
                os.kill(pid, 0)
            except ProcessLookupError:
                return False
            return True
        return False
