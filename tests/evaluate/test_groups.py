"""Groups of clips dealt into folds."""

from __future__ import annotations

import pytest

from lobula.errors import ParameterError
from lobula.evaluate.groups import folds
from lobula.evaluate.labels import Label, read_labels


def clips(**groups):
    """Clips by group: a letter each, x for a collision, o for none."""
    return [
        Label(file=f"{group}{i}", contact_frame=9 if c == "x" else None, uncertainty_frames=0, kind="k", group=group)
        for group, marks in groups.items()
        for i, c in enumerate(marks)
    ]


def test_groups_with_many_collisions_are_dealt_first():
    # a: 3 collisions -> fold 1; b: 2 -> fold 2; c: 1 -> fold 2 (2 < 3); then collisions are 3 and 3: d, 3 clips, goes
    # to the fold with fewer clips (3 against 3: the first); e to the other
    labels = clips(e="oo", d="ooo", c="x", b="xx", a="xxx")
    assert folds(labels, 2, "labels") == [("a", "d"), ("b", "c", "e")]


def test_as_many_folds_as_groups_leaves_one_out_each_time():
    assert folds(clips(a="x", b="x", c="o"), 10, "labels") == [("a",), ("b",), ("c",)]


@pytest.mark.parametrize(
    ("labels", "says"),
    [
        (clips(a="xo", b="x") + clips(**{"": "o"}), "labels: 0 has no group (1 of 4 clips): must have a column group"),
        (clips(a="xo"), "labels: all clips are of one group, a: must be of 2 or more"),
        (clips(a="xx", b="oo"), "labels: a collision only in the group a: must be in 2 groups or more"),
        (clips(a="oo", b="oo"), "labels: a collision in no clip: must be in 2 groups or more"),
    ],
)
def test_what_cannot_be_dealt(labels, says):
    with pytest.raises(ParameterError) as refused:
        folds(labels, 5, "labels")
    assert says in str(refused.value)


def test_group_and_split_are_read(tmp_path):
    path = tmp_path / "labels.csv"
    path.write_text("file,collision,group,split\na.mp4,0, front ,test\nb.mp4,0,,\n")
    first, second = read_labels(path)
    assert (first.group, first.split) == ("front", "test")
    assert (second.group, second.split) == ("", "")
