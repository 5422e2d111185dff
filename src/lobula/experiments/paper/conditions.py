"""Trials sorted for the claims: under one condition, seed by seed, what each course did."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from .courses import SPEED_LABELS
from .trials import Trial


class Speed(NamedTuple):
    """One speed and the trials made at it."""

    text: str
    label: str
    reading: str
    trials: Sequence[Trial]

    def of(self, motion: str, angle_deg: float = 0.0) -> list[Trial]:
        """Return the trials of one course, ordered by seed: the same place in two such lists is the same seed."""
        return chosen(self.trials, motion=motion, angle_deg=angle_deg)


def each_speed(trials: Iterable[Trial], labels: Sequence[str] = SPEED_LABELS) -> Iterator[Speed]:
    """Yield the speeds of ``labels`` that the trials were made at, in their order."""
    grouped: dict[tuple[str, str, float], list[Trial]] = {}
    for one in trials:
        if one.label in labels:
            grouped.setdefault((one.reading, one.label, one.speed_cm_s), []).append(one)
    for (reading, label, speed_cm_s), own in grouped.items():
        yield Speed(f"{label} = {speed_cm_s:g} cm/s", label, reading, own)


def chosen(trials: Iterable[Trial], **values: object) -> list[Trial]:
    """Return the trials whose attributes have these values, ordered by seed."""
    found = (t for t in trials if all(getattr(t, name) == value for name, value in values.items()))
    return sorted(found, key=lambda t: t.seed)
