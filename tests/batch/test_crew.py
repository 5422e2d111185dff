"""Workers that die, fail or never start; the processes here are real, what they do stands in for work."""

from __future__ import annotations

import multiprocessing
import os
import signal
import time
from pathlib import Path

import pytest

from lobula.batch import crew as module
from lobula.batch.clips import Clip
from lobula.batch.crew import Crew
from lobula.batch.row import Row
from lobula.batch.work import Answer
from lobula.batch.worker import READY, serve
from lobula.errors import OutputError, ParameterError
from lobula.workers import ONE_THREAD, STOPPING

from .conftest import write_clip

AT_IMPORT = {name: os.environ.get(name) for name in ONE_THREAD}
"""In a worker: what a library finds that is loaded before any work."""


def answer_of(clip):
    return Answer(Row(file=clip.name, status="ok"), fresh=True)


def play(line):
    """In a worker: do what the name of the clip says. The request is a folder."""
    folder = line.recv()
    line.send(READY)
    while True:
        clip = line.recv()
        once = folder / clip.name
        if clip.name.startswith("kills") or (clip.name.startswith("once") and not once.exists()):
            once.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        if clip.name == "leaves":
            os._exit(7)
        if clip.name == "full":
            line.send(OutputError("the disk is full"))
            return
        line.send(answer_of(clip))
        if clip.name == "last":  # it dies with nothing in hand
            os._exit(0)


def never_ready(line):
    os._exit(5)


def slow_starter(line):
    """In a worker: end before it is ready, unless two have done so."""
    folder = line.recv()
    if len(list(folder.glob("stillborn*"))) < 2:
        (folder / f"stillborn{os.getpid()}").touch()
        os._exit(1)
    line.send(READY)
    while True:
        line.send(answer_of(line.recv()))


def threads_and_signals(line):
    """In a worker: name the environment, and the signals that wait."""
    line.recv()
    line.send(READY)
    line.recv()
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    notes = (*map(str, AT_IMPORT.values()), *(number.name for number in STOPPING if number in blocked))
    line.send(Answer(Row(file="", status="ok", notes=notes)))
    line.recv()


def refuses(line):
    line.send(ParameterError("a worker has other code"))


@pytest.fixture(scope="module")
def quick():
    """A way to start processes in which everything is loaded already."""
    multiprocessing.set_forkserver_preload([__name__])
    return multiprocessing.get_context("forkserver")


@pytest.fixture
def crew(monkeypatch, tmp_path, quick):
    """Make a crew whose workers do ``what``."""

    def make(what, workers=2):
        monkeypatch.setattr(module, "serve", what)
        monkeypatch.setattr(module, "get_context", lambda kind: quick)
        return Crew(tmp_path, workers)

    return make


def clips(*names):
    return [Clip(name, Path(name)) for name in names]


def outcomes(crew, *names):
    with crew:
        return {clip.name: outcome for clip, outcome in crew.each(clips(*names))}


def test_every_clip_once(crew):
    names = [f"clip{i}" for i in range(7)]
    assert outcomes(crew(play), *names) == {name: answer_of(Clip(name, Path(name))) for name in names}


def test_a_worker_that_is_killed_costs_nothing(crew):
    found = outcomes(crew(play), "a", "once1", "b", "once2", "c")
    assert all(isinstance(outcome, Answer) for outcome in found.values())
    assert len(found) == 5


def test_a_clip_that_kills_two_workers_fails_and_the_others_do_not(crew):
    found = outcomes(crew(play), "a", "kills", "b", "leaves", "c")
    assert found.pop("kills") == "its worker ended in the middle of it, twice (SIGKILL)"
    assert found.pop("leaves") == "its worker ended in the middle of it, twice (exit code 7)"
    assert all(isinstance(outcome, Answer) for outcome in found.values())


def test_a_worker_that_ends_between_two_clips_is_replaced(crew):
    with crew(play, workers=1) as one:
        for _ in range(2):
            assert [clip.name for clip, _ in one.each(clips("a", "last"))] == ["a", "last"]
            time.sleep(0.1)


def test_an_error_that_ends_the_batch(crew):
    with pytest.raises(OutputError, match=r"^the disk is full$"):
        outcomes(crew(play), "a", "full", "b")


@pytest.mark.parametrize(
    ("what", "error", "message"),
    [
        (never_ready, OutputError, r"^a worker cannot start: it ended by itself \(exit code 5\)$"),
        (refuses, ParameterError, "^a worker has other code$"),
    ],
)
def test_workers_that_cannot_start(crew, what, error, message):
    with pytest.raises(error, match=message):
        outcomes(crew(what), "a", "b")


def test_a_worker_that_ends_before_it_is_ready_is_replaced(crew):
    assert len(outcomes(crew(slow_starter), "a", "b", "c")) == 3


def test_a_worker_starts_with_one_thread_and_deaf_to_the_terminal(monkeypatch, tmp_path):
    monkeypatch.setattr(module, "serve", threads_and_signals)
    with Crew(tmp_path, 1) as one:
        ((_, answer),) = one.each(clips("a"))
    assert answer.row.notes == ("1",) * len(ONE_THREAD) + ("SIGINT", "SIGTERM")


def test_there_are_no_more_workers_than_clips(crew):
    with crew(play, workers=8) as many:
        list(many.each(clips("a", "b")))
        assert len(many._hands) == 2


def test_none_is_left(crew):
    with crew(play) as two:
        next(two.each(clips("a", "b", "c")))
        processes = [hand._process for hand in two._hands]
        assert all(process.is_alive() for process in processes)
        pids = [process.pid for process in processes]
    for pid in pids:
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


@pytest.mark.parametrize("workers", [0, -1, 257])
def test_workers_out_of_range(workers, tmp_path):
    with pytest.raises(ParameterError, match=f"^workers = {workers}: must be 1 to 256$"):
        Crew(tmp_path, workers)


def test_real_work(ask, tmp_path):
    paths = [write_clip(tmp_path / f"{seed}.mp4", seed, frames=8) for seed in range(3)]
    with Crew(ask(), 2) as two:
        found = dict(two.each([Clip(path.name, path) for path in paths]))
    assert {clip.name: outcome.row.frames for clip, outcome in found.items()} == {"0.mp4": 8, "1.mp4": 8, "2.mp4": 8}
    assert module.serve is serve
