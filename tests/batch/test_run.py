"""A whole batch in this process: the table and the summary say what became of every clip."""

from __future__ import annotations

import csv
import json
import shutil
import signal
import threading
import time

import pytest

from lobula.batch import find_clips, run_batch
from lobula.batch.claim import claimed
from lobula.batch.lines import Lines
from lobula.batch.places import work_folder
from lobula.batch.row import COLUMNS
from lobula.batch.work import Answer
from lobula.errors import OutputError, ParameterError
from lobula.runtime.interrupts import Interrupted

from .conftest import Alone, write_clip


@pytest.fixture
def folder(tmp_path):
    """Three clips, a copy of one of them, and two that cannot be read."""
    for seed in range(3):
        write_clip(tmp_path / "clips" / f"{seed}.mp4", seed)
    shutil.copy(tmp_path / "clips" / "0.mp4", tmp_path / "clips" / "copy.mp4")
    (tmp_path / "clips" / "empty.mp4").touch()
    (tmp_path / "clips" / "text.mp4").write_text("nothing")
    return tmp_path / "clips"


def batch(folder, ask, out, hands=Alone, tell=lambda row: None):
    asked = ask()
    return run_batch(find_clips([str(folder)], out), asked, hands(asked), tell)


def table(out):
    with (out / "clips.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def summary(out):
    return json.loads((out / "summary.json").read_text())


def manifest(out):
    return Lines(out / "manifest.ndjson").new()


def test_every_clip_has_a_row_in_the_order_of_the_clips(folder, ask, out):
    told = []
    ended = batch(folder, ask, out, tell=told.append)
    assert [row["file"] for row in table(out)] == [
        str(folder / f"{name}.mp4") for name in (0, 1, 2, "copy", "empty", "text")
    ]
    assert [row["status"] for row in table(out)] == ["ok"] * 4 + ["failed"] * 2
    assert list(table(out)[0]) == list(COLUMNS)
    assert sorted(row.file for row in told) == [row["file"] for row in table(out)]
    assert ended.stop is None
    assert summary(out) == ended.summary.as_dict()
    wanted = {"status": "some_failed", "clips": 6, "ok": 4, "failed": 2, "unfinished": 0, "done": 5, "kept": 1,
              "frames": 80, "workers": 1, "problem": ""}  # fmt: skip
    assert wanted.items() <= summary(out).items()


def test_equal_contents_are_done_once_and_told_twice(folder, ask, out):
    batch(folder, ask, out)
    first, copy = table(out)[0], table(out)[3]
    assert {name for name in COLUMNS if first[name] != copy[name]} == {"file"}
    assert [row["content"] for row in manifest(out)].count(first["content"]) == 1


def test_again_nothing_is_done_but_what_failed(folder, ask, out):
    batch(folder, ask, out)
    before = table(out)
    ended = batch(folder, ask, out)
    assert (ended.summary.done, ended.summary.kept) == (2, 4)
    assert table(out)[:4] == before[:4]
    assert len(manifest(out)) == 5 + 2


def test_new_clips_are_taken_up(folder, ask, out):
    batch(folder, ask, out)
    write_clip(folder / "9.mp4", 9)
    ended = batch(folder, ask, out)
    assert (ended.summary.clips, ended.summary.ok, ended.summary.done) == (7, 5, 3)


class Stopped(Alone):
    """Hands that are stopped when three clips are done, two of them told."""

    stop: BaseException = Interrupted(signal.SIGTERM)

    def each(self, clips):
        for i, found in enumerate(super().each(clips)):
            if i == 2:
                raise self.stop
            yield found


@pytest.mark.parametrize(
    ("stop", "status"), [(Interrupted(signal.SIGTERM), "interrupted"), (OutputError("disk"), "output_failed")]
)
def test_what_was_done_before_it_was_stopped_is_kept(folder, ask, out, monkeypatch, stop, status):
    monkeypatch.setattr(Stopped, "stop", stop)
    (folder / "copy.mp4").unlink()
    ended = batch(folder, ask, out, hands=Stopped)
    assert ended.stop is stop
    assert (summary(out)["status"], summary(out)["unfinished"]) == (status, 2)
    assert [row["status"] for row in table(out)].count("unfinished") == 2
    assert (ended.summary.done, len(manifest(out))) == (3, 3)
    again = batch(folder, ask, out)
    assert (again.summary.ok, again.summary.failed, again.summary.unfinished) == (3, 2, 0)
    contents = [row["content"] for row in manifest(out) if row["status"] == "ok"]
    assert len(contents) == len(set(contents)) == 3


def test_what_another_run_has_in_hand_is_waited_for(folder, ask, out, monkeypatch):
    """The other run holds a claim on the first clip, then gives it up without having done it."""
    asked, taken = ask(), threading.Event()
    keys = []
    inner = claimed

    def noted(where, key):
        keys.append(key)
        return inner(where, key)

    monkeypatch.setattr("lobula.batch.work.claimed", noted)
    clips = find_clips([str(folder / "0.mp4")], out)
    run_batch(clips, asked, Alone(asked))
    (out / "manifest.ndjson").unlink()

    def other_run():
        with inner(work_folder(out), keys[0]):
            taken.set()
            time.sleep(0.3)

    thread = threading.Thread(target=other_run)
    thread.start()
    taken.wait()
    ended = run_batch(clips, asked, Alone(asked))
    thread.join()
    assert ended.rows[0].status == "ok"
    assert len(keys) > 2  # it was asked about more than once


def test_a_request_that_is_refused_on_the_way_is_no_summary(folder, ask, out, monkeypatch):
    monkeypatch.setattr(Stopped, "stop", ParameterError("a worker has other code"))
    with pytest.raises(ParameterError, match=r"^a worker has other code$"):
        batch(folder, ask, out, hands=Stopped)
    assert len(manifest(out)) >= 2
    assert not (out / "summary.json").exists()


class Killing(Alone):
    """Hands that die of a clip."""

    def each(self, clips):
        for clip in clips:
            yield clip, "its worker ended in the middle of it, twice (SIGKILL)"


def test_a_clip_that_nobody_came_back_from_is_in_the_manifest(folder, ask, out):
    ended = batch(folder, ask, out, hands=Killing)
    assert ended.summary.failed == 6
    assert {row["problem"] for row in manifest(out)} == {"its worker ended in the middle of it, twice (SIGKILL)"}


class Nobody(Alone):
    """Hands that note the order in which they were given clips."""

    given: tuple = ()

    def each(self, clips):
        Nobody.given = tuple(clip.path.name for clip in clips)
        return iter(())


def test_the_largest_come_first(tmp_path, ask, out):
    for name, size in (("a", 10), ("b", 1000), ("c", 100)):
        (tmp_path / f"{name}.mp4").write_bytes(bytes(size))
    batch(tmp_path, ask, out, hands=Nobody)
    assert Nobody.given == ("b.mp4", "c.mp4", "a.mp4")


def test_what_killed_runs_left_is_swept(folder, ask, out):
    asked = ask()
    (work_folder(out) / "123").mkdir()
    (work_folder(out) / "123.lock").touch()
    run_batch(find_clips([str(folder)], out), asked, Alone(asked))
    assert list(work_folder(out).iterdir()) == []


def test_a_table_that_cannot_be_written(folder, ask, out):
    asked = ask()
    (out / "clips.csv").mkdir()
    ended = run_batch(find_clips([str(folder)], out), asked, Alone(asked))
    assert isinstance(ended.stop, OutputError)
    assert ended.summary.ok == 4
    assert len(manifest(out)) == 5


def test_names_of_any_bytes_are_in_the_table_as_they_are(tmp_path, ask, out):
    import os

    path = os.fsdecode(bytes(tmp_path) + b"/\xff.mp4")
    os.close(os.open(path, os.O_CREAT))
    batch(tmp_path, ask, out)
    assert b"/\xff.mp4,failed," in (out / "clips.csv").read_bytes()


def test_an_answer_without_a_row_is_no_end(folder, ask, out):
    """Everybody is busy at first; nothing is lost by that."""

    class Busy(Alone):
        rounds = 0

        def each(self, clips):
            Busy.rounds += 1
            return super().each(clips) if Busy.rounds > 1 else ((clip, Answer(None)) for clip in clips)

    assert batch(folder, ask, out, hands=Busy).summary.ok == 4
