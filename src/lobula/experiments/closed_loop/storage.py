"""What 16-bit planes cost in the arena: the float build and the robot's arithmetic over the same worlds and seeds.

    python -m lobula.experiments.closed_loop.storage --out DIR --seeds 2 --minutes 10 --robots 4 7

prints SR1 and SR2 of both side by side with their Wilson intervals, and whether each rate of the compact build lies in
the float build's interval. The seeds are the calibration's; the protocol's table with the robot's arithmetic is
``--first-seed 7001 --seeds 10 --minutes 60``.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ...arena.controller import Controller
from ...arena.network_controller import NetworkController
from ...arena.scoring import Score, total
from ...arena.world import World
from ...intervals import Interval
from ...model.network import NetworkParams
from ...model.presets import NAMES, preset
from ...runtime.script import counter, run_script
from .arguments import add_workers, parser, seeds_of
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
    """Run the comparison and return the exit code, as ``run_script``."""
    about = (__doc__ or "").partition("\n")[0]
    p = parser(about, "the results of the runs", first_seed=FIRST_SEED, seeds=SEEDS, minutes=MINUTES)
    add_workers(p)
    p.add_argument("--preset", default="paper", metavar="NAME", help=f"of {', '.join(NAMES)}; paper")
    given = p.parse_args(arguments)

    def compare() -> None:
        wanted = list(jobs(preset(given.preset), given.robots, seeds_of(given), given.minutes))
        found = run_jobs(wanted, given.out, workers=given.workers, advance=counter(len(wanted), "runs"))
        keys = {(done.job.robots, done.job.model) for done in found}
        scores = {key: total(done.score for done in found if (done.job.robots, done.job.model) == key) for key in keys}
        print("\n".join(lines(scores)))

    return run_script(compare, f"the same command goes on from what lies in {given.out}")


if __name__ == "__main__":
    sys.exit(main())
