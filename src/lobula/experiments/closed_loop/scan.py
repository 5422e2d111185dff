"""Many variants of model or arena on the same seeds: what is run, and the tables that come of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ...arena.world import World
from ...errors import ParameterError
from ...landing import whole_file
from ...model.network import NetworkParams
from ...params import settings_hash
from ...report.csv_lines import csv_lines
from .job_rows import job_lines
from .jobs import Done, Job
from .paper_table import DENSITIES
from .pool import run_jobs
from .run_log import note
from .table_page import TEST_SEEDS
from .tables import Group, contrast, group, interval_text, sr1, sr2


@dataclass(frozen=True, kw_only=True)
class Variant:
    """One setting of one lever.

    series : the lever, in words; base : what it changes, such as a preset; value : where it stands, in words
    """

    base: str
    series: str
    value: str
    params: NetworkParams
    world: World = field(default_factory=World)

    @property
    def name(self) -> str:
        """The variant in words."""
        return f"{self.base}, {self.series} {self.value}".strip()


@dataclass(frozen=True, kw_only=True)
class ScanPlan:
    """How long every variant is run: seeds, densities, and simulated minutes of each run."""

    seeds: Sequence[int]
    minutes: float
    densities: Sequence[int] = DENSITIES

    def __post_init__(self) -> None:
        if any(seed in TEST_SEEDS for seed in self.seeds):
            raise ParameterError(
                f"seeds {self.seeds[0]} to {self.seeds[-1]}: must not be among 7000 to 7999, the table's"
            )


Results = Mapping[tuple[Variant, int], Group]
"""By variant and robots."""


def jobs_of(variant: Variant, plan: ScanPlan) -> Iterator[Job]:
    """Yield the jobs of ``variant``; two variants with the same settings have the same jobs."""
    for robots in plan.densities:
        world = replace(variant.world, robots=replace(variant.world.robots, count=robots))
        model = f"{settings_hash(variant.params)}-{settings_hash(world)}"
        for seed in plan.seeds:
            yield Job(
                name=f"{model}-{seed}", model=model, world=world, seed=seed, minutes=plan.minutes, driver=variant.params
            )


def run_scan(
    name: str,
    variants: Sequence[Variant],
    plan: ScanPlan,
    folder: Path,
    *,
    workers: int = 1,
    advance: Callable[[], None] | None = None,
) -> dict[tuple[Variant, int], Group]:
    """Run every variant, write NAME.csv and NAME-runs.csv into ``folder``, and return the results.

    What is in the folder already is not run again.

    Raises
    ------
    ParameterError, Interrupted, OutputError : as ``pool.run_jobs``
    """
    about = {"variants": len(variants), "seeds": list(plan.seeds), "minutes": plan.minutes}
    unique = {job.name: job for variant in variants for job in jobs_of(variant, plan)}
    done = run_jobs(list(unique.values()), folder / f"{name}-jobs", workers=workers, advance=advance)
    note(folder, name, about)
    by_name = {one.job.name: one for one in done}
    results: dict[tuple[Variant, int], Group] = {}
    for variant in variants:
        own: dict[int, list[Done]] = {}
        for job in jobs_of(variant, plan):
            own.setdefault(job.robots, []).append(by_name[job.name])
        results |= {(variant, robots): group(some) for robots, some in own.items()}
    write(folder / f"{name}-runs.csv", job_lines(done))
    rows = [_row(variant, robots, found) for (variant, robots), found in results.items()]
    write(folder / f"{name}.csv", csv_lines(rows[0], rows))
    return results


def job_count(variants: Iterable[Variant], plan: ScanPlan) -> int:
    """Return how many different jobs there are."""
    return len({job.name for variant in variants for job in jobs_of(variant, plan)})


def write(path: Path, lines: Iterable[str]) -> None:
    """Write ``lines``, which have their ends, to ``path``: all or nothing."""
    with whole_file(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        file.writelines(lines)


def rate_cells(found: Group) -> tuple[str, str]:
    """Return SR1 and SR2 with Wilson's interval and, from five seeds on, that of a bootstrap over the seeds."""
    score, cells = found.score, []
    for value, wilson, rate in ((score.sr1, score.sr1_interval, sr1), (score.sr2, score.sr2_interval, sr2)):
        if value != value:
            cells.append("nothing to count")
            continue
        text = f"{100 * value:.1f} % {interval_text(100 * wilson[0], 100 * wilson[1])}"
        over_seeds = contrast("", [found], rate, "")
        known = over_seeds.low == over_seeds.low
        cells.append(f"{text} {interval_text(over_seeds.low, over_seeds.high)}" if known else text)
    return cells[0], cells[1]


def made_by(module: str, plan: ScanPlan, variants: Sequence[Variant]) -> str:
    """Return the line that says how a page was made."""
    seeds = f"{plan.seeds[0]} to {plan.seeds[-1]}" if len(plan.seeds) > 1 else f"{plan.seeds[0]}"
    return (
        f"Made by `python -m lobula.experiments.closed_loop.{module}`: {len(variants)} variants, calibration seeds "
        f"{seeds}, {plan.minutes:g} simulated minutes of each. Nothing here was run on the seeds of Table I."
    )


def _row(variant: Variant, robots: int, found: Group) -> dict[str, Any]:
    return {
        "base": variant.base,
        "series": variant.series,
        "value": variant.value,
        "robots": robots,
        "settings": settings_hash(variant.params),
        "world": settings_hash(variant.world),
        **found.score.as_dict(),
    }
