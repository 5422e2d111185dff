"""A batch in a few numbers, and as a table with a row for each clip."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from .._version import __version__
from ..errors import OutputError
from ..landing import whole_file
from ..params import settings_hash
from ..report.csv_lines import csv_lines
from ..runtime.interrupts import Interrupted
from .places import manifest_path, summary_path, table_path
from .request import Request
from .row import COLUMNS, Row, now


@dataclass(frozen=True, kw_only=True)
class Summary:
    """What a call came to.

    status : ``ok``, ``some_failed``, ``interrupted`` or ``output_failed``
    clips, ok, failed, unfinished : how many; they add up
    done, kept : clips that were looked at by this call; good results that were there already
    frames, damaged, collisions, footage_s : of all clips together, however they ended
    seconds, busy_s : by the wall; all workers together, on what this call has looked at
    """

    status: str
    clips: int
    ok: int
    failed: int
    unfinished: int
    done: int
    kept: int
    frames: int
    damaged: int
    collisions: int
    footage_s: float
    workers: int
    seconds: float
    busy_s: float
    problem: str
    date: str
    version: str
    preset: str
    settings: str
    settings_hash: str
    code: str
    engine: str
    manifest: str
    table: str

    def as_dict(self) -> dict[str, Any]:
        """Return it as the summary's file holds it."""
        return asdict(self)


def summarise(
    rows: Sequence[Row],
    fresh: Sequence[Row],
    request: Request,
    *,
    workers: int,
    seconds: float,
    stop: Interrupted | OutputError | None,
) -> Summary:
    """Return the summary of ``rows``, of which this call itself has made ``fresh``; ``stop`` is what ended it early."""
    of = {status: [row for row in rows if row.status == status] for status in ("ok", "failed", "unfinished")}
    status = "some_failed" if of["failed"] else "ok"
    if stop is not None:
        status = "interrupted" if isinstance(stop, Interrupted) else "output_failed"
    return Summary(
        status=status, clips=len(rows), ok=len(of["ok"]), failed=len(of["failed"]), unfinished=len(of["unfinished"]),
        done=len(fresh), kept=len(of["ok"]) - sum(row.status == "ok" for row in fresh),
        frames=sum(row.frames for row in rows), damaged=sum(row.damaged for row in rows),
        collisions=sum(row.collisions for row in rows), footage_s=round(sum(row.duration_s for row in rows), 3),
        workers=workers, seconds=round(seconds, 3), busy_s=round(sum(row.seconds for row in fresh), 3),
        problem="" if stop is None else str(stop), date=now(), version=__version__, preset=request.preset,
        settings=request.settings, settings_hash=settings_hash(request.params), code=request.code,
        engine=request.engine, manifest=str(manifest_path(request.out)), table=str(table_path(request.out)),
    )  # fmt: skip


def write_table(rows: Sequence[Row], summary: Summary, out: Path) -> None:
    """Write the table and the summary of a call into ``out``, in place of those of the call before.

    Raises
    ------
    OutputError : one of them cannot be written; it is as it was
    """
    cells = ({name: _cell(value) for name, value in row.as_dict().items()} for row in rows)
    with (
        whole_file(table_path(out)) as temporary,
        # a file's name may be any bytes, and is written as it is
        temporary.open("w", encoding="utf-8", errors="surrogateescape", newline="") as table,
    ):
        table.writelines(csv_lines(COLUMNS, cells))
    with whole_file(summary_path(out)) as temporary:
        temporary.write_text(json.dumps(summary.as_dict(), indent=2) + "\n", encoding="utf-8")


def _cell(value: Any) -> Any:
    if not isinstance(value, tuple):
        return value
    return (" " if all(isinstance(item, float) for item in value) else " ; ").join(map(str, value))
