"""What settings achieved: numbers to be searched by, one to pick by, and the counts they are made of."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any, Literal, NamedTuple, Protocol, Self

from ..arena.scoring import Score
from ..errors import ParameterError
from ..evaluate.scoring import ClipScore
from ..evaluate.summary import skill, totals


class Objective(NamedTuple):
    """One number that a search makes smaller or larger."""

    name: str
    direction: Literal["minimize", "maximize"]
    meaning: str


class Tally(Protocol):
    """What is known of settings on some movies, clips or runs; two of them add up."""

    @property
    def values(self) -> tuple[float, ...]:
        """The objectives, in their order."""

    @property
    def merit(self) -> float:
        """By which one of the front is picked: more is better."""

    def as_dict(self) -> dict[str, Any]:
        """Return everything, as plain numbers, lists and dictionaries."""

    def __add__(self, other: Any) -> Self:
        """Return the tally of both."""


FILM_OBJECTIVES = (
    Objective("missed", "minimize", "share of the collisions that no alarm came before in time"),
    Objective("false_per_minute", "minimize", "false alarms a minute"),
    Objective("lead_s", "maximize", "mean lead time, 0 for a collision missed, s"),
)
ARENA_OBJECTIVES = (
    Objective("failed_sr1", "minimize", "1 - SR1: share of the walls met that were touched"),
    Objective("failed_sr2", "minimize", "1 - SR2: share of the robots met that were touched, or avoided in vain"),
)


@dataclass(frozen=True)
class FilmTally:
    """Movies or clips, scored."""

    scores: tuple[ClipScore, ...]

    @property
    def values(self) -> tuple[float, ...]:
        """Misses, false alarms a minute, mean lead.

        Raises
        ------
        ParameterError : no collision, or no footage in which an alarm would be false
        """
        found = totals(self.scores)
        if not found.collisions or found.per_minute is None:
            lacking = "no collision" if not found.collisions else "no footage in which an alarm would be false"
            raise ParameterError(f"{lacking} among {len(self.scores)} movies or clips: nothing to search by")
        leads_s = math.fsum(score.lead_s or 0.0 for score in self.scores)
        return 1 - found.hits / found.collisions, found.per_minute, leads_s / found.collisions

    @property
    def merit(self) -> float:
        """Hit rate above that of as many alarms at random times."""
        return skill(self.scores)

    def as_dict(self) -> dict[str, Any]:
        """Return the totals, as ``lobula evaluate`` gives them."""
        return {name: _plain(value) for name, value in asdict(totals(self.scores)).items()}

    def __add__(self, other: Self) -> Self:
        return type(self)(self.scores + other.scores)


@dataclass(frozen=True)
class ArenaTally:
    """Runs of the arena, scored."""

    score: Score

    @property
    def values(self) -> tuple[float, ...]:
        """1 - SR1 and 1 - SR2; 1 where there was nothing to count."""
        return tuple(1.0 if math.isnan(rate) else 1 - rate for rate in (self.score.sr1, self.score.sr2))

    @property
    def merit(self) -> float:
        """SR1 + SR2."""
        return 2.0 - sum(self.values)

    def as_dict(self) -> dict[str, Any]:
        """Return the counts and rates, as ``lobula arena`` gives them."""
        return {name: _plain(value) for name, value in self.score.as_dict().items()}

    def __add__(self, other: Self) -> Self:
        return type(self)(self.score + other.score)


def _plain(value: Any) -> Any:
    """Return ``value`` for JSON: rounded to 6 decimals, None where it is no number."""
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return round(value, 6) if math.isfinite(value) else None
    return value
