"""Outputs never take the place of what is read, and never of each other."""

from __future__ import annotations

import errno
import shutil
from pathlib import Path

import numpy as np
import pytest

from lobula.report.png import write_png


@pytest.fixture
def own(clip, call, tmp_path):
    """A copy of the clip that may be lost, ``q.mp4``, and an image folder, ``shots``, in the working folder."""
    shutil.copy(clip, tmp_path / "q.mp4")
    (tmp_path / "shots").mkdir()
    for i in range(3):
        write_png(tmp_path / "shots" / f"{i}.png", np.full((72, 99), 40 * i, np.uint8))
    return tmp_path


def contents(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "q.mp4", "--annotate", "q.mp4"],
        ["run", "q.mp4", "--annotate", "shots/../q.mp4"],
        ["run", "file://q.mp4", "--annotate", "q.mp4"],
        ["run", "q.mp4", "--annotate", "link.mp4"],
        ["run", "q.mp4", "--annotate", "hard.mp4"],
        ["run", "q.part.mp4", "--annotate", "q.mp4"],
        ["run", "q.mp4", "--trace", "link.csv"],
        ["run", "page/index.html", "--report", "page"],
        ["explain", "q.mp4", "--at", "1", "--out", "link.png"],
        ["explain", "shots", "--at", "0", "--out", "shots/1.png"],
        ["explain", "shots/*.png", "--at", "0", "--out", "shots/1.png"],
        ["explain", "shots/0.png", "--at", "0", "--out", "shots/0.png"],
        ["explain", "shots", "--at", "0", "--mask", "mask.png", "--out", "mask.png"],
        ["plot", "t.csv", "--out", "t.png"],
        ["demo", "--config", "own.toml", "--out", "own.png"],
    ],
)
def test_an_output_that_is_read_is_refused_and_nothing_is_touched(call, own, arguments):
    for name in ("link.mp4", "link.csv", "link.png"):
        (own / name).symlink_to("q.mp4")
    (own / "hard.mp4").hardlink_to(own / "q.mp4")
    shutil.copy(own / "q.mp4", own / "q.part.mp4")
    (own / "page").mkdir()
    shutil.copy(own / "q.mp4", own / "page" / "index.html")
    write_png(own / "mask.png", np.full((72, 99), 255, np.uint8))
    for name, text in (("t", "csv"), ("own", "toml")):
        (own / f"{name}.{text}").write_text("")
        (own / f"{name}.png").symlink_to(f"{name}.{text}")
    before = contents(own)
    done = call(*arguments)
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert "itself: must be another file" in done.err
    assert contents(own) == before


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["run", "q.mp4", "--report", "q.mp4"], "--report q.mp4: q.mp4 is a file, must be a folder"),
        (["run", "q.mp4", "--report", "q.mp4/r"], "--report q.mp4/r: q.mp4 is a file, must be a folder"),
        (["run", "q.mp4", "--annotate", "d.mp4"], "--annotate d.mp4: is a folder, must be a file"),
        (["run", "q.mp4", "--trace", "."], "--trace .: is a folder, must be a file"),
        (["run", "q.mp4", "--trace", "/"], "--trace /: is a folder, must be a file"),
        (["run", "q.mp4", "--report", "/dev/null/r"], "--report /dev/null/r: /dev/null is a file, must be a folder"),
        (["plot", "."], "trace .: is a folder, must be a file"),
        (["plot", "t.csv", "--out", "."], "--out .: is a folder, must be a file"),
        (["demo", "--out", "."], "--out .: must end in .png, .svg, .pdf"),
        (["demo", "--out", "a.gif"], "--out a.gif: must end in .png, .svg, .pdf"),
        (["explain", "q.mp4", "--at", "1", "--out", "a.svg"], "--out a.svg: must end in .png"),
        (["run", "q.mp4", "--report", "r", "--trace", "r/trace.csv"], "is written by --trace too: must be another"),
        (["explain", "q.mp4", "--at", "1", "--out", "no/a.png"], "cannot write no/a.png: no such folder no"),
        (["demo", "--out", "no/a.png"], "cannot write no/a.png: no such folder no"),
        (["stimulus", "flash", "--out", "no/a.mp4"], "cannot write no/a.mp4: no such folder no"),
        (["stimulus", "flash", "--out", "file"], "--out file: file is a file, must be a folder"),
    ],
)
def test_outputs_that_cannot_be(call, own, arguments, says):
    (own / "d.mp4").mkdir()
    (own / "file").write_text("kept")
    done = call(*arguments)
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert says in done.err
    assert (own / "file").read_text() == "kept"


