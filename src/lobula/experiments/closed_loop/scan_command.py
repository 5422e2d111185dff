"""The command line of the scans: ``python -m lobula.experiments.closed_loop.NAME --out DIR``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from ...errors import LobulaError, ParameterError
from ...landing import writing
from ...runtime.interrupts import Interrupted, raised_at_once
from ...workers import cores
from .scan import ScanPlan, Variant, job_count

FIRST_SEED, SEEDS, MINUTES = 101, 5, 5.0

Make = Callable[[ScanPlan, Path, int, Callable[[], None]], None]
"""Runs the scan and writes its files: plan, folder, workers, what to call for each finished job."""


def command(about: str, variants: Sequence[Variant], make: Make, arguments: Sequence[str] | None = None) -> int:
    """Run a scan as the command line asks and return the exit code: 0, 2 for a wrong request, 130 or 143."""
    p = argparse.ArgumentParser(description=about)
    p.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for figure, tables and page")
    p.add_argument("--seeds", type=int, default=SEEDS, metavar="N", help=f"runs of each variant; {SEEDS}")
    p.add_argument("--first-seed", type=int, default=FIRST_SEED, metavar="N", help=f"{FIRST_SEED}, for calibration")
    p.add_argument("--minutes", type=float, default=MINUTES, metavar="MIN", help=f"simulated, of each run; {MINUTES:g}")
    p.add_argument("--robots", type=int, nargs="+", default=[4, 7], metavar="N", help="numbers of robots; 4 7")
    p.add_argument("--workers", type=int, default=cores(), metavar="N", help="processes; one a core")
    p.add_argument("--list", action="store_true", help="say what would be run, and stop")
    given = p.parse_args(arguments)
    try:
        if given.seeds < 1:
            raise ParameterError(f"--seeds {given.seeds}: must be 1 or more")
        seeds = range(given.first_seed, given.first_seed + given.seeds)
        plan = ScanPlan(seeds=seeds, minutes=given.minutes, densities=given.robots)
        jobs = job_count(variants, plan)
        if given.list:
            print("\n".join(variant.name for variant in variants))
            print(f"{len(variants)} variants, {jobs} runs of {plan.minutes:g} simulated minutes")
            return 0
        with writing(given.out):
            given.out.mkdir(parents=True, exist_ok=True)
        with raised_at_once():
            make(plan, given.out, given.workers, _counter(jobs))
    except LobulaError as error:
        print(f"lobula: {error}", file=sys.stderr)
        return 2
    except Interrupted as stop:
        print(f"lobula: interrupted; the same command goes on from what lies in {given.out}", file=sys.stderr)
        return stop.exit_code
    print(given.out)
    return 0


def _counter(jobs: int) -> Callable[[], None]:
    """Count finished jobs on a terminal; in a pipe be silent."""
    done = 0

    def step() -> None:
        nonlocal done
        done += 1
        if sys.stderr.isatty():
            print(f"\r{done} of {jobs} runs", end="\n" if done == jobs else "", file=sys.stderr, flush=True)

    return step
