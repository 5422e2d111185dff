"""Events of runs as rows of a CSV file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from numpy.typing import NDArray

from ...arena.events import EVENT_DTYPE, name_of
from ...report.csv_lines import csv_lines

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


def _cell(name: str, value: Any) -> Any:
    if name in _CODES:
        return name_of(value)
    if isinstance(value, float):
        return "" if value != value else round(value, 4)
    return int(value) if isinstance(value, bool) else value
