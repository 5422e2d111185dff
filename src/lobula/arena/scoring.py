"""Events as numbers: counts, success rates, what was unseen, how far it drove; by angle, and over time."""

from __future__ import annotations

import functools
import math
import operator
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from ..intervals import Interval, garwood, wilson

INCIDENCE_EDGES_DEG = (0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0)


@dataclass(frozen=True, kw_only=True)
class Tally:
    """How often each kind of event came, and the rates made of it.

        SR1 = AP / (AP + CP),  SR2 = AA / (AA + AT + CR)

    A rate is NaN where there was nothing to count; its interval is Wilson's, at 95 %. Source: paper Table I.
    """

    cr: int = 0
    cp: int = 0
    aa: int = 0
    at: int = 0
    ap: int = 0
    spurious: int = 0

    def __add__(self, other: Self) -> Self:
        return type(self)(**{f.name: getattr(self, f.name) + getattr(other, f.name) for f in fields(self)})

    @property
    def sr1(self) -> float:
        """Share of the periphery that was avoided."""
        return _share(self.ap, self.ap + self.cp)

    @property
    def sr2(self) -> float:
        """Share of approaching robots avoided, of all encounters with robots that ended in a turn or a contact."""
        return _share(self.aa, self.aa + self.at + self.cr)

    @property
    def sr1_interval(self) -> Interval:
        """Wilson interval of ``sr1``."""
        return wilson(self.ap, self.ap + self.cp)

    @property
    def sr2_interval(self) -> Interval:
        """Wilson interval of ``sr2``."""
        return wilson(self.aa, self.aa + self.at + self.cr)

    def as_dict(self) -> dict[str, Any]:
        """Return a flat dictionary for JSON and CSV; None where a rate has nothing to divide by."""
        counted = {"CR": self.cr, "CP": self.cp, "AA": self.aa, "AT": self.at, "AP": self.ap, "spurious": self.spurious}
        rates = {"SR1": self.sr1, "SR1_low": self.sr1_interval[0], "SR1_high": self.sr1_interval[1],
                 "SR2": self.sr2, "SR2_low": self.sr2_interval[0], "SR2_high": self.sr2_interval[1]}  # fmt: skip
        return counted | {name: _or_none(value) for name, value in rates.items()}


@dataclass(frozen=True, kw_only=True)
class Score(Tally):
    """The tally of a run, by the cause of each avoidance, and what stands beside it.

    Attributes
    ----------
    unseen_cr, unseen_cp : contacts that no robot in them could have seen coming
    cr_views : contacts between robots, counted once for each of the two that could have seen it coming
    robot_minutes, distance_cm : time and way of all robots together
    geometric : the tally by the geometric rule
    rule : "counterfactual", or "geometric" for a controller that cannot be replayed: then both tallies are the same
    """

    unseen_cr: int = 0
    unseen_cp: int = 0
    cr_views: int = 0
    robot_minutes: float = 0.0
    distance_cm: float = 0.0
    geometric: Tally = Tally()
    rule: str = "counterfactual"

    def __add__(self, other: Self) -> Self:
        """Add up two runs.

        Raises
        ------
        ParameterError : scores by different rules
        """
        if self.rule != other.rule:
            raise ParameterError(f"Score: {self.rule} + {other.rule}: must be by the same rule to be added")
        sums = {f.name: getattr(self, f.name) + getattr(other, f.name) for f in fields(self) if f.name != "rule"}
        return type(self)(**sums, rule=self.rule)

    @property
    def sr1_seen(self) -> float:
        """SR1 without the contacts that could not be seen coming."""
        return _share(self.ap, self.ap + self.cp - self.unseen_cp)

    @property
    def sr2_seen(self) -> float:
        """SR2 without the contacts that could not be seen coming."""
        return _share(self.aa, self.aa + self.at + self.cr - self.unseen_cr)

    @property
    def spurious_per_robot_minute(self) -> float:
        """Turns because of nothing; NaN before any time has passed."""
        return _share(self.spurious, self.robot_minutes)

    @property
    def spurious_interval(self) -> Interval:
        """Exact Poisson interval of ``spurious_per_robot_minute``, 95 %."""
        low, high = garwood(self.spurious)
        return _share(low, self.robot_minutes), _share(high, self.robot_minutes)

    def as_dict(self) -> dict[str, Any]:
        """Return a flat dictionary; the tally by the geometric rule has its names after ``geometric_``."""
        low, high = self.spurious_interval
        beside = {
            "spurious_per_robot_minute": self.spurious_per_robot_minute, "spurious_low": low, "spurious_high": high,
            "unseen_CR": self.unseen_cr, "unseen_CP": self.unseen_cp, "CR_views": self.cr_views,
            "SR1_seen": self.sr1_seen, "SR2_seen": self.sr2_seen,
            "robot_minutes": self.robot_minutes, "distance_cm": self.distance_cm, "rule": self.rule,
        }  # fmt: skip
        geometric = {f"geometric_{name}": value for name, value in self.geometric.as_dict().items()}
        return super().as_dict() | {name: _or_none(value) for name, value in beside.items()} | geometric


