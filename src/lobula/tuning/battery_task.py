"""The synthetic battery as films, and the fixed way in which a third of them is held out."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from ..evaluate.labels import Label
from ..stimuli.battery import Case, battery
from .films import save_film
from .split import Split
from .task import FilmTask

RATE_HZ = 30.0
EVERY, FIRST = 3, 1
"""Of the variations of a kind, in the battery's order, each third is held out, beginning with the second."""

HOW = "of each kind of movie each third variation is held out, beginning with the second; mirror twins stay together"

_SIDES = {"translating_right": "translating", "translating_left": "translating"}


def battery_cases() -> Iterator[Case]:
    """Yield the movies on which an alarm is clearly right or clearly wrong.

    Approaches of dark objects, head-on or at an angle, must alarm; all others must not. Bright objects that come or
    recede are left out: LGMD-2 is blind to the ones and takes the others for dark ones that come.
    """
    for case in battery():
        if case.expectation.kind not in ("looming", "receding") or case.expectation.dark:
            yield case


def family_of(case: Case) -> tuple[str, str]:
    """Return the kind of a movie and its variation; what differs only in left and right is the same."""
    kind = case.expectation.kind
    variation = case.name.removeprefix(f"{kind}-")
    for side in ("from_left-", "from_right-"):
        variation = variation.removeprefix(side)
    return _SIDES.get(kind, kind), variation


def battery_split(cases: Iterable[Case]) -> Split:
    """Return which movies are searched on and which are held out, by name; every kind is in both parts."""
    variations: dict[str, dict[str, list[str]]] = {}
    for case in cases:
        kind, variation = family_of(case)
        variations.setdefault(kind, {}).setdefault(variation, []).append(case.name)
    train: list[str] = []
    held_out: list[str] = []
    for of_kind in variations.values():
        for place, names in enumerate(of_kind.values()):
            (held_out if place % EVERY == FIRST else train).extend(names)
    return Split(tuple(train), tuple(held_out))


def battery_label(case: Case, contact_s: float | None) -> Label:
    """Return the label of a movie at 30 Hz; contact is in the frame that shows the last moment before it."""
    contact_frame = None if contact_s is None else math.floor(contact_s * RATE_HZ + 1e-6)
    return Label(file=case.name, contact_frame=contact_frame, uncertainty_frames=0, kind=family_of(case)[0])


def battery_task(
    folder: Path, cases: Iterable[Case] | None = None, advance: Callable[[], None] | None = None
) -> FilmTask:
    """Make the movies in ``folder`` and return the task; ``advance`` is called for each.

    Raises
    ------
    OutputError : a movie cannot be written
    """
    chosen = list(battery_cases() if cases is None else cases)
    films = {}
    for number, case in enumerate(chosen):
        movie = case.movie(rate_hz=RATE_HZ)
        label = battery_label(case, movie.contact_s)
        films[case.name] = save_film(folder / f"{number:04d}.raw", label, movie.frames())
        if advance is not None:
            advance()
    return FilmTask(films, {"battery": battery_split(chosen)}, {"on": "battery", "held_out": HOW, "rate_hz": RATE_HZ})
