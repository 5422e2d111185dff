"""A folder for films while a search lasts."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from ..landing import writing

PREFIX = ".films-"


@contextmanager
def scratch(folder: Path) -> Iterator[Path]:
    """Give a new folder inside ``folder``; it goes when the context ends, and so do those of killed processes.

    Raises
    ------
    OutputError : it cannot be made
    """
    with writing(folder):
        for left_behind in folder.glob(f"{PREFIX}*"):
            shutil.rmtree(left_behind, ignore_errors=True)
        made = TemporaryDirectory(prefix=PREFIX, dir=folder, ignore_cleanup_errors=True)
    with made as name:
        yield Path(name)