def test_a_report_folder_that_cannot_be_made_refuses_the_run(call, own, monkeypatch):
    def no_room(folder, **_):
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr("pathlib.Path.mkdir", no_room)
    done = call("run", "q.mp4", "--json", "--report", "r")
    assert (done.code, done.err) == (2, "lobula: cannot write r: no permission\n")
    assert [r["status"] for r in done.records] == ["refused"]


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["run", "q.mp4", "--annotate", "/proc/a.mp4"], "/proc/a.mp4"),
        (["run", "q.mp4", "--record", "/proc/a.mp4"], "/proc/a.mp4"),
        (["explain", "q.mp4", "--at", "1", "--out", "/proc/a.png"], "/proc/a.png"),
        (["plot", "t.csv", "--out", "/proc/a.png"], "/proc/a.png"),
        (["demo", "--out", "/proc/a.png"], "/proc/a.png"),
        (["stimulus", "flash", "--out", "/proc/a.mp4"], "/proc/a.mp4"),
        (["arena", "--save", "a.npz", "--save", "/proc/a.npz"], "/proc/a.npz"),
        (["arena", "--save", "/proc/a.mp4"], "/proc/a.mp4"),
        (["arena", "--events", "/proc/e.csv"], "/proc/e.csv"),
        (["arena", "--checkpoint", "/proc/ck"], "/proc/ck"),
        (["track", "q.mp4", "--room", "70x55", "--px-per-cm", "10", "--out", "/proc/t.csv"], "/proc/t.csv"),
        (["track", "--print", "/proc/ids.pdf"], "/proc/ids.pdf"),
    ],
)
@pytest.mark.skipif(not Path("/proc/self").exists(), reason="no folder that nobody may write in")
def test_a_folder_in_which_nothing_can_be_made_is_refused_before_the_work(call, own, monkeypatch, arguments, named):
    def worked(*_, **__):
        raise AssertionError("the work began")

    (own / "t.csv").write_text("")
    for work in ("lobula.runtime.loop.run", "lobula.arena.running.run", "lobula.overhead.track"):
        monkeypatch.setattr(work, worked)
    before = contents(own)
    done = call(*arguments)
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert f"cannot write {named}: no file can be made there" in done.err
    assert contents(own) == before


def test_no_permission_is_said_before_the_work_and_trying_leaves_nothing(call, own, monkeypatch):
    (own / "rod").mkdir()
    assert call("run", "q.mp4", "--annotate", "rod/a.mp4", "--end", "0.2").code == 0
    assert [path.name for path in (own / "rod").iterdir()] == ["a.mp4"]

    def read_only(**_):
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr("tempfile.TemporaryFile", read_only)
    done = call("arena", "--events", "rod/e.csv")
    says = "lobula: cannot write rod/e.csv: no permission: must lie in a folder that files can be made in\n"
    assert (done.code, done.err) == (2, says)
    # the rows of a trace go to the file that is there: no other is made
    (own / "rod" / "t.csv").write_text("")
    assert call("run", "q.mp4", "--trace", "rod/t.csv", "--end", "0.2").code == 0


def test_outputs_beside_the_source_are_fine(call, own):
    done = call("run", "shots", "--report", "shots", "--annotate", "shots/out.mp4", "--trace", "shots/all.csv")
    assert done.code == 0, done.err
    assert call("explain", "shots", "--at", "0", "--out", "shots.png").code == 0


def test_people_are_told_why_and_no_numbers_of_nothing(call, own):
    done = call("run", "q.mp4", "--start", "99")
    assert done.code == 2
    assert "0 frames" not in done.err
    assert done.err.endswith("lobula: q.mp4: no frame from 99 s: must lie inside the source\n")


def test_a_damaged_picture_is_named(call, own):
    (own / "shots" / "1.png").write_text("not a picture")
    done = call("run", "shots", "--json")
    note = "shots/1.png: damaged or not an image: left out"
    assert (done.code, done.err) == (0, f"lobula: {note}\n")
    assert (done.records[-1]["damaged"], done.records[-1]["notes"]) == (1, [note])
