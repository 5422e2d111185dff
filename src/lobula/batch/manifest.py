"""The manifest: what was finished, in this call or any before, in any run at work in the same folder."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection
from pathlib import Path

from .lines import Lines
from .places import manifest_path
from .row import Row, row_of


class Manifest:
    """Looks rows up in the manifest of ``out`` and adds to it."""

    def __init__(self, out: Path) -> None:
        self._out = out
        self._lines = Lines(manifest_path(out))
        self._done: defaultdict[tuple[str, str, str], list[Row]] = defaultdict(list)

    def find(self, key: tuple[str, str, str], outputs: Collection[str]) -> Row | None:
        """Return the latest good row of ``key`` that names a file for each of ``outputs`` (suffixes), if all are there.

        Raises
        ------
        OutputError : the manifest cannot be read
        """
        for record in self._lines.new():
            row = row_of(record)
            if row is not None and row.status == "ok":
                self._done[row.key].append(row)
        return next((row for row in reversed(self._done.get(key, ())) if self._has(row, outputs)), None)

    def add(self, row: Row) -> None:
        """Add a row.

        Raises
        ------
        OutputError : it cannot be written
        """
        self._lines.add(row.as_dict())

    def _has(self, row: Row, outputs: Collection[str]) -> bool:
        named = [name for name in (row.events, row.trace, row.annotated) if name]
        return all(any(name.endswith(suffix) for name in named) for suffix in outputs) and all(
            (self._out / name).is_file() for name in named if name.endswith(tuple(outputs))
        )