def tally(events: NDArray[Any], column: str = "kind") -> Tally:
    """Count the kinds of ``events`` (N,) EVENT_DTYPE; ``column`` "geometric" counts by the geometric rule."""
    return Tally(**{f.name: int((events[column] == _kind(f.name)).sum()) for f in fields(Tally)})


def counts(
    events: NDArray[Any], *, robot_minutes: float = 0.0, distance_cm: float = 0.0, rule: str = "counterfactual"
) -> Score:
    """Return the score of one run's ``events`` (N,) EVENT_DTYPE."""
    robots, periphery = events[events["kind"] == "CR"], events[events["kind"] == "CP"]
    views = robots["seen"].astype(int) + robots["seen_by_other"]
    by_cause = tally(events)
    return Score(
        **{f.name: getattr(by_cause, f.name) for f in fields(Tally)},
        unseen_cr=int((views == 0).sum()),
        unseen_cp=int((~periphery["seen"]).sum()),
        cr_views=int(views.sum()),
        robot_minutes=robot_minutes,
        distance_cm=distance_cm,
        geometric=tally(events, "geometric"),
        rule=rule,
    )


def total(scores: Iterable[Score]) -> Score:
    """Add up the scores of several runs.

    Raises
    ------
    ParameterError : no score, or scores by different rules
    """
    scores = list(scores)
    if not scores:
        raise ParameterError("total: no score: must be at least one")
    return functools.reduce(operator.add, scores)


def over_time(events: NDArray[Any], ends_s: Sequence[float]) -> list[Tally]:
    """Return the tally of all events up to each of ``ends_s``."""
    return [tally(events[events["time_s"] <= end]) for end in ends_s]


class Incidence(NamedTuple):
    """How many events fell between neighbouring ``edges_deg`` (N + 1,), apart by the LPTCs' state; (N,) each."""

    edges_deg: NDArray[np.float64]
    active: NDArray[np.int64]
    quiet: NDArray[np.int64]
    unknown: NDArray[np.int64]


def by_incidence(
    events: NDArray[Any],
    kind: str = "CP",
    *,
    edges_deg: Sequence[float] = INCIDENCE_EDGES_DEG,
    active_from: float = 0.2,
) -> Incidence:
    """Return a histogram of contacts with the periphery, or of its avoidances (``kind`` "AP"), over incidence angle.

    An LPTC is active where its strongest potential of the last 0.2 s reached ``active_from``, above which it spikes;
    its state is unknown with a controller that tells no potentials. Both last edges are included.
    """
    chosen = events[events["kind"] == kind]
    strongest = np.maximum(chosen["lptc_r"], -chosen["lptc_l"])
    edges = np.asarray(edges_deg, np.float64)
    states = (strongest >= active_from, strongest < active_from, np.isnan(strongest))
    return Incidence(edges, *(np.histogram(chosen["incidence_deg"][state], edges)[0] for state in states))


def _kind(name: str) -> str:
    return name if name == "spurious" else name.upper()


def _share(part: float, whole: float) -> float:
    return part / whole if whole else math.nan


def _or_none(value: Any) -> Any:
    return None if isinstance(value, float) and math.isnan(value) else value
