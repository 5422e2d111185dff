"""What a clip holds, as a hash: a file that was moved or renamed is the same clip, one that was changed is another."""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Sequence
from pathlib import Path
from stat import S_ISREG

from ..errors import FrameSourceError
from ..frames.folder import TIMES_FILE, folder_images
from .lines import Lines

_SETTLED_S = 2.0  # a file written at this very moment may change again and keep its time stamp


class Contents:
    """Tells the content of clips and keeps it in ``path``, so that a clip that was not touched is not read again.

    Untouched is a file whose device, number, size and both times are what they were.
    """

    def __init__(self, path: Path) -> None:
        self._lines = Lines(path)
        self._known: dict[str, str] = {}

    def of(self, clip: Path) -> str:
        """Return the content of ``clip``: SHA-256 of a file; of a folder that of its images' SHA-256 and names.

        Raises
        ------
        FrameSourceError : it cannot be read
        OutputError : what was learnt cannot be kept
        """
        files = files_of(clip)
        mark, touched_s = stamp(clip, files)
        for record in self._lines.new() if mark not in self._known else ():
            if isinstance(record.get("stamp"), str) and isinstance(record.get("content"), str):
                self._known[record["stamp"]] = record["content"]
        if mark not in self._known:
            settled = touched_s < time.time() - _SETTLED_S
            content = _content(clip, files)
            if not settled:
                return content
            self._lines.add({"stamp": mark, "content": content})
            self._known[mark] = content
        return self._known[mark]


def files_of(clip: Path) -> list[Path]:
    """Return the files that a clip is made of: itself, or the images of a folder and their times.

    Raises
    ------
    FrameSourceError : it is not there, holds no images, or is neither a file nor a folder
    """
    try:
        if not clip.is_dir():
            if not S_ISREG(clip.stat().st_mode):
                raise FrameSourceError(f"{clip}: is neither a file nor a folder: must be a video or a folder of images")
            return [clip]
        images, times_s = folder_images(clip)
        return images if times_s is None else [clip / TIMES_FILE, *images]
    except FrameSourceError:
        raise
    except OSError as error:
        raise _unreadable(clip, error) from error


def stamp(clip: Path, files: Sequence[Path]) -> tuple[str, float]:
    """Return what changes when any of ``files`` is touched, and when the last of them was, s.

    Raises
    ------
    FrameSourceError : one of them is not there
    """
    whole, touched_ns = hashlib.sha256(), 0
    try:
        for file in files:
            s = file.stat()
            facts = (s.st_dev, s.st_ino, s.st_size, s.st_mtime_ns, s.st_ctime_ns)
            whole.update(repr((os.path.relpath(file, clip), *facts)).encode("utf-8", "surrogateescape"))
            touched_ns = max(touched_ns, s.st_mtime_ns, s.st_ctime_ns)
    except OSError as error:
        raise _unreadable(clip, error) from error
    return whole.hexdigest()[:32], touched_ns / 1e9


def sha256(file: Path) -> str:
    """Return the SHA-256 of a file, as ``sha256sum`` prints it."""
    with file.open("rb") as data:
        return hashlib.file_digest(data, "sha256").hexdigest()


def _content(clip: Path, files: Sequence[Path]) -> str:
    try:
        if files == [clip]:
            return sha256(clip)
        whole = hashlib.sha256()
        for file in files:
            whole.update(f"{sha256(file)}  {os.path.relpath(file, clip)}\n".encode("utf-8", "surrogateescape"))
        return whole.hexdigest()
    except OSError as error:
        raise _unreadable(clip, error) from error


def _unreadable(clip: Path, error: OSError) -> FrameSourceError:
    known = {"FileNotFoundError": "no such file or folder", "PermissionError": "no permission to read it"}
    return FrameSourceError(f"{clip}: {known.get(type(error).__name__) or error.strerror or error}")
