"""Candidates of which one is chosen on clips that are not scored by it: one group of clips is left out at a time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from .groups import folds
from .labels import Label
from .scoring import ClipScore
from .summary import skill

Candidates = Mapping[str, Mapping[str, ClipScore]]
"""By candidate, such as a threshold, and by clip."""


class Chosen(NamedTuple):
    """The score of each clip by a candidate that was chosen without its group, and which one that was, by group."""

    scores: Sequence[ClipScore]
    candidates: Mapping[str, str]


def choose_apart(labels: Sequence[Label], candidates: Candidates, where: str) -> Chosen:
    """Score each group of clips by the candidate that has the most ``skill`` on all the other groups.

    Of equal ones the middle one in their order is taken.

    Raises
    ------
    ParameterError : clips without groups, a single group, collisions in a single one
    """
    scores: list[ClipScore] = []
    chosen = {}
    for (group,) in folds(labels, len(labels), where):
        others = [label.file for label in labels if label.group != group]
        skills = [skill([by_clip[file] for file in others]) for by_clip in candidates.values()]
        best = [place for place, value in enumerate(skills) if value >= max(skills) - 1e-12]
        name = list(candidates)[best[len(best) // 2]]
        chosen[group] = name
        scores += [candidates[name][label.file] for label in labels if label.group == group]
    return Chosen(scores, chosen)
