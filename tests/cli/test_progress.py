"""What people see on a terminal."""

from __future__ import annotations

import json
import os
import pty
import shlex
import subprocess
import sys
import termios
from contextlib import contextmanager, suppress

import numpy as np
import pytest

from lobula.cli.live import listeners
from lobula.cli.progress import live_screen, say, screen
from lobula.frames import open as open_frames
from lobula.runtime import courier

from ..frames.scripted_camera import ScriptedCamera
from .conftest import SRC
from .terminal import Terminal


def test_the_words_before_the_bar_change_once_a_second(monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "120")
    with screen(None, "camera 0") as here:
        live = ScriptedCamera()
        live.live = True
        (listener,) = listeners(live, here)
        listener.beat(lambda: "ok; [latency] 2.0 ms", ready=True)
        listener.beat(lambda: "too soon", ready=True)
        here.advance()
        here.say("a line")
        listener.stop()
    shown = terminal.getvalue()
    assert "ok; [latency] 2.0 ms" in shown
    assert "a line" in shown
    assert "too soon" not in shown


def test_a_pipe_and_a_recording_show_none(monkeypatch):
    with screen(10, "clip") as here:
        assert (here.advance, here.describe) == (None, None)
    with open_frames(np.zeros((2, 72, 99), np.uint8)) as frames:
        assert listeners(frames, here._replace(describe=print)) == []


@contextmanager
def terminal(monkeypatch):
    """Give the end of a pseudo-terminal that is now standard error, and the one that a person has."""
    ours, theirs = pty.openpty()
    with open(theirs, "w", encoding="utf-8") as stream:
        monkeypatch.setattr(sys, "stderr", stream)
        monkeypatch.setenv("TERM", "xterm")
        yield theirs, ours
    os.close(ours)


def read_if_any(number):
    try:
        return os.read(number, 65536)
    except BlockingIOError:
        return b""


def test_a_live_screen_shows_words_lines_and_a_count(monkeypatch):
    with terminal(monkeypatch) as (_, person):
        with live_screen(None, "camera 0") as here:
            assert here.advance is None
            here.describe("ok; latency 2.0 ms", 17)
            here.say("a line")
        os.set_blocking(person, False)
        shown = b"".join(iter(lambda: read_if_any(person), b"")).decode()
    assert "ok; latency 2.0 ms" in shown
    assert "17/?" in shown
    assert "a line" in shown


def test_a_terminal_that_was_stopped_holds_nobody_up(monkeypatch):
    monkeypatch.setattr(courier.Courier.close, "__defaults__", (0.2,))
    with terminal(monkeypatch) as (own, _):
        termios.tcflow(own, termios.TCOOFF)  # Ctrl-S
        try:
            with live_screen(None, "camera 0") as here:
                for number in range(2000):
                    here.say(f"line {number}")
                    here.describe("ok", number)
        finally:
            termios.tcflow(own, termios.TCOON)


@pytest.mark.parametrize("shown", [screen, live_screen])
def test_a_terminal_that_hangs_up_ends_nothing(monkeypatch, shown):
    ours, theirs = pty.openpty()
    with open(theirs, "w", encoding="utf-8", closefd=False) as stream:
        monkeypatch.setattr(sys, "stderr", stream)
        with shown(3, "clip") as here:
            here.say("a line")
            os.close(ours)
            here.say("another")
            here.describe("ok", 1)
        say("done")
        os.dup2(os.open(os.devnull, os.O_WRONLY), theirs)  # for what waits in the stream's buffer
    os.close(theirs)


def test_records_of_a_recording_go_to_their_reader_though_there_is_a_bar(spawn, clip, tmp_path):
    ours, theirs = pty.openpty()
    with (tmp_path / "out.ndjson").open("w") as out:
        process = spawn("run", clip, "--json", stdout=out, stderr=theirs)
        os.close(theirs)
        with suppress(OSError):
            while os.read(ours, 65536):
                pass
        assert process.wait(60) == 0
    os.close(ours)
    records = [json.loads(line) for line in (tmp_path / "out.ndjson").read_text().splitlines()]
    assert [records[0]["type"], records[-1]["type"]] == ["header", "summary"]


@pytest.mark.parametrize(("arguments", "code"), [((), 0), (("--json",), 2)])
def test_without_a_standard_output(tmp_path, clip, arguments, code):
    command = [sys.executable, "-m", "lobula", "run", str(clip), *arguments]
    done = subprocess.run(
        ["sh", "-c", f"{shlex.join(command)} >&-"], cwd=tmp_path, stderr=subprocess.PIPE, text=True, check=False,
        env={"PATH": "/usr/bin:/bin", "PYTHONPATH": str(SRC)},
    )  # fmt: skip
    assert done.returncode == code
    assert "Traceback" not in done.stderr
