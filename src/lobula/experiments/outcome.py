"""What the network made of one movie of the synthetic battery, and whether that is what the paper says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..engine.network import Network
from ..model.network import NetworkParams
from ..stimuli import Movie
from ..stimuli.battery import Case, Expectation
from ..types import NEURONS

Engine = Literal["auto", "core", "reference"]

BRIEF_S = 1.0
"""A burst within this long is brief."""
SILENT_SHARE = 0.1
"""LPTCs are silent while they spike less than this share of the busier LGMD."""
WINDOW_S = 0.2
"""Strength of a response: spikes within the network's own decision window."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Spikes of the whole movie by neuron, and when each selection of neurons first called a collision."""

    spikes: dict[str, int]
    lgmd1_burst_s: float
    """From the first to the last spike of LGMD-1."""
    strongest: int
    """Most spikes that both LGMDs gave within 200 ms, the lesser of the two."""
    all_s: float | None
    lgmds_s: float | None
    contact_s: float | None


class Check(NamedTuple):
    """One claim about one movie."""

    claim: str
    holds: bool


def outcome(movie: Movie, params: NetworkParams, engine: Engine = "auto") -> Outcome:
    """Run ``movie`` with all four neurons deciding, and with the two LGMDs alone."""
    trace = _trace(movie, params, "all", engine)
    fired = trace["time_s"][trace["spikes_lgmd1"] > 0]
    return Outcome(
        spikes={name: int(trace[f"spikes_{name}"].sum()) for name in NEURONS},
        lgmd1_burst_s=float(fired[-1] - fired[0]) if fired.size else 0.0,
        strongest=strongest_window(trace),
        all_s=_first(trace),
        lgmds_s=_first(_trace(movie, params, "lgmds", engine)),
        contact_s=movie.contact_s,
    )


def first_alarm(movie: Movie, params: NetworkParams, engine: Engine = "auto") -> float | None:
    """Return when the network first calls a collision, s, decided as ``params`` say; None if it never does."""
    return _first(Network(params, engine=engine).run(movie.images, movie.times_s))


def strongest_window(trace: NDArray[Any]) -> int:
    """Return the most spikes that both LGMDs gave within ``WINDOW_S``, the lesser of the two."""
    times = trace["time_s"]
    first = np.searchsorted(times, times - WINDOW_S + 1e-3)
    sums = [np.concatenate(([0], np.cumsum(trace[f"spikes_{name}"]))) for name in ("lgmd1", "lgmd2")]
    both = np.minimum(*(total[1:] - total[first] for total in sums))
    return int(both.max(initial=0))


def checks(case: Case, result: Outcome, approach_strength: int) -> Iterator[Check]:
    """Yield what the paper claims of this kind of movie, and whether it holds.

    ``approach_strength`` is the ``strongest`` of the approach at the same speed.
    """
    about, spikes = case.expectation, result.spikes
    lptcs = spikes["lptc_r"] + spikes["lptc_l"]
    busier = max(spikes["lgmd1"], spikes["lgmd2"])
    if about.kind in ("looming", "receding"):
        yield Check("LGMD-1 spikes", spikes["lgmd1"] > 0)
        yield Check("LPTCs silent", lptcs <= SILENT_SHARE * busier)
        yield from (_approach if about.kind == "looming" else _recession)(about, result)
    elif about.kind.startswith("translating"):
        own, other = ("lptc_r", "lptc_l") if about.kind.endswith("right") else ("lptc_l", "lptc_r")
        yield Check("both LGMDs spike", min(spikes["lgmd1"], spikes["lgmd2"]) > 0)
        yield Check("less than for approach", result.strongest < approach_strength)
        yield Check("the right LPTC", spikes[own] > 0 and spikes[other] == 0)
        yield Check("more than the LGMDs", spikes[own] > busier)
        yield Check("LGMDs alone call a collision", result.lgmds_s is not None)
        yield Check("all four do not", result.all_s is None)
    elif about.kind != "angular":
        yield Check("no spike", not any(spikes.values()))
        yield Check("no collision", result.all_s is None and result.lgmds_s is None)


def _approach(about: Expectation, result: Outcome) -> Iterator[Check]:
    if about.dark:
        yield Check("LGMD-2 spikes", result.spikes["lgmd2"] > 0)
        seen = result.all_s is not None and result.contact_s is not None and result.all_s < result.contact_s
        yield Check("a collision, before contact", seen)
    else:
        yield Check("LGMD-2 silent to a bright object", result.spikes["lgmd2"] == 0)


def _recession(about: Expectation, result: Outcome) -> Iterator[Check]:
    yield Check("LGMD-1 briefly", result.lgmd1_burst_s <= BRIEF_S)
    if about.dark:
        yield Check("LGMD-2 silent", result.spikes["lgmd2"] == 0)
        yield Check("no collision", result.all_s is None)


def _trace(movie: Movie, params: NetworkParams, neurons: str, engine: Engine) -> NDArray[Any]:
    chosen = replace(params, decision=replace(params.decision, neurons=neurons))
    return Network(chosen, engine=engine).run(movie.images, movie.times_s)


def _first(trace: NDArray[Any]) -> float | None:
    called = trace["time_s"][trace["collision"]]
    return float(called[0]) if called.size else None
