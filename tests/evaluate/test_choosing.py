"""No clip is scored by what was chosen on its group."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.errors import ParameterError
from lobula.evaluate.choosing import choose_apart
from lobula.evaluate.labels import Label
from lobula.evaluate.scoring import ClipScore
from lobula.evaluate.summary import skill

GROUPS = ("a", "b", "c")
LABELS = [
    Label(file=f"{group}{i}", contact_frame=9 if i == 0 else None, uncertainty_frames=0, kind="k", group=group)
    for group in GROUPS
    for i in range(2)
]


def scored(label, hit, false_alarms):
    return ClipScore(
        label=label, frames=90, alarms=(), lead_s=1.0 if hit and label.collision else None,
        false_alarms=0 if label.collision else false_alarms, late=0, footage_s=0.0 if label.collision else 60.0,
        window_s=2.0 if label.collision else 0.0,
    )  # fmt: skip


def table(outcomes):
    """Scores by candidate and clip from, for each candidate and group, whether it hits and how often it is wrong."""
    return {
        name: {label.file: scored(label, *by_group[label.group]) for label in LABELS}
        for name, by_group in outcomes.items()
    }


outcome = st.tuples(st.booleans(), st.integers(0, 20))
outcomes = st.fixed_dictionaries({name: st.fixed_dictionaries(dict.fromkeys(GROUPS, outcome)) for name in "wxyz"})


@settings(deadline=None, max_examples=50)
@given(outcomes, st.sampled_from(GROUPS), st.fixed_dictionaries(dict.fromkeys("wxyz", outcome)))
def test_what_happens_in_a_group_does_not_move_the_choice_for_it(before, group, other):
    after = {name: {**by_group, group: other[name]} for name, by_group in before.items()}
    chosen = [choose_apart(LABELS, table(some), "labels").candidates[group] for some in (before, after)]
    assert chosen[0] == chosen[1]


@settings(deadline=None, max_examples=50)
@given(outcomes)
def test_the_choice_has_the_most_skill_on_the_other_groups(some):
    candidates = table(some)
    chosen = choose_apart(LABELS, candidates, "labels")
    for group, name in chosen.candidates.items():
        others = [label.file for label in LABELS if label.group != group]
        skills = {n: skill([by_clip[file] for file in others]) for n, by_clip in candidates.items()}
        assert skills[name] == pytest.approx(max(skills.values()))
    by_file = {score.label.file: score for score in chosen.scores}
    assert len(chosen.scores) == len(LABELS)
    assert all(by_file[label.file] == candidates[chosen.candidates[label.group]][label.file] for label in LABELS)


def test_a_case_by_hand():
    good, bad = (True, 0), (False, 9)
    some = {"x": {"a": bad, "b": good, "c": good}, "y": {"a": good, "b": bad, "c": good}}
    # without a: x hits b and c; without b: y hits a and c; without c: both hit one of two and alarm alike: the second
    assert choose_apart(LABELS, table(some), "labels").candidates == {"a": "x", "b": "y", "c": "y"}


def test_of_equal_ones_the_middle_one():
    same = dict.fromkeys(GROUPS, (True, 0))
    assert set(choose_apart(LABELS, table(dict.fromkeys("wxyz", same)), "labels").candidates.values()) == {"y"}


def test_one_group_is_refused():
    with pytest.raises(ParameterError, match="all clips are of one group"):
        choose_apart(LABELS[:2], table({"x": dict.fromkeys(GROUPS, (True, 0))}), "labels")
