"""The options that the command lines of the closed loop share: which seeds, how long, how many robots."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...errors import ParameterError
from ...workers import cores
from .paper_table import DENSITIES

FIRST_SEED, SEEDS, MINUTES = 101, 5, 5.0


def parser(
    about: str, out: str, *, first_seed: int = FIRST_SEED, seeds: int = SEEDS, minutes: float = MINUTES
) -> argparse.ArgumentParser:
    """Return a parser of the shared options with these defaults; ``out`` says what the folder is for."""
    p = argparse.ArgumentParser(description=about)
    p.add_argument("--out", type=Path, required=True, metavar="DIR", help=f"folder for {out}")
    p.add_argument("--seeds", type=int, default=seeds, metavar="N", help=f"runs of each variant; {seeds}")
    p.add_argument("--first-seed", type=int, default=first_seed, metavar="N", help=f"{first_seed}, for calibration")
    p.add_argument("--minutes", type=float, default=minutes, metavar="MIN", help=f"simulated, of each run; {minutes:g}")
    densities = " ".join(map(str, DENSITIES))
    p.add_argument("--robots", type=int, nargs="+", default=DENSITIES, metavar="N", help=f"numbers; {densities}")
    return p


def add_workers(p: argparse.ArgumentParser) -> None:
    """Add ``--workers``, for what runs in several processes."""
    p.add_argument("--workers", type=int, default=cores(), metavar="N", help="processes; one a core")


def seeds_of(given: argparse.Namespace) -> range:
    """Return the seeds asked for.

    Raises
    ------
    ParameterError : none are
    """
    if given.seeds < 1:
        raise ParameterError(f"--seeds {given.seeds}: must be 1 or more")
    return range(given.first_seed, given.first_seed + given.seeds)
