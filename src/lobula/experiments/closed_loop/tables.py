"""Counts per seed as a table, and contrasts of such tables: a number with its bootstrap interval over seeds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arena.scoring import Score, total
from ...intervals import bootstrap
from .jobs import Done

Sums = NDArray[np.float64]
"""(N, K): the ``COLUMNS``, summed over seeds."""

COLUMNS = (
    "CR", "CP", "AA", "AT", "AP", "spurious", "robot_hours", "CP_deg", "AP_deg", "CP_active", "AP_active", "CP_known",
    "AP_known",
)  # fmt: skip
"""Counts; hours of all robots together; sums of the incidence angles at the wall; wall events with an LPTC above its
threshold, and those in which its potential is known."""

LEAST_SEEDS = 5
"""With fewer seeds a bootstrap over them says nothing, so no interval is given."""

LPTC_ACTIVE = 0.2
"""Potential from which an LPTC spikes."""


class Group(NamedTuple):
    """The results of one model at one density, a row of ``table`` (S, K) for each seed."""

    results: Sequence[Done]
    table: Sums

    @property
    def score(self) -> Score:
        """The score of all seeds together."""
        return total(done.score for done in self.results)


class Contrast(NamedTuple):
    """A number that is above 0 where a claim is right, under one condition, and its 95 % interval."""

    condition: str
    value: float
    low: float
    high: float
    numbers: str

    @property
    def verdict(self) -> str:
        """Yes or no, where the interval lies on one side of 0; else unclear."""
        if self.low > 0:
            return "yes"
        return "no" if self.high < 0 else "unclear"


def group(results: Iterable[Done]) -> Group:
    """Return results of the same model and density as a table, ordered by seed."""
    ordered = sorted(results, key=lambda done: done.job.seed)
    return Group(ordered, np.array([_row(done) for done in ordered], np.float64))


def column(name: str) -> Callable[[Sums], NDArray[np.float64]]:
    """Return a function that takes sums to one of the ``COLUMNS``."""
    place = COLUMNS.index(name)
    return lambda sums: sums[:, place]


def sr1(sums: Sums) -> NDArray[np.float64]:
    """AP / (AP + CP), in percent."""
    ap, cp = column("AP")(sums), column("CP")(sums)
    return 100 * ap / (ap + cp)


def sr2(sums: Sums) -> NDArray[np.float64]:
    """AA / (AA + AT + CR), in percent."""
    aa, at, cr = (column(name)(sums) for name in ("AA", "AT", "CR"))
    return 100 * aa / (aa + at + cr)


def per_hour(name: str) -> Callable[[Sums], NDArray[np.float64]]:
    """Return a function that takes sums to how often ``name`` came in an hour of one robot."""
    return lambda sums: column(name)(sums) / column("robot_hours")(sums)


def mean_of(numerator: str, denominator: str) -> Callable[[Sums], NDArray[np.float64]]:
    """Return a function that takes sums to the quotient of two columns."""
    return lambda sums: column(numerator)(sums) / column(denominator)(sums)


def contrast(
    condition: str, groups: Sequence[Group], f: Callable[..., NDArray[np.float64]], unit: str, digits: int = 1
) -> Contrast:
    """Return ``f`` of the sums of ``groups``, (N, K) each, and its interval; seeds are drawn for all groups together.

    Groups of the same seeds are thereby paired.
    """
    tables = [one.table for one in groups]
    width = len(COLUMNS)

    def statistic(sums: Sums) -> NDArray[np.float64]:
        return f(*(sums[:, width * n : width * (n + 1)] for n in range(len(tables))))

    whole = np.hstack(tables)
    with np.errstate(divide="ignore", invalid="ignore"):
        value = float(statistic(whole.sum(axis=0, keepdims=True))[0])
    low, high = bootstrap(whole, statistic) if len(whole) >= LEAST_SEEDS else (math.nan, math.nan)
    text = "nothing to count" if value != value else f"{value:+.{digits}f} {unit} {interval_text(low, high, digits)}"
    return Contrast(condition, value, low, high, text.strip())


def interval_text(low: float, high: float, digits: int = 1) -> str:
    """Return ``(1.2 to 3.4)``; that there is none where there are too few seeds."""
    return "(no interval)" if low != low else f"({low:.{digits}f} to {high:.{digits}f})"


def _row(done: Done) -> list[float]:
    events, score = done.events, done.score
    row: list[float] = [score.cr, score.cp, score.aa, score.at, score.ap, score.spurious, score.robot_minutes / 60]
    at_wall = [events[events["kind"] == kind] for kind in ("CP", "AP")]
    strongest = [np.maximum(some["lptc_r"], -some["lptc_l"]) for some in at_wall]
    row += [float(np.nansum(some["incidence_deg"])) for some in at_wall]
    row += [int((potentials >= LPTC_ACTIVE).sum()) for potentials in strongest]
    return [*row, *(int((~np.isnan(potentials)).sum()) for potentials in strongest)]
