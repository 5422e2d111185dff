"""One clip at a time: the numbers are those of `lobula.Network`, and nothing is done twice or kept half."""

from __future__ import annotations

import json
import os
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import lobula
from lobula.batch import work as module
from lobula.batch.clips import Clip
from lobula.batch.lines import Lines
from lobula.batch.manifest import Manifest
from lobula.batch.work import Answer, Desk
from lobula.errors import OutputError, ParameterError
from lobula.report.grey_clip import write_grey_clip
from lobula.report.trace_file import read_trace

from .conftest import write_clip


def clip_at(path):
    return Clip(f"shown/{path.name}", path)


@pytest.fixture
def clip(tmp_path):
    return clip_at(write_clip(tmp_path / "clips" / "a.mp4"))


@pytest.fixture(scope="module")
def looming():
    return lobula.stimuli.looming(scene="arena", speed_cm_s=12.0)


def rows(out):
    return Lines(out / "manifest.ndjson").new()


def leftovers(out):
    return list((out / ".batch" / "work").iterdir())


def test_the_numbers_are_those_of_the_network(ask, out, tmp_path, looming):
    path = tmp_path / "near.mp4"
    write_grey_clip(path, looming.images, looming.times_s, looming.rate_hz)
    row = Desk(ask()).do(clip_at(path)).row
    net = lobula.Network()
    with lobula.open(path) as frames:
        readings = [net.step(frame) for frame in frames]
    trace = read_trace(out / row.trace)
    assert trace["lgmd1"].tolist() == [r.lgmd1 for r in readings]
    assert trace["collision"].tolist() == [r.collision for r in readings]
    first_s = next(r.time_s for r in readings if r.collision)
    assert (row.status, row.frames, row.damaged, row.collisions) == ("ok", 91, 0, 1)
    assert row.alarms_s == (pytest.approx(first_s, abs=1e-6),)
    assert row.duration_s == pytest.approx(91 / 30, abs=1e-4)
    events = [json.loads(line) for line in (out / row.events).read_text().splitlines()]
    assert [e["type"] for e in events] == ["header", "state", "state", "collision", "collision", "summary"]
    assert (events[0]["source"], events[-1]["frames"]) == ("shown/near.mp4", 91)


def test_a_clip_after_another_is_as_if_it_were_the_first(ask, tmp_path):
    first, second = (clip_at(write_clip(tmp_path / f"{seed}.mp4", seed)) for seed in (1, 2))
    desk = Desk(ask())
    desk.do(first)
    after = desk.do(second).row
    asked = replace(ask(), out=tmp_path / "other")
    shutil.copytree(tmp_path / "out" / ".batch", tmp_path / "other" / ".batch")
    (tmp_path / "other" / asked.settings).mkdir()
    alone = Desk(asked).do(second).row
    traces = [read_trace(folder / row.trace) for folder, row in ((tmp_path / "out", after), (asked.out, alone))]
    assert traces[0].tobytes() == traces[1].tobytes()


def test_what_is_done_is_not_done_again(ask, out, clip):
    first = Desk(ask()).do(clip)
    assert first.fresh
    assert Desk(ask()).do(clip) == Answer(first.row, fresh=False)
    assert len(rows(out)) == 1
    assert leftovers(out) == []


def test_a_moved_file_and_a_copy_are_the_same_clip(ask, out, clip, tmp_path):
    desk = Desk(ask())
    first = desk.do(clip).row
    moved = clip_at(clip.path.rename(tmp_path / "b.mp4"))
    copied = clip_at(Path(shutil.copy(moved.path, tmp_path / "c.mp4")))
    assert desk.do(moved) == Answer(replace(first, file="shown/b.mp4"))
    assert desk.do(copied) == Answer(replace(first, file="shown/c.mp4"))
    assert len(rows(out)) == 1


def test_a_changed_file_is_another_clip(ask, out, clip):
    desk = Desk(ask())
    desk.do(clip)
    write_clip(clip.path, seed=1)
    assert desk.do(clip).fresh
    assert len({row["content"] for row in rows(out)}) == 2


def test_other_settings_lie_beside(ask, out, clip):
    first = Desk(ask()).do(clip).row
    second = Desk(ask(params=lobula.preset("published"), preset="published")).do(clip)
    assert second.fresh
    assert second.row.settings != first.settings
    assert (out / first.trace).is_file()
    assert (out / second.row.trace).is_file()
    assert not Desk(ask()).do(clip).fresh


