"""The synthetic battery, scored: which claims hold on which movies."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import NamedTuple

from ..model.network import NetworkParams
from ..stimuli.battery import Case, battery
from .outcome import Check, Engine, Outcome, checks, first_alarm, outcome

AGREE_S = 0.067
"""Tolerance of a first alarm between frame rates."""


class Scored(NamedTuple):
    """One movie of the battery, what the network made of it, and the claims."""

    case: Case
    result: Outcome
    checks: tuple[Check, ...]


class RateChange(NamedTuple):
    """A movie whose decision, or first alarm, is not the same at another frame rate."""

    name: str
    rate_hz: float
    neurons: str
    at_30_hz_s: float | None
    at_rate_s: float | None


def score(params: NetworkParams, *, rate_hz: float = 30.0, engine: Engine = "auto") -> list[Scored]:
    """Run every movie of the battery at ``rate_hz`` and check the claims on it."""
    results = [(case, outcome(case.movie(rate_hz=rate_hz), params, engine)) for case in battery()]
    approach = {
        case.expectation.speed_cm_s: result.strongest
        for case, result in results
        if case.name.startswith("looming-dark-")
    }
    return [
        Scored(case, result, tuple(checks(case, result, approach.get(case.expectation.speed_cm_s, 0))))
        for case, result in results
    ]


def rate_changes(params: NetworkParams, rates_hz: Collection[float], engine: Engine = "auto") -> Iterator[RateChange]:
    """Yield where another frame rate decides otherwise than 30 Hz, or moves the first alarm by over 67 ms."""
    base = {s.case.name: s.result for s in score(params, engine=engine)}
    for rate_hz in rates_hz:
        for scored in score(params, rate_hz=rate_hz, engine=engine):
            name = scored.case.name
            pairs = {
                "all": (base[name].all_s, scored.result.all_s),
                "lgmds": (base[name].lgmds_s, scored.result.lgmds_s),
            }
            for neurons, (before, now) in pairs.items():
                if not _agree(before, now):
                    yield RateChange(name, rate_hz, neurons, before, now)


def own_rate_changes(
    params: NetworkParams, rates_hz: Collection[float], engine: Engine = "auto"
) -> Iterator[RateChange]:
    """Yield the same for what ``params`` themselves decide, whoever decides in them."""
    cases = list(battery())
    base = {case.name: first_alarm(case.movie(rate_hz=30.0), params, engine) for case in cases}
    for rate_hz in rates_hz:
        for case in cases:
            before, now = base[case.name], first_alarm(case.movie(rate_hz=rate_hz), params, engine)
            if not _agree(before, now):
                yield RateChange(case.name, rate_hz, params.decision.neurons, before, now)


def _agree(a: float | None, b: float | None) -> bool:
    if a is None or b is None:
        return a is b
    return abs(a - b) <= AGREE_S
