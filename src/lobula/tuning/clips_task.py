"""Labelled clips as films, and the folds over which they are cross-validated."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from ..errors import ParameterError
from ..evaluate.groups import folds
from ..evaluate.labels import Label, read_labels
from ..runtime.opening import open as open_frames
from .films import save_film
from .split import Split, Splits
from .task import FilmTask

MOST_FOLDS = 5
FINAL = "all groups"

TEST = "test"
"""Rows of this ``split`` are kept from every search."""

HOW = "cross-validation: each group of clips is scored by settings chosen without it"
NOT_HELD_OUT = "nothing: the score is of the very clips that were searched on"


def searched(labels: Sequence[Label]) -> list[Label]:
    """Return those labels that count in the headline of ``lobula evaluate`` and are not marked as test."""
    return [label for label in labels if not label.apart and label.split.lower() != TEST]


def clip_splits(labels: Sequence[Label], where: str) -> Splits:
    """Return the searches: over all clips, which gives the settings, and without each fold, which give the score.

    Raises
    ------
    ParameterError : clips without groups, fewer than two groups, collisions in only one
    """
    splits = {FINAL: Split(tuple(label.file for label in labels))}
    for number, groups in enumerate(folds(labels, MOST_FOLDS, where), 1):
        inside = {label.file for label in labels if label.group in groups}
        splits[f"without fold {number} ({', '.join(groups)})"] = Split(
            tuple(label.file for label in labels if label.file not in inside),
            tuple(label.file for label in labels if label.file in inside),
        )
    return splits


def clips_task(
    labels_path: Path,
    clips: Path,
    folder: Path,
    *,
    hold_out: bool = True,
    advance: Callable[[], None] | None = None,
    **view: Any,
) -> FilmTask:
    """Decode the clips into ``folder`` and return the task; ``advance`` is called for each.

    ``hold_out`` false: one search over all clips, and no held-out score. ``view`` goes to ``lobula.open``.

    Raises
    ------
    ParameterError : labels that are none, without a clip to search on, or that cannot be cross-validated
    FrameSourceError : a clip cannot be read: settings chosen on a part of them would be others
    OutputError : the pictures cannot be written
    """
    where = f"labels {labels_path}"
    there = read_labels(labels_path)
    labels = searched(there)
    if not labels:
        raise ParameterError(f"{where}: no clip to search on: all of them are left out")
    splits = clip_splits(labels, where) if hold_out else {FINAL: Split(tuple(label.file for label in labels))}
    films = {}
    for number, label in enumerate(labels):
        with open_frames(clips / label.file, **view) as frames:
            films[label.file] = save_film(folder / f"{number:04d}.raw", label, frames)
        if advance is not None:
            advance()
    about = {
        "on": "clips",
        "labels": str(labels_path),
        "clips": len(labels),
        "left_out": [label.file for label in there if label not in labels],
        "held_out": HOW if hold_out else NOT_HELD_OUT,
        **view,
    }
    return FilmTask(films, splits, about)