def test_other_code_does_it_again(ask, out, clip, monkeypatch):
    Desk(ask()).do(clip)
    monkeypatch.setattr(module, "source_hash", lambda *parts: "0" * 12)
    monkeypatch.setattr("lobula.batch.request.source_hash", lambda *parts: "0" * 12)
    assert Desk(ask()).do(clip).fresh


@pytest.mark.parametrize(
    ("first", "then", "again"),
    [
        ({"trace": None}, {"trace": ".csv"}, True),
        ({"trace": ".csv"}, {"trace": None}, False),
        ({"trace": ".csv"}, {"trace": ".npz"}, True),
        ({}, {"annotate": True}, True),
        ({"annotate": True}, {}, False),
    ],
)
def test_another_output_is_made_and_one_that_is_there_is_not(ask, out, clip, first, then, again):
    before = Desk(ask(**first)).do(clip).row
    after = Desk(ask(**then)).do(clip)
    assert after.fresh is again
    for name in (before.events, before.trace, before.annotated, after.row.trace, after.row.annotated):
        assert not name or (out / name).stat().st_size > 0
    assert not Desk(ask(**first)).do(clip).fresh  # what was there first still holds


def test_the_outputs(ask, out, clip):
    row = Desk(ask(trace=".npz", annotate=True)).do(clip).row
    stem = f"{row.settings}/a-{row.content[:12]}"
    assert (row.events, row.trace, row.annotated) == (f"{stem}.events.ndjson", f"{stem}.npz", f"{stem}.mp4")
    assert len(read_trace(out / row.trace)) == 20
    with lobula.open(out / row.annotated) as video:
        assert len(list(video)) == 20
    assert sorted(p.name for p in (out / row.settings).iterdir()) == sorted(
        ["settings.json", *(Path(name).name for name in (row.events, row.trace, row.annotated))]
    )


def test_an_output_that_was_deleted_is_made_again(ask, out, clip):
    desk = Desk(ask())
    row = desk.do(clip).row
    (out / row.trace).unlink()
    assert desk.do(clip).fresh
    assert (out / row.trace).is_file()


def test_a_folder_of_images(ask, out, tmp_path):
    from lobula.report.png import write_png

    (tmp_path / "walk").mkdir()
    for i in range(12):
        write_png(tmp_path / "walk" / f"{i}.png", np.full((72, 99), 20 * i, np.uint8))
    row = Desk(ask()).do(clip_at(tmp_path / "walk")).row
    assert (row.status, row.frames) == ("ok", 12)
    assert row.trace.startswith(f"{row.settings}/walk-")


