"""The table1 of ``lobula reproduce``: the options made into a plan, and the plan run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import ParameterError
from ..workers import MOST_WORKERS, cores

if TYPE_CHECKING:
    from ..experiments.closed_loop.table_jobs import TablePlan

TABLE = "table1"
PRESET, OWN = "paper", "lobula"
"""The table is made of these: the paper's three models of a base preset, where no other is asked for, and our own."""


def table_plan(
    count: int | None, quick: bool, preset: str | None, minutes: float | None, first_seed: int | None,
    workers: int | None,
) -> TablePlan:  # fmt: skip
    """Return what the options ask for: the protocol's seeds and hours, or a quick look; ``workers`` is but checked.

    Raises
    ------
    ParameterError : a value out of range
    """
    from ..experiments.closed_loop import table1
    from ..experiments.closed_loop.table_jobs import TablePlan
    from ..experiments.closed_loop.table_page import TEST_SEEDS
    from ..model.presets import BASES
    from ..model.presets import preset as named_preset

    if preset is not None and preset not in BASES:
        raise ParameterError(f"--preset {preset}: must be one of {', '.join(BASES)}")
    if workers is not None and not 1 <= workers <= MOST_WORKERS:
        raise ParameterError(f"--workers {workers}: must be 1 to {MOST_WORKERS}")
    name = PRESET if preset is None else preset
    first = table1.QUICK_FIRST_SEED if quick else table1.FIRST_SEED
    repeats = table1.QUICK_SEEDS if quick else table1.SEEDS
    length = table1.QUICK_MINUTES if quick else table1.MINUTES
    length = length if minutes is None else minutes
    if not 0 < length <= 1000:
        raise ParameterError(f"--minutes {length:g}: must be above 0 and at most 1000")
    seeds = table1.seeds(first if first_seed is None else first_seed, repeats if count is None else count)
    if quick and any(seed in TEST_SEEDS for seed in seeds):
        raise ParameterError(
            f"--quick with seeds {seeds[0]} to {seeds[-1]}: must not use 7000 to 7999, kept for the table"
        )
    own = {OWN: named_preset(OWN)}
    return TablePlan(presets={name: named_preset(name)}, own=own, seeds=seeds, minutes=length)


def make_table(plan: TablePlan, folder: Path, quick: bool, workers: int | None) -> dict[str, Any]:
    """Run ``plan`` and write its files into ``folder``; interrupted, say how to go on."""
    from ..experiments.closed_loop.table1 import make
    from ..runtime.interrupts import Interrupted
    from .progress import say, screen

    with screen(plan.job_count, "runs of the arena") as here:
        try:
            return make(
                plan, folder, quick=quick, workers=cores() if workers is None else workers,
                advance=here.advance,
            )  # fmt: skip
        except Interrupted:
            say(f"lobula: what is finished lies in {folder}; the same command goes on from there")
            raise
