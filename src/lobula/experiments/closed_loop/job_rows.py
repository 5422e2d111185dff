"""Jobs as rows of a CSV file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Any

from ...params import settings_hash
from ...report.csv_lines import csv_lines
from .event_rows import COLUMNS, event_rows
from .jobs import Done

ABOUT = ("model", "robots", "seed")


def job_lines(results: Iterable[Done]) -> Iterator[str]:
    """Yield the lines of a CSV file with one job each: what it was, its score, and the seconds it took."""
    rows = [
        {
            **_about(done),
            "minutes": done.job.minutes,
            "driver": done.job.driver_hash,
            "world": settings_hash(done.job.world),
            **{
                name: round(value, 6) if isinstance(value, float) else value
                for name, value in done.score.as_dict().items()
            },
            **{f"seconds_{part}": round(spent, 2) for part, spent in done.seconds.items()},
        }
        for done in results
    ]
    yield from csv_lines(dict.fromkeys(chain.from_iterable(rows)), rows)


def all_event_lines(results: Iterable[Done]) -> Iterator[str]:
    """Yield the lines of a CSV file with every event of every job."""
    rows = (row for done in results for row in event_rows(done.events, _about(done)))
    yield from csv_lines((*ABOUT, *COLUMNS), rows)


def _about(done: Done) -> dict[str, Any]:
    return {"model": done.job.model, "robots": done.job.robots, "seed": done.job.seed}
