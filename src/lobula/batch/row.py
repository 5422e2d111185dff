"""One line of the manifest: a clip, what was asked, and how it went."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from datetime import UTC, datetime
from typing import Any, Literal

Status = Literal["ok", "failed", "unfinished"]


@dataclass(frozen=True, kw_only=True)
class Row:
    """How one clip went.

    file : its name
    status : ``ok``; ``failed``, what was read until then is there; ``unfinished``, in the table of a call cut short
    frames, damaged : looked at; could not be decoded
    duration_s : time that the frames cover
    collisions, alarms_s : how many, and when each started
    seconds : spent on it, reading and writing included
    content : SHA-256, of a folder that of its list; empty where it could not be read
    settings, code, version : hashes of all that was asked and of the code; of lobula
    date : when it was finished, UTC
    events, trace, annotated : the files that were written, below the output folder; empty where there is none
    problem : in one line, where it failed
    notes : what was odd
    """

    file: str
    status: Status
    frames: int = 0
    damaged: int = 0
    duration_s: float = 0.0
    collisions: int = 0
    alarms_s: tuple[float, ...] = ()
    seconds: float = 0.0
    content: str = ""
    settings: str = ""
    code: str = ""
    version: str = ""
    date: str = ""
    events: str = ""
    trace: str = ""
    annotated: str = ""
    problem: str = ""
    notes: tuple[str, ...] = ()

    @property
    def key(self) -> tuple[str, str, str]:
        """What the numbers depend on."""
        return self.content, self.settings, self.code

    def as_dict(self) -> dict[str, Any]:
        """Return it as the manifest holds it."""
        return asdict(self)


COLUMNS: tuple[str, ...] = tuple(f.name for f in fields(Row))


_TEXTS = ("file", "content", "settings", "code", "events", "trace", "annotated")


def row_of(record: Mapping[str, Any]) -> Row | None:
    """Return the row that a line of the manifest holds; None where it holds none, as after another hand was at it."""
    kept: dict[str, Any] = {name: tuple(value) if isinstance(value, list) else value for name, value in record.items()}
    try:
        row = Row(**{name: value for name, value in kept.items() if name in COLUMNS})
    except TypeError:
        return None
    texts = all(isinstance(getattr(row, name), str) for name in _TEXTS)
    return row if texts and row.status in ("ok", "failed") else None


def now() -> str:
    """Return the date and time, UTC, to the second."""
    return datetime.now(UTC).isoformat(timespec="seconds")
