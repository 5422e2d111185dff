"""A state in a file: nested dictionaries and lists of numbers, texts and arrays, as one npz without pickled objects."""

from __future__ import annotations

import json
import os
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from ..landing import whole_file

ARRAY, TUPLE = "#array", "#tuple"
"""Keys that stand for an array, by its number in the file, and for a tuple, in the text that describes the whole, the
file's array 0."""


def save_snapshot(path: str | os.PathLike[str], tree: Mapping[str, Any], *, compressed: bool = False) -> None:
    """Write ``tree`` to ``path``: all of it or, where that fails, nothing; what was there before then stays.

    Raises
    ------
    OutputError : it cannot be written
    ParameterError : ``tree`` holds something other than numbers, texts, arrays, lists and dictionaries
    """
    path = Path(path)
    arrays: list[NDArray[Any]] = []
    text = json.dumps(_packed(tree, arrays, "snapshot"))
    with whole_file(path) as temporary, temporary.open("wb") as file:
        write = np.savez_compressed if compressed else np.savez
        write(file, np.array(text), *arrays)


def load_snapshot(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return what ``save_snapshot`` wrote.

    Raises
    ------
    ParameterError : no such file, or not one of these
    """
    try:
        with np.load(path, allow_pickle=False) as data:
            tree = json.loads(str(data["arr_0"]))
            unpacked: dict[str, Any] = _unpacked(tree, data)
            return unpacked
    except OSError as error:
        raise ParameterError(f"{os.fspath(path)}: cannot be read: {error.strerror or error}") from error
    except (ValueError, KeyError, zipfile.BadZipFile, EOFError) as error:
        raise ParameterError(f"{os.fspath(path)}: is no snapshot of lobula, or a damaged one") from error


def _packed(value: Any, arrays: list[NDArray[Any]], where: str) -> Any:
    """Return ``value`` as JSON can hold it; arrays are put into ``arrays``."""
    if isinstance(value, np.ndarray) and not value.dtype.hasobject:
        arrays.append(value)
        return {ARRAY: len(arrays)}
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, tuple):
        return {TUPLE: [_packed(item, arrays, f"{where}[{n}]") for n, item in enumerate(value)]}
    if isinstance(value, list):
        return [_packed(item, arrays, f"{where}[{n}]") for n, item in enumerate(value)]
    if isinstance(value, Mapping) and all(isinstance(name, str) and name not in (ARRAY, TUPLE) for name in value):
        return {name: _packed(item, arrays, f"{where}.{name}") for name, item in value.items()}
    raise ParameterError(
        f"{where}: is a {type(value).__name__}: must be numbers, texts, arrays, lists, tuples and dictionaries of them"
    )


def _unpacked(value: Any, arrays: Mapping[str, NDArray[Any]]) -> Any:
    if isinstance(value, list):
        return [_unpacked(item, arrays) for item in value]
    if not isinstance(value, dict):
        return value
    if ARRAY in value:
        return arrays[f"arr_{value[ARRAY]}"]
    if TUPLE in value:
        return tuple(_unpacked(item, arrays) for item in value[TUPLE])
    return {name: _unpacked(item, arrays) for name, item in value.items()}
