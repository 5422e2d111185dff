"""What people see on a terminal."""

from __future__ import annotations

import sys

import numpy as np

from lobula.cli.live import listeners
from lobula.cli.progress import screen
from lobula.frames import open as open_frames

from ..frames.scripted_camera import ScriptedCamera
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
