"""The search: trials asked for, measured, told; then the best of them scored on what was held out."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from ..errors import ParameterError
from ..runtime.interrupts import Interrupts
from .crew import Crew, Job, Measured
from .identity import identity, require_same
from .journal import Journal, Search, Trial
from .plan import Found, Plan, Speed
from .scores import Parts, Scores

Advance = Callable[[], None]


def tune(plan: Plan, journal: Journal, *, advance: Advance | None = None, score: Advance | None = None) -> Found:
    """Search as ``plan`` says, going on from what the journal holds.

    ``advance`` is called for each trial that is there or gets measured, ``score`` for each measurement afterwards.

    Raises
    ------
    ParameterError : the journal is of another search; no settings could be measured
    Interrupted : a signal came; all trials that were measured are in the journal
    OutputError : the journal cannot be written, or a worker was killed
    """
    step = advance or (lambda: None)
    own = identity(plan.task, plan.base, plan.axes, plan.budget.seed)
    require_same(own, journal.path)
    with Crew(plan.task, plan.budget.workers) as crew, Interrupts() as interrupts:
        searches = [
            Search(journal, name, place, plan.axes, plan.task.objectives, plan.budget.seed)
            for place, name in enumerate(plan.task.splits)
        ]
        for search in searches:
            for _ in range(min(plan.budget.most, len(search.trials()))):
                step()
        speed = Speed()
        begun = time.monotonic()
        for done in interrupts.between(_measurements(plan, searches, crew)):
            _tell(done)
            speed.trials += 1
            speed.processor_s += done.seconds
            speed.footage_s += plan.task.length_s(done.job.names)
            speed.seconds = time.monotonic() - begun
            step()
        chosen = {search.name: _best(search) for search in searches}
        scores = Scores(searches[0], crew, interrupts, score)
        return _found(plan, own, searches, chosen, scores, speed)


def _measurements(plan: Plan, searches: Sequence[Search], crew: Crew) -> Iterator[Measured]:
    """Yield what comes of each trial, round after round, all searches side by side."""
    deadline_s = None if plan.budget.minutes is None else time.monotonic() + 60 * plan.budget.minutes

    def in_time(jobs: Sequence[Job]) -> Iterator[Job]:
        for job in jobs:
            _, trial = job.key
            if deadline_s is None or time.monotonic() < deadline_s or trial.number == 0:  # each search has a result
                yield job

    while True:
        waiting = [(search, trial) for search in searches for trial in search.next_round(plan.budget.most)]
        if not waiting:
            return
        waiting.sort(key=lambda pair: pair[1].number)
        jobs = [
            Job((search, trial), plan.settings(trial), plan.task.splits[search.name].train) for search, trial in waiting
        ]
        yield from crew.measure(in_time(jobs))
        if deadline_s is not None and time.monotonic() >= deadline_s:
            return


def _tell(done: Measured) -> None:
    search, trial = done.job.key
    if done.tally is None:
        search.give_up(trial.number, done.problem)
    else:
        search.tell(trial.number, done.tally.values, done.tally.as_dict(), done.tally.merit)


def _best(search: Search) -> Trial:
    """Return the trial of the front with the most merit; of equal ones the better in the first objective that differs.

    Raises
    ------
    ParameterError : there is none
    """
    front = search.front()
    if not front:
        problems = [trial.problem for trial in search.trials()]
        why = f"; the last one: {problems[-1]}" if problems else ""
        raise ParameterError(f"search {search.name}: no settings could be measured{why}")
    return max(front, key=lambda trial: (trial.merit, search.gains(trial), -trial.number))


def _found(
    plan: Plan, own: Mapping[str, Any], searches: Sequence[Search], chosen: Mapping[str, Trial], scores: Scores,
    speed: Speed,
) -> Found:  # fmt: skip
    first, *others = searches
    split = plan.task.splits[first.name]
    front = first.front()
    wanted: dict[Any, Parts] = {"preset": [(plan.base, split.train)]}
    if split.held_out:
        wanted |= {"preset held out": [(plan.base, split.held_out)]}
        wanted |= {trial.number: [(plan.settings(trial), split.held_out)] for trial in front}
    elif others:
        kept_from = {search.name: plan.task.splits[search.name].held_out for search in others}
        wanted |= {"preset held out": [(plan.base, names) for names in kept_from.values()]}
        wanted |= {"others": [(plan.settings(chosen[name]), names) for name, names in kept_from.items()]}
    scored = scores.of(wanted)
    return Found(
        plan=plan,
        identity=own,
        trials={search.name: search.trials() for search in searches},
        front=front,
        best=chosen[first.name],
        held_out={trial.number: scored[trial.number] for trial in front if trial.number in scored},
        cross_validated=scored.get("others"),
        preset=scored["preset"],
        preset_held_out=scored.get("preset held out"),
        chosen=chosen,
        speed=speed,
    )
