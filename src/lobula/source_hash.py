"""Which code made a number: what results that are added to later must not mix."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from pathlib import Path

LIBRARIES = (".so", ".dylib")

SHARED = ("params.py", "types.py")
"""Files that every part rests on."""


@lru_cache(maxsize=8)
def source_hash(*parts: str) -> str:
    """Return twelve hexadecimal digits that change when one of ``parts``, folders of the package, changes.

    Python files and compiled libraries count; the file names are part of it, the folder of the package is not.
    """
    root = Path(__file__).parent
    files = [path for part in parts for path in (root / part).rglob("*") if path.suffix in (".py", *LIBRARIES)]
    whole = hashlib.sha256()
    for path in sorted([*files, *(root / name for name in SHARED)]):
        whole.update(path.relative_to(root).as_posix().encode() + b"\0" + path.read_bytes())
    return whole.hexdigest()[:12]
