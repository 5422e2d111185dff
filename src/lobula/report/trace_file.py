"""A saved trace, read back: the same table whichever of the four formats it was written in."""

from __future__ import annotations

import csv
import importlib
import json
import zipfile
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import FrameSourceError, MissingExtraError, ParameterError, pip_install
from ..types import STATES, TRACE_DTYPE

COLUMNS: tuple[str, ...] = TRACE_DTYPE.names or ()
TRACE_SUFFIXES = (".csv", ".jsonl", ".npz", ".parquet")


def _state(text: str) -> str:
    if text not in STATES:
        raise ValueError(text)
    return text


_TRUE_FALSE = {"0": False, "1": True, "false": False, "true": True}
_CAST: Mapping[str, Callable[[str], Any]] = {
    "i": int,
    "f": float,
    "b": lambda text: _TRUE_FALSE[text.lower()],
    "U": _state,
}


def read_trace(path: str | Path) -> NDArray[np.void]:
    """Return the trace saved at ``path`` as a structured array of ``TRACE_DTYPE``, one row a frame.

    Columns may come in any order and others may stand beside them. A last line that a crash has torn is left out.

    Raises
    ------
    ParameterError : a suffix that is not csv, jsonl, npz or parquet
    FrameSourceError : the file is missing or unreadable, lacks a column, or a value is not what its column holds
    MissingExtraError : parquet without pyarrow
    """
    return _read(Path(path))[0]


def read_about(path: str | Path) -> dict[str, Any]:
    """Return what the file at ``path`` remembers of its run: source, preset, settings hash, version.

    csv and jsonl hold rows only: for them the answer is empty. Raises as ``read_trace``.
    """
    return _read(Path(path))[1]


def _read(path: Path) -> tuple[NDArray[np.void], dict[str, Any]]:
    readers = dict(zip(TRACE_SUFFIXES, (_read_csv, _read_jsonl, _read_npz, _read_parquet), strict=True))
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise ParameterError(f"trace {path}: must end in {', '.join(TRACE_SUFFIXES)}")
    try:
        return reader(path)
    except OSError as error:
        if isinstance(error, FrameSourceError):
            raise
        reason = "no such file" if isinstance(error, FileNotFoundError) else error.strerror or error
        raise FrameSourceError(f"trace {path}: cannot be read: {reason}") from error
    except (ValueError, EOFError, zipfile.BadZipFile) as error:
        raise FrameSourceError(f"trace {path}: is not a {path.suffix} file: {' '.join(str(error).split())}") from error


def pyarrow_parquet() -> Any:
    """Return the module ``pyarrow`` with its part ``parquet`` loaded.

    Raises
    ------
    MissingExtraError : it is not installed
    """
    try:
        importlib.import_module("pyarrow.parquet")
    except ImportError as error:
        raise MissingExtraError(f"a .parquet trace needs pyarrow: {pip_install('parquet')}") from error
    return importlib.import_module("pyarrow")


def _read_csv(path: Path) -> tuple[NDArray[np.void], dict[str, Any]]:
    header, _, text = _text(path).partition("\n")
    if not header and not text:
        raise FrameSourceError(f"trace {path}: is empty")
    names = next(csv.reader([header]), [])
    _require_columns(path, names)

    def parse(line: str) -> dict[str, str]:
        return dict(zip(names, next(csv.reader([line])), strict=True))

    return _table(path, text, parse, first_line=2), {}


def _read_jsonl(path: Path) -> tuple[NDArray[np.void], dict[str, Any]]:
    def parse(line: str) -> dict[str, str]:
        record = json.loads(line)
        _require_columns(path, record if isinstance(record, Mapping) else ())
        return {name: str(record[name]) for name in COLUMNS}

    return _table(path, _text(path), parse, first_line=1), {}


def _text(path: Path) -> str:
    return path.read_bytes().decode("utf-8-sig").replace("\r\n", "\n")


def _table(path: Path, text: str, parse: Callable[[str], Mapping[str, str]], *, first_line: int) -> NDArray[np.void]:
    table = []
    lines = text.split("\n")  # a file that ends well ends in a line break, so its last item here is empty
    for number, line in enumerate(lines, first_line):
        if not line:
            continue
        try:
            record = parse(line)
            table.append(tuple(_CAST[TRACE_DTYPE[name].kind](record[name]) for name in COLUMNS))
        except (ValueError, KeyError) as error:
            if number == first_line + len(lines) - 1:
                break
            raise FrameSourceError(f"trace {path}: line {number}: not a row of a trace: {line[:120]}") from error
    return np.array(table, TRACE_DTYPE)


def _read_npz(path: Path) -> tuple[NDArray[np.void], dict[str, Any]]:
    with np.load(path, allow_pickle=False) as file:
        if not isinstance(file, np.lib.npyio.NpzFile) or "trace" not in file:
            raise FrameSourceError(f"trace {path}: holds no trace: must be what lobula run --trace wrote")
        trace = file["trace"]
        about = json.loads(str(file["about"])) if "about" in file else {}
    _require_columns(path, trace.dtype.names or ())
    return _from_columns(trace), about


def _read_parquet(path: Path) -> tuple[NDArray[np.void], dict[str, Any]]:
    pyarrow = pyarrow_parquet()
    with path.open("rb") as file:
        table = pyarrow.parquet.read_table(file)
    _require_columns(path, table.column_names)
    about = json.loads((table.schema.metadata or {}).get(b"lobula", b"{}"))
    return _from_columns({name: table[name].to_numpy() for name in COLUMNS}), about


def _from_columns(columns: Any) -> NDArray[np.void]:
    trace = np.empty(len(columns[COLUMNS[0]]), TRACE_DTYPE)
    for name in COLUMNS:
        trace[name] = columns[name]
    return trace


def _require_columns(path: Path, names: Iterable[str]) -> None:
    missing = [name for name in COLUMNS if name not in names]
    if missing:
        raise FrameSourceError(
            f"trace {path}: lacks {', '.join(missing)}: must be a trace as `lobula run --trace` writes it"
        )
