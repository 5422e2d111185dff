"""Ctrl-C and SIGTERM in the middle: outputs are closed, the summary says so, the exit code is the signal's."""

from __future__ import annotations

import array
import fcntl
import json
import signal
import subprocess
import termios
import time

import numpy as np
import pytest

import lobula
from lobula.report.trace_file import read_trace

FRAMES = 40
SIGNALS = [(signal.SIGINT, 130), (signal.SIGTERM, 143)]


def wait_until_read(pipe):
    """Return when nothing of what was written to ``pipe`` is left in it."""
    left, deadline_s = array.array("i", [1]), time.monotonic() + 30
    while left[0]:
        assert time.monotonic() < deadline_s
        time.sleep(0.01)
        fcntl.ioctl(pipe, termios.FIONREAD, left)


@pytest.fixture
def waiting_run(spawn, movie):
    """A run that has read ``FRAMES`` pictures from a pipe and waits for the next one."""

    def start(*options):
        process = spawn("run", "-", "--json", "--pixel-format", "gray8", "--input-size", "99x72", *options,
                        stdin=subprocess.PIPE, text=False)  # fmt: skip
        process.stdin.write(movie.images[:FRAMES].tobytes())
        process.stdin.flush()
        for line in process.stdout:  # header, start and end of the warm-up: frame 6 is through
            if json.loads(line).get("phase") == "end":
                break
        return process

    return start


@pytest.mark.parametrize(("number", "code"), SIGNALS)
def test_a_signal_while_it_waits_for_a_picture(waiting_run, tmp_path, number, code):
    process = waiting_run("--trace", "t.csv", "--annotate", "out.mp4")
    process.send_signal(number)
    out, err = process.communicate(timeout=30)
    assert process.returncode == code
    assert err.decode() == f"lobula: interrupted ({number.name})\n"
    summary = json.loads(out.splitlines()[-1])
    assert summary["status"] == "interrupted"
    assert 6 < summary["frames"] <= FRAMES
    assert len(read_trace(tmp_path / "t.csv")) == summary["frames"]
    with lobula.open(tmp_path / "out.mp4") as video:
        assert len(list(video)) == summary["frames"]


def test_a_signal_before_the_source_is_open(spawn):
    process = spawn("run", "-", "--json", stdin=subprocess.PIPE, text=False)
    process.stdin.write(b"x")
    process.stdin.flush()
    wait_until_read(process.stdin)  # now it waits for the second byte
    process.send_signal(signal.SIGTERM)
    out, err = process.communicate(timeout=30)
    assert (process.returncode, err) == (143, b"lobula: interrupted (SIGTERM)\n")
    assert json.loads(out)["status"] == "interrupted"


def test_a_signal_while_it_works(spawn, tmp_path):
    images = np.random.default_rng(0).integers(0, 255, (2000, 72, 99), np.uint8)
    (tmp_path / "raw").write_bytes(images.tobytes())
    with (tmp_path / "raw").open("rb") as raw:
        process = spawn("run", "-", "--json", "--pixel-format", "gray8", "--input-size", "99x72", "--annotate",
                        "out.mp4", "--report", "r", stdin=raw)  # fmt: skip
        for line in process.stdout:
            if json.loads(line).get("phase") == "end":
                break
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    summary = json.loads(out.splitlines()[-1])
    assert summary["status"] == "interrupted"
    assert summary["frames"] < 2000
    assert "interrupted" in (tmp_path / "r" / "index.html").read_text()
    with lobula.open(tmp_path / "out.mp4") as video:
        assert len(list(video)) == summary["frames"]
