"""What a search is: all that its numbers hang on, kept in its folder, so that two searches are never mixed."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from .._version import __version__
from ..errors import ParameterError
from ..experiments.closed_loop.code_hash import code_hash
from ..landing import whole_file
from ..model.network import NetworkParams
from ..params import settings_hash
from .space import Axis
from .task import Task

FILE = "search.json"


def identity(task: Task, base: NetworkParams, axes: Sequence[Axis], seed: int) -> dict[str, Any]:
    """Return it as plain numbers, texts, lists and dictionaries."""
    found: dict[str, Any] = {
        "on": task.about["on"],
        "measured on": dict(task.identity),
        "parts": {name: asdict(split) for name, split in task.splits.items()},
        "searched": [asdict(axis) for axis in axes],
        "settings": settings_hash(base),
        "seed": seed,
        "version": __version__,
        "code": code_hash(),
    }
    plain: dict[str, Any] = json.loads(json.dumps(found))
    return plain


def require_same(own: Mapping[str, Any], journal: Path) -> None:
    """Check that the file ``journal`` belongs to the search ``own``; where it is empty, begin it.

    Raises
    ------
    ParameterError : it belongs to another search
    OutputError : the folder cannot be written to
    """
    folder = journal.parent
    path = folder / FILE
    if not path.exists():
        if journal.stat().st_size:
            raise ParameterError(f"{folder}: holds {journal.name} without {FILE}: must be another folder")
        with whole_file(path) as temporary:
            temporary.write_text(json.dumps(own, indent=1) + "\n", encoding="utf-8")
        return
    try:
        kept = json.loads(path.read_text(encoding="utf-8"))
        other = [name for name, value in own.items() if kept[name] != value]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ParameterError(f"{path}: is of no search: must be another folder") from error
    if other:
        was, now = (_short(about[other[0]]) for about in (kept, own))
        told = f" ({was}, not {now})" if was and now else ""
        raise ParameterError(
            f"{folder}: was begun with another {other[0]}{told}: must go on as it began, or in another folder"
        )


def _short(value: Any) -> str:
    return "" if isinstance(value, dict | list) else str(value)
