"""The label file: what is read, and one clear line for what is wrong."""

from __future__ import annotations

import pytest

from lobula.errors import ParameterError
from lobula.evaluate.labels import read_labels

HEADING = "file,collision,contact_frame,contact_uncertainty_frames,event,confidence\n"


def labels(tmp_path, text, heading=HEADING):
    path = tmp_path / "labels.csv"
    path.write_text(heading + text, encoding="utf-8")
    return read_labels(path)


def test_rows_are_read(tmp_path):
    crash, near, low = labels(
        tmp_path,
        'a.mp4,1,84,2,"COLLISION rear-end: van, brakes",high\n'
        'b.mp4,0,,,"NEAR MISS (probable): bear",medium\n'
        "c.mp4,0,,,APPROACH slow,low\n",
    )
    assert (crash.collision, crash.contact_frame, crash.uncertainty_frames) == (True, 84, 2)
    assert (crash.kind, crash.apart) == ("COLLISION rear-end", "")
    assert (near.collision, near.kind, near.apart) == (False, "NEAR MISS", "near miss")
    assert (low.kind, low.apart) == ("APPROACH slow", "low confidence")


def test_a_class_column_goes_before_the_event(tmp_path):
    heading = "class,file,collision,contact_frame,contact_uncertainty_frames,event,extra\n"
    (label,) = labels(tmp_path, "cars,a.mp4,0,,,STATIC: x,1\n", heading)
    assert label.kind == "cars"


def test_event_and_class_may_be_missing(tmp_path):
    heading = "file,collision,contact_frame,contact_uncertainty_frames\n"
    hit, miss = labels(tmp_path, "a.mp4,yes,5,0\nb.mp4,no,,\n", heading)
    assert (hit.kind, miss.kind) == ("COLLISION", "NO COLLISION")


@pytest.mark.parametrize(
    ("row", "says"),
    [
        (",0,,,,", "line 2: no file"),
        ("a,2,,,,", "line 2: collision = '2': must be 1 or 0"),
        ("a,1,,,,", "line 2: contact_frame = '': must be a whole number"),
        ("a,1,3.5,1,,", "line 2: contact_frame = '3.5': must be a whole number"),
        ("a,1,35,,,", "line 2: contact_uncertainty_frames = '': must be"),
        ("a,0,35,,,", "line 2: contact_frame = '35': must be empty where collision is 0"),
        ("a,0,,,,\na,0,,,,", "a is there twice"),
        ("", "no rows"),
    ],
)
def test_what_is_wrong_is_said(tmp_path, row, says):
    with pytest.raises(ParameterError, match=says):
        labels(tmp_path, row + "\n")


def test_a_missing_column_is_named(tmp_path):
    with pytest.raises(ParameterError, match="lacks the column contact_frame"):
        labels(tmp_path, "a,1,2\n", "file,collision,contact_uncertainty_frames\n")


def test_without_a_collision_no_contact_is_needed(tmp_path):
    (label,) = labels(tmp_path, "a.mp4,0\n", "file,collision\n")
    assert (label.collision, label.contact_frame) == (False, None)


@pytest.mark.parametrize(("text", "says"), [
    ("", "is empty"),
    ("file;collision\na.mp4;0\n", "columns are parted by ';': must be commas"),
])  # fmt: skip
def test_files_that_are_no_such_table(tmp_path, text, says):
    with pytest.raises(ParameterError, match=says):
        labels(tmp_path, text, "")


def test_no_such_file(tmp_path):
    with pytest.raises(ParameterError, match=r"nowhere\.csv: no such file"):
        read_labels(tmp_path / "nowhere.csv")
