"""Which code made a number: what a resumed table must not mix."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from pathlib import Path

PARTS = ("arena", "engine", "model")
"""Folders of the package on which the outcome of a run depends."""

LIBRARIES = (".so", ".dylib")


@lru_cache(maxsize=1)
def code_hash() -> str:
    """Return twelve hexadecimal digits that change when the arena, the model or the compiled core changes."""
    root = Path(__file__).parents[2]
    files = [path for part in PARTS for path in (root / part).rglob("*") if path.suffix in (".py", *LIBRARIES)]
    whole = hashlib.sha256()
    for path in sorted([*files, root / "params.py", root / "types.py"]):
        whole.update(path.relative_to(root).as_posix().encode() + b"\0" + path.read_bytes())
    return whole.hexdigest()[:12]
