"""Processes of this machine: as many as it has cores, and started so that a signal to all of them harms none."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest

from lobula.errors import ParameterError
from lobula.workers import MOST_WORKERS, ONE_THREAD, STOPPING, check_workers, cores, starting_workers

FAMILY = """
import os, signal, sys, time
from multiprocessing import get_context
from lobula.workers import begin_worker, starting_workers

def work(line):
    begin_worker()
    for number in (signal.SIGINT, signal.SIGTERM):
        os.kill(os.getpid(), number)
    line.send(os.getpid())
    time.sleep(600)

if __name__ == "__main__":
    context = get_context("spawn")
    here, there = context.Pipe()
    with starting_workers():
        context.Process(target=work, args=(there,), daemon=True).start()
    print(here.recv(), flush=True)
    sys.stdin.read()
"""


def masked():
    return signal.pthread_sigmask(signal.SIG_BLOCK, ())


def test_cores():
    assert 1 <= cores() <= (os.cpu_count() or 1)


@pytest.mark.parametrize("workers", [0, -1, MOST_WORKERS + 1])
def test_out_of_range(workers):
    with pytest.raises(ParameterError, match=f"^workers = {workers}: must be 1 to 256$"):
        check_workers(workers)


@pytest.mark.parametrize("workers", [1, MOST_WORKERS])
def test_in_range(workers):
    check_workers(workers)


def test_what_is_around_the_start_is_put_back(monkeypatch):
    first, *others = ONE_THREAD
    monkeypatch.setenv(first, "3")
    for name in others:
        monkeypatch.delenv(name, raising=False)
    before = masked()
    with starting_workers():
        assert [os.environ[name] for name in ONE_THREAD] == ["1"] * len(ONE_THREAD)
        assert masked() >= set(STOPPING)
    assert [os.environ.get(name) for name in ONE_THREAD] == ["3", None, None, None]
    assert masked() == before


def test_a_worker_outlives_signals_but_not_its_parent(tmp_path):
    script = tmp_path / "family.py"
    script.write_text(FAMILY)
    parent = subprocess.Popen(
        [sys.executable, script], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        env={"PYTHONPATH": ":".join(sys.path)},
    )  # fmt: skip
    try:
        assert int(parent.stdout.readline()) > 0  # told after both signals
    finally:
        parent.kill()
    assert parent.stdout.read() == ""  # the end of the file: the worker, which has it open too, has ended
    parent.communicate()
