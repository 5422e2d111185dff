"""How a file lands on disk: whole or not at all, and with one clear line when it cannot."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import OutputError


@contextmanager
def writing(path: Path, *also: type[Exception]) -> Iterator[None]:
    """Turn an OSError (or one of ``also``) into one line that names ``path`` and the reason.

    Raises
    ------
    OutputError : anything in the block failed to write
    """
    failures: tuple[type[Exception], ...] = (OSError, *also)
    try:
        yield
    except OutputError:
        raise
    except failures as error:
        raise OutputError(f"cannot write {path}: {_reason(error, path)}") from error


def _reason(error: Exception, path: Path) -> str:
    number = getattr(error, "errno", None)
    if number == errno.ENOENT and not path.parent.is_dir():
        return f"no such folder {path.parent}"
    known = {
        errno.ENOSPC: "the disk is full",
        errno.EACCES: "no permission",
        errno.EROFS: "the disk is read-only",
        errno.EISDIR: "it is a folder",
        errno.ENOENT: "no file can be made there",
        errno.ENOTDIR: f"{path.parent} is not a folder",
    }
    return known.get(number or 0) or str(getattr(error, "strerror", None) or error)


def make_empty(path: Path) -> None:
    """Make a file, or empty it; a named pipe that nobody reads holds nobody up.

    Raises
    ------
    OutputError : nothing can be written there
    """
    with writing(path):
        os.close(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_NONBLOCK, 0o666))


def part_of(path: Path, suffix: str | None = None) -> Path:
    """Return the name a file has while it is being written: ``clip.mp4`` -> ``clip.part.mp4``."""
    return path.with_name(f"{path.stem}.part{suffix or path.suffix}")


def set_aside(part: Path) -> list[str]:
    """Give what an earlier run left at ``part`` the next free name, and return one line that says so.

    ``clip.part.mp4`` -> ``clip.part-2.mp4``. Nothing is done or said where nothing is lost: no file, or an empty one.

    Raises
    ------
    OutputError : it cannot be renamed
    """
    with writing(part):
        if not part.is_file() or part.stat().st_size == 0:
            return []
        number = 2
        while (aside := part.with_name(f"{part.stem}-{number}{part.suffix}")).exists():
            number += 1
        part.rename(aside)
    return [f"{part} was left by an earlier run: it is {aside} now"]


@contextmanager
def whole_file(path: Path, *also: type[Exception]) -> Iterator[Path]:
    """Give a temporary name beside ``path`` to write to, and ``land`` it as ``path`` when the block ends well.

    Raises
    ------
    OutputError : the file cannot be written; the temporary one is removed and ``path`` is as it was
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise OutputError(f"cannot write {path}: it is no ordinary file, and would be replaced by one")
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    with writing(path, *also):
        try:
            yield temporary
            land(temporary, path)
        finally:
            temporary.unlink(missing_ok=True)


def land(temporary: Path, path: Path) -> None:
    """Give a finished file its name; what had that name before is replaced.

    The data is on the disk before the name is, so a power cut leaves the old file or the new one, not half of one.

    Raises
    ------
    OutputError : it cannot be done
    """
    with writing(path):
        with temporary.open("rb") as written:
            os.fsync(written.fileno())
        temporary.replace(path)
