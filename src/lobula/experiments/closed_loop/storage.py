"""What 16-bit planes cost in the arena: the float build and the robot's arithmetic over the same worlds and seeds.

    python -m lobula.experiments.closed_loop.storage --out DIR --seeds 2 --minutes 10 --robots 4 7

prints SR1 and SR2 of both side by side with their Wilson intervals, and whether each rate of the compact build lies in
the float build's interval. The seeds are the calibration's; the protocol's table with the robot's arithmetic is
``--first-seed 7001 --seeds 10 --minutes 60``.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...arena.controller import Controller
from ...arena.network_controller import NetworkController
from ...arena.scoring import Score, total
from ...arena.world import World
from ...errors import LobulaError, ParameterError
from ...intervals import Interval
from ...model.network import NetworkParams
from ...model.presets import NAMES, preset
from ...runtime.interrupts import Interrupted, raised_at_once
from ...workers import cores
from .jobs import Control, Job
from .pool import run_jobs

FIRST_SEED, SEEDS, MINUTES = 121, 2, 10.0
STORAGES = ("float", "compact")


@dataclass(frozen=True, kw_only=True)
class StorageJob(Job):
    """A job whose networks keep their planes in this way."""

    storage: str

    def identity(self, code: str) -> dict[str, Any]:
        """Return everything the result depends on; ``code`` is the hash of the code."""
        return super().identity(code) | {"storage": self.storage}

    def controller(self) -> Controller:
        """Return a new controller."""
        assert not isinstance(self.driver, Control)
        return NetworkController(self.driver, storage=self.storage)


def jobs(params: NetworkParams, robots: Sequence[int], seeds: Sequence[int], minutes: float) -> Iterator[StorageJob]:
    """Yield a run for each number of robots, seed and storage."""
    for count in robots:
        world = replace(World(), robots=replace(World().robots, count=count))
        for seed in seeds:
            for storage in STORAGES:
                yield StorageJob(
                    name=f"{storage}-{count}-{seed}", model=storage, world=world, seed=seed, minutes=minutes,
                    driver=params, storage=storage,
                )  # fmt: skip


def lines(scores: dict[tuple[int, str], Score]) -> Iterator[str]:
    """Yield the table: a line for each number of robots and each rate."""
    yield f"{'robots':>6}  rate  {'float':<24}{'compact':<24}compact within float's interval"
    for count in sorted({robots for robots, _ in scores}):
        one, other = (scores[count, storage] for storage in STORAGES)
        for name, a, b, of_a, of_b in (
            ("SR1", one.sr1, other.sr1, one.sr1_interval, other.sr1_interval),
            ("SR2", one.sr2, other.sr2, one.sr2_interval, other.sr2_interval),
        ):
            inside = "nothing to count" if math.isnan(b) else "yes" if of_a[0] <= b <= of_a[1] else "no"
            yield f"{count:>6}  {name}   {_rate(a, of_a):<24}{_rate(b, of_b):<24}{inside}"


def _rate(share: float, interval: Interval) -> str:
    return f"{share:.3f} ({interval[0]:.3f} to {interval[1]:.3f})"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the comparison and return the exit code: 0, 2 for a wrong request, 130 or 143."""
    p = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    p.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for the results of the runs")
    p.add_argument("--preset", default="paper", metavar="NAME", help=f"of {', '.join(NAMES)}; paper")
    p.add_argument("--seeds", type=int, default=SEEDS, metavar="N", help=f"runs of each; {SEEDS}")
    p.add_argument("--first-seed", type=int, default=FIRST_SEED, metavar="N", help=f"{FIRST_SEED}, for calibration")
    p.add_argument("--minutes", type=float, default=MINUTES, metavar="MIN", help=f"simulated, of each run; {MINUTES:g}")
    p.add_argument("--robots", type=int, nargs="+", default=[4, 7], metavar="N", help="numbers of robots; 4 7")
    p.add_argument("--workers", type=int, default=cores(), metavar="N", help="processes; one a core")
    given = p.parse_args(arguments)
    try:
        if given.seeds < 1:
            raise ParameterError(f"--seeds {given.seeds}: must be 1 or more")
        seeds = range(given.first_seed, given.first_seed + given.seeds)
        with raised_at_once():
            found = run_jobs(
                list(jobs(preset(given.preset), given.robots, seeds, given.minutes)), given.out, workers=given.workers
            )
    except LobulaError as error:
        print(f"lobula: {error}", file=sys.stderr)
        return 2
    except Interrupted as stop:
        print(f"lobula: interrupted; the same command goes on from what lies in {given.out}", file=sys.stderr)
        return stop.exit_code
    keys = {(done.job.robots, done.job.model) for done in found}
    scores = {key: total(done.score for done in found if (done.job.robots, done.job.model) == key) for key in keys}
    print("\n".join(lines(scores)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