def damaged(path, kind):
    if kind == "empty":
        path.write_bytes(b"")
    elif kind == "text":
        path.write_text("nothing to see\n" * 100)
    elif kind == "cut before its index":
        whole = write_clip(path).read_bytes()
        path.write_bytes(whole[: len(whole) // 2])
    return clip_at(path)


@pytest.mark.parametrize(
    ("kind", "problem"),
    [
        ("empty", "is empty: must be a file that FFmpeg decodes"),
        ("text", "not a video: must be"),
        ("cut before its index", "not a video: must be a file that FFmpeg decodes, not cut off before its index"),
        ("gone", "no such file or folder"),
    ],
)
def test_a_clip_that_fails_is_an_answer_and_is_tried_again(ask, out, tmp_path, kind, problem):
    bad = damaged(tmp_path / "bad.mp4", kind)
    desk = Desk(ask())
    for _ in range(2):
        answer = desk.do(bad)
        assert (answer.fresh, answer.row.status, answer.row.frames) == (True, "failed", 0)
        assert answer.row.problem.startswith(problem)
        assert str(tmp_path) not in answer.row.problem
        assert (answer.row.events, answer.row.trace) == ("", "")
    assert [row["status"] for row in rows(out)] == ["failed", "failed"]
    assert [p.name for p in (out / answer.row.settings).iterdir()] == ["settings.json"]


def test_a_clip_that_breaks_off_keeps_what_was_read(ask, out, tmp_path):
    path = tmp_path / "torn.mkv"
    rng = np.random.default_rng(0)
    write_grey_clip(path, rng.integers(0, 255, (40, 72, 99), np.uint8), [i / 30 for i in range(40)], 30)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2] + bytes(len(whole) // 2))  # a bad sector up to the end
    row = Desk(ask()).do(clip_at(path)).row
    with lobula.open(path) as frames, pytest.raises(lobula.LobulaError) as caught:
        list(frames)
    assert row.status == "failed"
    assert row.problem == str(caught.value).removeprefix(f"{path}: ")
    assert 10 < row.frames < 40
    assert len(read_trace(out / row.trace)) == row.frames
    assert json.loads((out / row.events).read_text().splitlines()[-1])["status"] == "source_failed"


def test_a_clip_that_cannot_have_the_view_fails_alone(ask, clip):
    row = Desk(ask(roi=(0, 0, 640, 480))).do(clip).row
    assert row.status == "failed"
    assert row.problem.startswith("roi = (0, 0, 640, 480): must be")


def test_a_clip_whose_problem_is_known(ask, tmp_path):
    row = Desk(ask()).do(Clip("x", tmp_path / "x", "line 3 names it")).row
    assert (row.status, row.problem, row.content) == ("failed", "line 3 names it", "")


def test_a_clip_that_grows_meanwhile_is_not_called_done(ask, out, clip, monkeypatch):
    inner = module.run_loop

    def slow(*arguments, **more):
        with clip.path.open("ab") as file:
            file.write(b"more")
        return inner(*arguments, **more)

    monkeypatch.setattr(module, "run_loop", slow)
    row = Desk(ask()).do(clip).row
    assert (row.status, row.problem[:32]) == ("failed", "was changed while it was read: m")
    assert row.trace == ""
    monkeypatch.undo()
    assert Desk(ask()).do(clip).row.status == "ok"


def test_a_fault_of_our_own_fails_one_clip(ask, out, clip, monkeypatch):
    def broken(*arguments, **more):
        return 1 / 0

    monkeypatch.setattr(module, "run_loop", broken)
    row = Desk(ask()).do(clip).row
    assert row.status == "failed"
    assert row.problem.startswith(
        "a fault of lobula's own, please report it: ZeroDivisionError('division by zero') in "
    )
    assert leftovers(out) == []


def test_while_somebody_else_is_at_it_there_is_no_row(ask, clip, monkeypatch):
    asked, met = ask(), []
    inner = module.run_loop

    def meet(*arguments, **more):
        met.append(Desk(asked).do(clip))
        return inner(*arguments, **more)

    monkeypatch.setattr(module, "run_loop", meet)
    assert Desk(asked).do(clip).row.status == "ok"
    assert met == [Answer(None)]


def test_an_output_that_fails_ends_it_and_leaves_nothing(ask, out, clip, monkeypatch):
    def full(self, index, reading, picture):
        raise OutputError("cannot write trace.csv: the disk is full; the rows are in x")

    monkeypatch.setattr("lobula.report.trace.TraceWriter.frame", full)
    with pytest.raises(OutputError, match=r"^cannot write trace.csv: the disk is full$"):
        Desk(ask()).do(clip)
    assert rows(out) == []
    assert leftovers(out) == []


def test_long_and_odd_names(ask, out, tmp_path):
    path = write_clip(tmp_path / "plain.mp4")
    names = [b"n" * 250 + b".mp4", "ä".encode() * 120 + b".mp4", b"two\nlines.mp4", b"\xff\xfe.mp4"]
    desk = Desk(ask())
    for seed, name in enumerate(names, 1):
        target = Path(os.fsdecode(bytes(tmp_path) + b"/" + name))
        shutil.copy(write_clip(path, seed), target)
        row = desk.do(clip_at(target)).row
        assert row.status == "ok", row.problem
        assert (out / row.trace).is_file()
        assert row.trace.isprintable()
    assert len(rows(out)) == 4


def test_the_manifest_is_readable_by_anyone(ask, out, clip):
    Desk(ask()).do(clip)
    (row,) = rows(out)
    assert Manifest(out).find((row["content"], row["settings"], row["code"]), ()).file == "shown/a.mp4"


def test_other_code_or_no_folder_is_refused(ask, out, monkeypatch):
    asked = ask()
    with pytest.raises(OutputError, match=r"is not there for a worker: must be a folder that all of them share$"):
        Desk(replace(asked, out=out / "elsewhere"))
    with pytest.raises(
        ParameterError, match=r"^a worker has other code of lobula \(.{12}, not 123\): must be the same$"
    ):
        Desk(replace(asked, code="123"))
