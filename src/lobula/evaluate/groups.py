"""Groups of clips that are alike, dealt into folds: what is chosen on some of them is scored on the others."""

from __future__ import annotations

from collections.abc import Sequence

from ..errors import ParameterError
from .labels import Label

LEAST_GROUPS = 2


def folds(labels: Sequence[Label], most: int, where: str) -> list[tuple[str, ...]]:
    """Return the groups of ``labels`` dealt into at most ``most`` folds, never a group into two.

    Groups with many collisions are dealt first, then those with many clips, then by name; each goes to the fold that
    has the fewest collisions by then, the fewest clips, the lowest number. So the same labels give the same folds.

    Raises
    ------
    ParameterError : a clip without a group, a single group, or collisions in a single one
    """
    homeless = [label.file for label in labels if not label.group]
    if homeless:
        raise ParameterError(
            f"{where}: {homeless[0]} has no group ({len(homeless)} of {len(labels)} clips): must have a column group "
            "that names the camera, day or source of each clip"
        )
    names = sorted({label.group for label in labels})
    if len(names) < LEAST_GROUPS:
        raise ParameterError(
            f"{where}: all clips are of one group, {names[0]}: must be of {LEAST_GROUPS} or more, to score what is "
            "chosen on some of them on the others"
        )
    sizes = {name: _size(labels, name) for name in names}
    with_collision = [name for name in names if sizes[name][0]]
    if len(with_collision) < LEAST_GROUPS:
        there = f"only in the group {with_collision[0]}" if with_collision else "in no clip"
        raise ParameterError(f"{where}: a collision {there}: must be in {LEAST_GROUPS} groups or more")
    dealt: list[list[str]] = [[] for _ in range(min(most, len(names)))]
    for name in sorted(names, key=lambda name: (-sizes[name][0], -sizes[name][1], name)):
        emptiest = min(dealt, key=lambda fold: tuple(sum(sizes[other][i] for other in fold) for i in (0, 1)))
        emptiest.append(name)
    return [tuple(sorted(fold)) for fold in dealt]


def _size(labels: Sequence[Label], group: str) -> tuple[int, int]:
    """Collisions and clips of a group."""
    own = [label for label in labels if label.group == group]
    return sum(label.collision for label in own), len(own)
