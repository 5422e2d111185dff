"""Nobody reads what a run says, or nobody can: it goes on, and what it writes elsewhere is whole."""

from __future__ import annotations

import json
import os
import re
import subprocess
from contextlib import contextmanager
from pathlib import Path

import pytest

from lobula.report.trace_file import read_trace

from ..frames.clips import moving_bar
from ..frames.web_camera import WebCamera

BARS = moving_bar(40, 128, 96)
FRAMES = 20


@contextmanager
def full_pipe():
    """The end of a pipe into which nothing more fits, since nobody reads the other one."""
    read, write = os.pipe()
    try:
        os.set_blocking(write, False)
        try:
            while True:
                os.write(write, b"x" * 4096)
        except BlockingIOError:
            os.set_blocking(write, True)
        yield write
    finally:
        os.close(read)
        os.close(write)


@contextmanager
def deserted_pipe():
    """The end of a pipe whose reader has gone."""
    read, write = os.pipe()
    os.close(read)
    try:
        yield write
    finally:
        os.close(write)


@contextmanager
def full_disk():
    if not Path("/dev/full").exists():
        pytest.skip("needs /dev/full")
    with open("/dev/full", "w") as file:
        yield file.fileno()


def run_on_camera(spawn, *arguments, **how):
    with WebCamera(lambda n: BARS[n % 40]) as camera:
        process = spawn("run", camera.address, "--max-frames", FRAMES, "--trace", "t.csv", *arguments, **how)
        return *process.communicate(timeout=60), process.returncode


def test_records_that_nobody_reads_do_not_stop_a_live_run(spawn, tmp_path):
    with full_pipe() as full:
        _, err, code = run_on_camera(spawn, "--json", "--hook", "ndjson:h.ndjson", stdout=full)
    assert code == 3
    assert re.search(r"^lobula: standard output: nobody read all of it: \d+ lines are lost$", err, re.MULTILINE)
    assert len(read_trace(tmp_path / "t.csv")) == FRAMES
    last = json.loads((tmp_path / "h.ndjson").read_text().splitlines()[-1])
    assert (last["type"], last["status"], last["frames"]) == ("summary", "ok", FRAMES)


@pytest.mark.parametrize("stream", [full_pipe, deserted_pipe, full_disk])
def test_words_that_nobody_reads_neither(spawn, tmp_path, stream):
    with stream() as number:
        out, _, code = run_on_camera(spawn, "--json", stderr=number)
    assert code == 0
    assert json.loads(out.splitlines()[-1])["frames"] == FRAMES
    assert len(read_trace(tmp_path / "t.csv")) == FRAMES
    with stream() as number:
        _, _, code = run_on_camera(spawn, stderr=number)
    assert code == 0
    assert len(read_trace(tmp_path / "t.csv")) == FRAMES


@pytest.mark.parametrize("stream", [deserted_pipe, full_disk])
def test_a_recording_is_looked_at_to_its_end_though_nobody_can_be_told(spawn, clip, tmp_path, stream):
    with stream() as number:
        process = spawn("run", clip, "--trace", "t.csv", stdout=subprocess.DEVNULL, stderr=number)
        assert process.wait(60) == 0
    assert len(read_trace(tmp_path / "t.csv")) == 91


def test_a_mistake_has_its_exit_code_though_nobody_can_be_told(spawn):
    with deserted_pipe() as number:
        assert spawn("run", "nowhere.mp4", stderr=number).wait(60) == 2
