"""Settings scored on what a search was not told of: each once, and kept in the journal."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from operator import add
from typing import Any

from ..errors import ParameterError
from ..model.network import NetworkParams
from ..params import settings_hash
from ..runtime.interrupts import Interrupts
from .crew import Crew, Job
from .journal import Search
from .plan import Scored

Parts = Sequence[tuple[NetworkParams, Sequence[str]]]
"""Settings and what they are measured on; the tallies are added up."""


class Scores:
    """Measures settings, each once: what was measured is kept with ``search``."""

    def __init__(self, search: Search, crew: Crew, interrupts: Interrupts, step: Callable[[], None] | None) -> None:
        self._search, self._crew, self._interrupts, self._step = search, crew, interrupts, step

    def of(self, wanted: Mapping[Any, Parts]) -> dict[Any, Scored]:
        """Return the scores of all that is ``wanted``, by its keys."""
        kept = self._search.kept
        names = {key: _name(parts) for key, parts in wanted.items()}
        missing = {names[key]: parts for key, parts in wanted.items() if names[key] not in kept}
        jobs = [Job((name, part), *parts[part]) for name, parts in missing.items() for part in range(len(parts))]
        tallies: dict[str, dict[int, Any]] = {}
        for done in self._interrupts.between(self._crew.measure(iter(jobs))):
            name, part = done.job.key
            if done.tally is None:
                raise ParameterError(f"settings {settings_hash(done.job.params)}: {done.problem}")
            tallies.setdefault(name, {})[part] = done.tally
            if len(tallies[name]) == len(missing[name]):
                whole = reduce(add, (tallies[name][part] for part in sorted(tallies[name])))
                kept[name] = {"values": list(whole.values), "tally": whole.as_dict()}
                self._search.keep(name, kept[name])
            if self._step:
                self._step()
        return {key: Scored(tuple(kept[name]["values"]), kept[name]["tally"]) for key, name in names.items()}


def _name(parts: Parts) -> str:
    """Return what the scores of ``parts`` are kept as."""
    return "scored " + " + ".join(f"{settings_hash(params)} on {', '.join(names)}" for params, names in parts)
