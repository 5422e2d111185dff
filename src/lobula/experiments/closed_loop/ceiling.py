"""What success rates are reachable: robots driven by a controller that knows the true places and velocities.

    python -m lobula.experiments.closed_loop.ceiling --out DIR

What it misses of 100 % lies in the arena, the turn and the counting, not in a detector.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import Any

from ...arena.scoring import Tally, total
from ...arena.world import World
from ...intervals import Interval
from ...landing import writing
from ...report.csv_lines import csv_lines
from ...runtime.script import run_script
from .arguments import parser, seeds_of
from .informed import Outcome, Rule, Sight, drive
from .run_log import note
from .scan import ScanPlan, write
from .tables import interval_text

NAME = "ceiling"

SIGHTS: dict[Sight, str] = {
    "edge": "any part of it in the field of view",
    "centre": "its centre in the field of view",
    "around": "anywhere, as if it saw all around",
}

RULES = (
    Rule(horizon_s=0.4),
    Rule(horizon_s=0.7),
    Rule(horizon_s=1.0),
    Rule(horizon_s=0.7, sight="centre"),
    Rule(horizon_s=0.7, sight="around"),
)

Outcomes = Mapping[tuple[Rule, int], Sequence[Outcome]]
"""By rule and robots, one for each seed."""


def make(plan: ScanPlan, folder: Path) -> None:
    """Run every rule on every seed and write ceiling.csv, one row a run, and ceiling.md.

    Raises
    ------
    ParameterError : as ``drive``
    OutputError : a file cannot be written
    """
    outcomes: dict[tuple[Rule, int], list[Outcome]] = {}
    for robots in plan.densities:
        world = replace(World(), robots=replace(World().robots, count=robots))
        for rule in RULES:
            outcomes[rule, robots] = [drive(world, rule, seed, plan.minutes) for seed in plan.seeds]
    note(folder, NAME, {"variants": len(RULES), "seeds": list(plan.seeds), "minutes": plan.minutes})
    rows = list(_rows(plan, outcomes))
    write(folder / f"{NAME}.csv", csv_lines(rows[0], rows))
    write(folder / f"{NAME}.md", (f"{line}\n" for line in page(plan, outcomes)))


def page(plan: ScanPlan, outcomes: Outcomes) -> Iterator[str]:
    """Yield the lines of ``ceiling.md``."""
    world = World()
    near, margin = world.scoring.near_cm, world.scoring.margin_cm
    seeds = f"{plan.seeds[0]} to {plan.seeds[-1]}" if len(plan.seeds) > 1 else f"{plan.seeds[0]}"
    yield "# What a controller that knows everything reaches"
    yield ""
    yield (
        f"Made by `python -m lobula.experiments.closed_loop.{NAME}`: {len(RULES)} variants, calibration seeds {seeds}, "
        f"{plan.minutes:g} simulated minutes of each. Nothing here was run on the seeds of Table I."
    )
    yield ""
    yield (
        "The controller knows where every robot truly is and how it moves. A robot turns when it would touch the wall "
        f"within {RULES[0].wall_cm:g} cm straight on, or when a robot in view comes nearer and will be, velocities "
        f"held, within {margin:g} cm of touching in *T* seconds. The turn is that of every other controller. Intervals "
        "are Wilson's of 95 %."
    )
    for robots in plan.densities:
        yield ""
        yield f"## {robots} robots"
        yield ""
        yield (
            "| T | which robots it knows of | CR | of them unseen | CP | AA | AT | AP | spurious "
            "| SR1 by place | SR2 by place | SR1 by reasons | SR2 by reasons |"
        )
        yield "|--:|---|--:|--:|--:|--:|--:|--:|--:|---|---|---|---|"
        for (rule, count), runs in outcomes.items():
            if count == robots:
                score, reasons = total(run.score for run in runs), sum((run.reasons for run in runs), Tally())
                cells = [f"{rule.horizon_s:.1f} s", SIGHTS[rule.sight], score.cr, score.unseen_cr, score.cp]
                cells += [score.aa, score.at, score.ap, score.spurious, *_rates(score), *_rates(reasons)]
                yield f"| {' | '.join(map(str, cells))} |"
    yield ""
    yield "What limits the comparison with a detector:"
    yield ""
    yield (
        "- It cannot be asked again with something left out, as the networks are. So its causes, and with them all "
        f"columns from AA to *SR2 by place*, are by place alone: the nearest robot in view within {near:g} cm, else "
        "the wall. Where a robot is in view as near as that, a turn from the wall counts as AA or AT, and a turn from "
        "one robot as AT if another is nearer. Compare these with a network's rates by place alone."
    )
    yield (
        "- *By reasons* counts what it turned for: an approaching robot as AA (also where the wall was near), the wall "
        "as AP. AT is 0 by construction. This is the nearer of the two to causes found by leaving out, but it is not "
        "the same rule."
    )
    yield (
        "- It is one family of rules, not a bound: nobody has shown that no other one does better. Its view is not "
        "hidden by bodies in between, and it has no delay and no noise. But it does not know who will turn next, nor "
        "does it choose the side it turns to."
    )
    yield (
        "- *Unseen* are contacts that no robot in them could have seen coming: each was turning, or had not had the "
        "other one in its picture in the last second. *Spurious* are turns because of a robot that the picture does "
        f"not show, or of a wall met so aslant that straight ahead it is {near:g} cm off or more."
    )


def _rates(tally: Tally) -> list[str]:
    return [_rate(tally.sr1, tally.sr1_interval), _rate(tally.sr2, tally.sr2_interval)]


def _rate(value: float, ends: Interval) -> str:
    if value != value:
        return "nothing to count"
    return f"{100 * value:.1f} % {interval_text(100 * ends[0], 100 * ends[1])}"


def _rows(plan: ScanPlan, outcomes: Outcomes) -> Iterator[dict[str, Any]]:
    for (rule, robots), runs in outcomes.items():
        for seed, run in zip(plan.seeds, runs, strict=True):
            about = {"horizon_s": rule.horizon_s, "sight": rule.sight, "wall_cm": rule.wall_cm}
            reasons = {f"reasons_{name}": value for name, value in run.reasons.as_dict().items()}
            counted = chain(run.score.as_dict().items(), reasons.items())
            rounded = {name: round(value, 6) if isinstance(value, float) else value for name, value in counted}
            yield {**about, "robots": robots, "seed": seed, "minutes": plan.minutes, **rounded}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run it from a command line and return the exit code, as ``run_script``."""
    p = parser("What a controller reaches that knows the true places and velocities.", "table and page")
    given = p.parse_args(arguments)

    def measure() -> None:
        plan = ScanPlan(seeds=seeds_of(given), minutes=given.minutes, densities=given.robots)
        with writing(given.out):
            given.out.mkdir(parents=True, exist_ok=True)
        make(plan, given.out)
        print(given.out)

    return run_script(measure, "the page is not written: must be run again from the start")


if __name__ == "__main__":
    sys.exit(main())
