"""A clip of an approach, and a way to call the command as a user does."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

import lobula
from lobula.cli import main
from lobula.report.grey_clip import write_grey_clip

SRC = Path(lobula.__file__).parents[1]


class Called(NamedTuple):
    """Exit code and what was printed, as text."""

    code: int
    out: str
    err: str

    @property
    def records(self):
        return [json.loads(line) for line in self.out.splitlines()]

    @property
    def document(self):
        return json.loads(self.out)


@pytest.fixture
def call(capsys, monkeypatch, tmp_path):
    """Call ``lobula`` in this process, in an empty folder."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        capsys.readouterr()
        code = main([str(a) for a in arguments])
        printed = capsys.readouterr()
        return Called(code, printed.out, printed.err)

    return run


@pytest.fixture
def spawn(tmp_path):
    """Start ``python -m lobula`` as a process of its own, in an empty folder."""
    started = []

    def run(*arguments, environment=None, **how):
        how = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "cwd": tmp_path, "text": True} | how
        process = subprocess.Popen(
            [sys.executable, "-m", "lobula", *map(str, arguments)],
            env={"PATH": "/usr/bin:/bin", "PYTHONPATH": str(SRC), **(environment or {})}, **how,
        )  # fmt: skip
        started.append(process)
        return process

    yield run
    for process in started:
        process.kill()
        process.communicate()


@pytest.fixture(scope="session")
def movie():
    return lobula.stimuli.looming(scene="arena", speed_cm_s=12.0)


@pytest.fixture(scope="session")
def clip(tmp_path_factory, movie):
    """An approach at 30 Hz, 91 frames, contact at 3.0 s."""
    path = tmp_path_factory.mktemp("clips") / "approach.mp4"
    write_grey_clip(path, movie.images, movie.times_s, movie.rate_hz)
    return path
