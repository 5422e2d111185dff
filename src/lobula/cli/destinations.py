"""Where outputs go, looked at before anything is read: no output may take the place of what is read."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from ..errors import OutputError, ParameterError

Inputs = Mapping[str, str | Path | None]
"""What is read, by what it is called: a path, a pattern, or None; cameras, pipes and addresses name no file."""


_OPENED_FIRST = ("--trace", "hook ")
"""Options whose files are opened before the work, under their own names: one that is there needs no new file."""


def check_files(outputs: Mapping[str, Path | None], inputs: Inputs | None = None, made: Path | None = None) -> None:
    """Check the files that are to be written, by their option; ``made`` is a folder that will be there by then.

    Raises
    ------
    ParameterError : an output is one of the inputs or another output, is a folder, or lies where no file can be made
    """
    from ..landing import part_of

    read = {identity: what for what, source in (inputs or {}).items() for identity in _identities(_files_of(source))}
    taken: dict[Path, str] = {}
    for option, path in outputs.items():
        if path is None:
            continue
        if path.is_dir():
            raise ParameterError(f"{option} {path}: is a folder, must be a file")
        for written in (path, part_of(path)):  # the second while the work goes on
            for identity in _identities([written]):
                if identity in read:
                    raise ParameterError(
                        f"{option} {path}: would overwrite {written}, which is the {read[identity]} "
                        "itself: must be another file"
                    )
        if not path.parent.is_dir() and (made is None or path.parent.resolve() != made.resolve()):
            raise ParameterError(f"cannot write {path}: no such folder {path.parent}")
        if path.parent.is_dir() and not option.startswith(_OPENED_FIRST):
            _try_folder(path)
        if path.resolve() in taken:
            raise ParameterError(f"{option} {path}: is written by {taken[path.resolve()]} too: must be another file")
        taken[path.resolve()] = option


def check_ending(option: str, path: Path, endings: Sequence[str]) -> None:
    """Check that a file that is to be written is of a kind that can be written.

    Raises
    ------
    ParameterError : another ending
    """
    if path.suffix.lower() not in endings:
        raise ParameterError(f"{option} {path}: must end in {', '.join(endings)}")


def check_folder(option: str, folder: Path) -> None:
    """Check a folder that is to be made if it is not there.

    Raises
    ------
    ParameterError : it, or what it lies in, is a file
    """
    there = next((path for path in (folder, *folder.parents) if path.exists()), folder)
    if there.exists() and not there.is_dir():
        raise ParameterError(f"{option} {folder}: {there} is a file, must be a folder")


def make_folder(option: str, folder: Path) -> None:
    """Make the folder and see, before the work, that files can be written into it.

    Raises
    ------
    ParameterError : it, or what it lies in, is a file
    OutputError : it cannot be made, or not be written into
    """
    from ..landing import writing

    check_folder(option, folder)
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    if not os.access(folder, os.W_OK | os.X_OK):
        raise OutputError(f"cannot write {folder}: no permission")


def _try_folder(path: Path) -> None:
    """See that files can be made beside ``path``: what permissions say is not all that forbids it."""
    from tempfile import TemporaryFile

    from ..landing import writing

    try:
        with writing(path), TemporaryFile(dir=path.parent):
            pass
    except OutputError as error:
        raise ParameterError(f"{error}: must lie in a folder that files can be made in") from error


def _files_of(source: str | Path | None) -> Iterable[Path]:
    """The files that a source names: itself, a folder's images and their times, or its bag, what a pattern matches."""
    from ..frames.folder import IMAGE_ENDINGS, TIMES_FILE
    from ..frames.inputs import BAG_ENDINGS

    if source is None:
        return []
    path = Path(str(source).removeprefix("file://"))
    if path.is_dir():
        return [p for p in path.iterdir() if p.suffix.lower() in (*IMAGE_ENDINGS, *BAG_ENDINGS) or p.name == TIMES_FILE]
    return [path] if path.exists() else map(Path, glob.glob(str(path), recursive=True))


def _identities(paths: Iterable[Path]) -> list[tuple[int, int]]:
    """Device and number of each file that is there: the same for a link to it or another way of writing its path."""
    found = [path.stat() for path in paths if path.exists()]
    return [(one.st_dev, one.st_ino) for one in found]
