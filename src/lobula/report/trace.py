"""The trace of a run: one row a frame, written as it happens, in csv, jsonl, npz or parquet."""

from __future__ import annotations

import errno
import json
from collections.abc import Mapping
from contextlib import suppress
from io import FileIO
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import OutputError, ParameterError
from ..landing import part_of, set_aside, whole_file, writing
from ..runtime.sinks import Picture
from ..types import Reading
from .trace_file import COLUMNS, TRACE_SUFFIXES, pyarrow_parquet, read_trace


def trace_row(index: int, reading: Reading) -> tuple[Any, ...]:
    """Return one row of ``TRACE_DTYPE`` as plain Python numbers."""
    return (
        int(index),
        float(reading.time_s),
        float(reading.lgmd1),
        float(reading.lgmd2),
        float(reading.lptc_r),
        float(reading.lptc_l),
        *map(int, reading.spikes),
        bool(reading.collision),
        str(reading.state),
    )


def facts(header: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a file should remember of the run that made it: the header without its list of settings."""
    return {key: value for key, value in header.items() if key not in ("type", "settings")}


class TraceWriter:
    """Writes the trace to ``path``; its suffix says how.

    Every row is on its way to the disk before the next frame is looked at, so a killed run leaves all its rows: csv
    and jsonl under their own name, npz and parquet as ``NAME.part.csv`` until ``close`` turns it into the file. One
    that an earlier run left is set aside; ``notes`` says so.

    Raises
    ------
    ParameterError : a suffix that is not in ``TRACE_SUFFIXES``
    MissingExtraError : parquet without pyarrow
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        kind = self.path.suffix.lower()
        if kind not in TRACE_SUFFIXES:
            raise ParameterError(f"trace {self.path}: must end in {', '.join(TRACE_SUFFIXES)}")
        if kind == ".parquet":
            pyarrow_parquet()  # asked for now, so that a missing one is not found at the end of the run
        self._kind = kind
        self.rows_path = self.path if kind in (".csv", ".jsonl") else part_of(self.path, ".csv")
        self._file: FileIO | None = None
        self._about: dict[str, Any] = {}
        self.notes: list[str] = []

    def open(self, header: Mapping[str, Any]) -> None:
        """Start the file; an older one of that name is replaced."""
        self._about = facts(header)
        if self.rows_path != self.path:
            self.notes += set_aside(self.rows_path)
        with writing(self.path):
            self._file = FileIO(self.rows_path, "w")
        if self.rows_path.suffix.lower() == ".csv":
            self._write(",".join(COLUMNS))

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Write one row."""
        row = trace_row(index, reading)
        if self._kind == ".jsonl":
            self._write(json.dumps(dict(zip(COLUMNS, row, strict=True)), separators=(",", ":")))
        else:  # bool as 0 or 1: every reader takes that for a number
            self._write(",".join(str(int(v)) if isinstance(v, bool) else str(v) for v in row))

    def event(self, record: Mapping[str, Any]) -> None:
        """Do nothing: the columns ``collision`` and ``state`` say it."""

    def close(self, summary: Mapping[str, Any]) -> None:
        """Close the file; npz and parquet come into being here, all at once."""
        if self._file is None:
            return
        with writing(self.rows_path):
            self._file.close()
        self._file = None
        if self.rows_path == self.path:
            return
        about = {**self._about, "summary": {k: v for k, v in summary.items() if k != "type"}}
        try:
            save = _save_npz if self._kind == ".npz" else _save_parquet
            with whole_file(self.path) as temporary:
                save(temporary, read_trace(self.rows_path), json.dumps(about, default=str))
        except OutputError as error:
            raise OutputError(f"{error}; the rows are in {self.rows_path}") from error
        self.rows_path.unlink()

    def _write(self, line: str) -> None:
        """Write a whole line in one call, or none of it."""
        assert self._file is not None
        data = f"{line}\n".encode()
        with writing(self.path):
            written = 0
            try:
                written = self._file.write(data) or 0
                if written < len(data):
                    raise OSError(errno.ENOSPC, "the disk is full")
            except OSError:
                if written:  # the disk filled up inside the line: take the torn half back
                    with suppress(OSError):
                        self._file.truncate(self._file.tell() - written)
                raise


def _save_npz(path: Path, trace: np.ndarray[Any, Any], about: str) -> None:
    with path.open("wb") as file:
        np.savez_compressed(file, trace=trace, about=np.array(about))


def _save_parquet(path: Path, trace: np.ndarray[Any, Any], about: str) -> None:
    pyarrow = pyarrow_parquet()
    table = pyarrow.table({name: np.ascontiguousarray(trace[name]) for name in COLUMNS})
    pyarrow.parquet.write_table(table.replace_schema_metadata({"lobula": about}), path, compression="zstd")
