"""What settings are measured on: films, or runs of the arena."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

from ..arena.network_controller import NetworkController
from ..arena.running import run
from ..arena.scoring import total
from ..arena.world import World
from ..errors import ParameterError
from ..evaluate.document import RULES
from ..experiments.closed_loop.table_page import TEST_SEEDS
from ..model.network import NetworkParams
from ..params import settings_hash
from .films import Film, digest_of, score_films
from .split import Splits
from .tally import ARENA_OBJECTIVES, FILM_OBJECTIVES, ArenaTally, FilmTally, Objective, Tally


class Task(Protocol):
    """Measures settings on named things; it travels to other processes."""

    @property
    def splits(self) -> Splits:
        """What each search may look at."""

    @property
    def about(self) -> Mapping[str, Any]:
        """In words and numbers what is measured on, and how it is parted: part of every result."""

    @property
    def objectives(self) -> tuple[Objective, ...]:
        """What a search makes smaller or larger."""

    @property
    def identity(self) -> Mapping[str, Any]:
        """What the measurements depend on besides the settings and the code."""

    def measure(self, params: NetworkParams, names: Sequence[str]) -> Tally:
        """Return what ``params`` achieve on the things ``names``."""

    def length_s(self, names: Sequence[str]) -> float:
        """Return how long one camera would watch them, s."""


@dataclass(frozen=True)
class FilmTask:
    """Movies or clips with a known answer."""

    films: Mapping[str, Film]
    splits: Splits
    about: Mapping[str, Any]

    def __post_init__(self) -> None:
        for search, split in self.splits.items():
            quiet = FilmTally(tuple(self.films[name].quiet for name in split.train))
            try:
                _ = quiet.values
            except ParameterError as error:
                raise ParameterError(f"search {search}: {error}") from error

    @property
    def objectives(self) -> tuple[Objective, ...]:
        """Misses, false alarms, lead time."""
        return FILM_OBJECTIVES

    @property
    def identity(self) -> Mapping[str, Any]:
        """The films and the rules by which they are scored."""
        return {"films": digest_of(list(self.films.values())), "rules": RULES}

    def measure(self, params: NetworkParams, names: Sequence[str]) -> FilmTally:
        """Return the scores of ``params`` on the films ``names``."""
        return FilmTally(tuple(score_films(params, [self.films[name] for name in names])))

    def length_s(self, names: Sequence[str]) -> float:
        """Return how long they last, s."""
        return sum(self.films[name].length_s for name in names)


@dataclass(frozen=True)
class ArenaTask:
    """Runs of the arena, ``runs`` by name: seed and number of robots."""

    runs: Mapping[str, tuple[int, int]]
    splits: Splits
    about: Mapping[str, Any]
    minutes: float
    world: World

    def __post_init__(self) -> None:
        tested = [seed for seed, _ in self.runs.values() if seed in TEST_SEEDS]
        if tested:
            raise ParameterError(f"seed {tested[0]}: must not be among 7000 to 7999, kept for tests (docs/protocol.md)")

    @property
    def objectives(self) -> tuple[Objective, ...]:
        """What is wanting in SR1 and SR2."""
        return ARENA_OBJECTIVES

    @property
    def identity(self) -> Mapping[str, Any]:
        """The world and how long it is run; the seeds are told by the splits."""
        return {"world": settings_hash(self.world), "minutes": self.minutes}

    def measure(self, params: NetworkParams, names: Sequence[str]) -> ArenaTally:
        """Return the score of all runs ``names`` together."""
        return ArenaTally(total(self._score(params, *self.runs[name]) for name in names))

    def _score(self, params: NetworkParams, seed: int, robots: int) -> Any:
        world = replace(self.world, robots=replace(self.world.robots, count=robots))
        return run(world, NetworkController(params), seed=seed, minutes=self.minutes).score

    def length_s(self, names: Sequence[str]) -> float:
        """Return the time of all robots together, s."""
        return sum(60 * self.minutes * self.runs[name][1] for name in names)
