"""The command line of the scans: ``python -m lobula.experiments.closed_loop.NAME --out DIR``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from ...landing import writing
from ...runtime.script import counter, run_script
from .arguments import add_workers, parser, seeds_of
from .scan import ScanPlan, Variant, job_count

Make = Callable[[ScanPlan, Path, int, Callable[[], None]], None]
"""Runs the scan and writes its files: plan, folder, workers, what to call for each finished job."""


def command(about: str, variants: Sequence[Variant], make: Make, arguments: Sequence[str] | None = None) -> int:
    """Run a scan as the command line asks and return the exit code, as ``run_script``."""
    p = parser(about, "figure, tables and page")
    add_workers(p)
    p.add_argument("--list", action="store_true", help="say what would be run, and stop")
    given = p.parse_args(arguments)

    def scan() -> None:
        plan = ScanPlan(seeds=seeds_of(given), minutes=given.minutes, densities=given.robots)
        jobs = job_count(variants, plan)
        if given.list:
            print("\n".join(variant.name for variant in variants))
            print(f"{len(variants)} variants, {jobs} runs of {plan.minutes:g} simulated minutes")
            return
        with writing(given.out):
            given.out.mkdir(parents=True, exist_ok=True)
        make(plan, given.out, given.workers, counter(jobs, "runs"))
        print(given.out)

    return run_script(scan, f"the same command goes on from what lies in {given.out}")
