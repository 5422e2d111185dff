"""Events of runs as rows of a CSV file."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from numpy.typing import NDArray

from ...arena.events import EVENT_DTYPE, name_of

COLUMNS: tuple[str, ...] = tuple(EVENT_DTYPE.names or ())
"""Of an event, in their order."""

_CODES = ("other", "geometric_other")


def event_rows(events: NDArray[Any], about: Mapping[str, Any] | None = None) -> Iterator[dict[str, Any]]:
    """Yield a row for each of ``events`` (N,) EVENT_DTYPE, after the columns of ``about``, the same in every row.

    Robots and what they met are told in words; a number that is not known is left empty.
    """
    for event in events.tolist():
        row = dict(zip(COLUMNS, event, strict=True))
        yield {**(about or {}), **{name: _cell(name, value) for name, value in row.items()}}


def event_lines(events: NDArray[Any]) -> Iterator[str]:
    """Yield the lines of a CSV file with a heading and one event each."""
    yield from csv_lines(COLUMNS, event_rows(events))


def csv_lines(columns: Iterable[str], rows: Iterable[Mapping[str, Any]]) -> Iterator[str]:
    """Yield the heading and ``rows`` as lines of a CSV file; a row may lack a column."""
    text = io.StringIO()
    writer = csv.DictWriter(text, list(columns), restval="", lineterminator="\n")
    writer.writeheader()
    for row in rows:
        writer.writerow(row)
        yield text.getvalue()
        text.seek(0)
        text.truncate()
    yield text.getvalue()


def _cell(name: str, value: Any) -> Any:
    if name in _CODES:
        return name_of(value)
    if isinstance(value, float):
        return "" if value != value else round(value, 4)
    return int(value) if isinstance(value, bool) else value
