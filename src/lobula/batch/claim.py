"""Who works at what: one process at a time, of any run in the folder; a process that dies gives up its claims."""

from __future__ import annotations

import fcntl
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..landing import writing
from .lines import lock

_LOCK = ".lock"


@contextmanager
def claimed(folder: Path, key: str) -> Iterator[Path | None]:
    """Give an empty folder of one's own for the work on ``key``, or None while somebody else is at it.

    The folder and all in it are gone when the block ends. The claim is a lock, which the system takes back when its
    process ends in whatever way.

    Raises
    ------
    OutputError : ``folder`` cannot be written into, or its file system has no locks
    """
    path, scratch = folder / f"{key}{_LOCK}", folder / key
    descriptor = _locked(path)
    if descriptor is None:
        yield None
        return
    try:
        shutil.rmtree(scratch, ignore_errors=True)  # of one who was killed
        with writing(scratch):
            scratch.mkdir()
        yield scratch
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
        with suppress(OSError):
            path.unlink()
        os.close(descriptor)


def sweep(folder: Path) -> None:
    """Clear away what killed processes have left in ``folder``; what is under way stays."""
    for path in folder.glob(f"*{_LOCK}"):
        with claimed(folder, path.name.removesuffix(_LOCK)):
            pass


def _locked(path: Path) -> int | None:
    """Lock ``path``, made if it is not there, and return its descriptor; None: somebody else has it."""
    while True:
        with writing(path):
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        try:
            lock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB, path)
            if _is(path, descriptor):
                return descriptor
        except BlockingIOError:
            os.close(descriptor)
            return None
        except BaseException:
            os.close(descriptor)
            raise
        os.close(descriptor)  # whoever had it before has removed the file meanwhile: a lock on nothing


def _is(path: Path, descriptor: int) -> bool:
    try:
        named, held = path.stat(), os.fstat(descriptor)
    except FileNotFoundError:
        return False
    return (named.st_dev, named.st_ino) == (held.st_dev, held.st_ino)
