"""A batch as text for people, and as a document for programs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePath
from typing import Any

from ..batch import Ended, Row
from .counted import counted
from .table import table

MOST_CLIPS = 30
"""So many clips have a row each in the table; of more, each folder has one."""

_CLIP_COLUMNS = ("clip", "status", "frames", "duration_s", "collisions", "alarms_s")
_FOLDER_COLUMNS = ("folder", "clips", "failed", "frames", "minutes", "collisions", "alarmed")
_MOST_ALARMS = 5


def as_text(ended: Ended) -> str:
    """Return the table, and the batch in two sentences."""
    rows = ended.rows
    return f"{_clips(rows) if len(rows) <= MOST_CLIPS else _folders(rows)}\n\n{_headline(ended)}"


def document(ended: Ended) -> dict[str, Any]:
    """Return summary and rows as plain dictionaries, lists and numbers."""
    return {**ended.summary.as_dict(), "rows": [row.as_dict() for row in ended.rows]}


def failure(row: Row) -> str:
    """Return in one line which clip failed, and why."""
    return f"{printable(row.file)}: {printable(row.problem)}"


def printable(text: str) -> str:
    """Return ``text`` in one line that every terminal takes, whatever bytes a file's name is made of."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def _clips(rows: Sequence[Row]) -> str:
    return table(_CLIP_COLUMNS, [_clip(row) for row in rows], right="frames duration_s collisions")


def _clip(row: Row) -> tuple[object, ...]:
    if row.status == "unfinished":
        return printable(row.file), row.status, "", "", "", ""
    alarms = [f"{time_s:.2f}" for time_s in row.alarms_s[:_MOST_ALARMS]]
    if len(row.alarms_s) > _MOST_ALARMS:
        alarms.append("...")
    return printable(row.file), row.status, row.frames, f"{row.duration_s:.1f}", row.collisions, " ".join(alarms)


def _folders(rows: Sequence[Row]) -> str:
    folders: dict[str, list[Row]] = {}
    for row in rows:
        folders.setdefault(str(PurePath(row.file).parent), []).append(row)
    lines = [_folder(name, inside) for name, inside in folders.items()]
    if len(lines) > 1:
        lines.append(_folder("all", rows))
    return table(_FOLDER_COLUMNS, lines, right=" ".join(_FOLDER_COLUMNS[1:]))


def _folder(name: str, rows: Sequence[Row]) -> tuple[object, ...]:
    return (
        printable(name),
        len(rows),
        sum(row.status == "failed" for row in rows),
        sum(row.frames for row in rows),
        f"{sum(row.duration_s for row in rows) / 60:.1f}",
        sum(row.collisions for row in rows),
        sum(row.collisions > 0 for row in rows),
    )


def _headline(ended: Ended) -> str:
    s = ended.summary
    counts = [f"{s.ok} ok", *([f"{s.failed} failed"] if s.failed else [])]
    counts += [f"{s.unfinished} not finished"] if s.unfinished else []
    there = f", {s.kept} of them not done again" if s.kept else ""
    lines = [f"{counted(s.clips, 'clip')}: {', '.join(counts)}{there}; {counted(s.collisions, 'collision')} in "
             f"{s.footage_s / 60:.1f} minutes of video"]  # fmt: skip
    frames = sum(row.frames for row in ended.rows)
    lines.append(f"{s.seconds:.1f} s with {counted(s.workers, 'worker')}; {counted(frames, 'frame')}; table: {s.table}")
    return "\n".join(lines)
