"""Which runs were made in a folder: one line of JSON each, only ever added to."""

from __future__ import annotations

import json
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ..._version import __version__
from ...landing import writing
from .code_hash import code_hash


def note(folder: Path, what: str, about: Mapping[str, Any]) -> None:
    """Add a line to ``runs.ndjson`` in ``folder``: the date, lobula's version and code, and ``about``.

    Raises
    ------
    OutputError : it cannot be written
    """
    now = datetime.now(UTC).isoformat(timespec="seconds")
    line = {"date": now, "what": what, "version": __version__, "code": code_hash(), **about}
    path = folder / "runs.ndjson"
    with writing(path), path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(line, allow_nan=False) + "\n")
