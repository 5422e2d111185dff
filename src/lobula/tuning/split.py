"""What a search may look at, and what it is scored on afterwards: two parts with nothing in common."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..errors import ParameterError


@dataclass(frozen=True)
class Split:
    """Names of movies, clips or runs: those a search is told of, and those kept from it."""

    train: tuple[str, ...]
    held_out: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        both = set(self.train) & set(self.held_out)
        if both:
            raise ParameterError(f"{min(both)}: must not be searched on and held out at once")
        if not self.train:
            raise ParameterError("nothing to search on: must have at least one movie, clip or run")


Splits = Mapping[str, Split]
"""By search. The first search gives the settings; where it holds nothing out, the others cross-validate it: each holds
out a part, and the parts together are all there is."""
