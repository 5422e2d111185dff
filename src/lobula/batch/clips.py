"""The clips of a batch: the videos below a folder, what a pattern matches, what a list names."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import ParameterError
from ..frames.folder import TIMES_FILE, is_image, natural_order
from .places import MARK

VIDEO_ENDINGS = (
    ".3gp", ".264", ".265", ".asf", ".avi", ".dv", ".flv", ".gif", ".h264", ".h265", ".hevc", ".ivf", ".m2ts", ".m4v",
    ".mjpeg", ".mjpg", ".mkv", ".mov", ".mp4", ".mpeg", ".mpg", ".mts", ".mxf", ".nut", ".ogv", ".ts", ".vob", ".webm",
    ".wmv", ".y4m",
)  # fmt: skip
"""What is taken for a video where a folder is searched; a file that is named itself may have any ending."""

LIST_ENDING = ".txt"
_FEWEST_IMAGES = 2  # one picture in a folder is a poster or a plan, not a clip


@dataclass(frozen=True)
class Clip:
    """A video, or a folder of images, that is to be looked at.

    name : what the manifest calls it: the path as the user would write it
    path : absolute, so that every worker finds it wherever it was started
    problem : why it cannot be looked at, where that is known already
    """

    name: str
    path: Path
    problem: str = ""


def find_clips(sources: Sequence[str], out: Path) -> list[Clip]:
    """Return the clips that ``sources`` name, each once, in their order and in natural order below each.

    A source is a folder, which is searched with all below it; a video or other file; a pattern; or a list of such, one
    a line, in a file that ends in .txt, relative to the folder of the list. A folder that holds images and neither
    videos nor folders is one clip. Hidden files are left out, and so are ``out`` and the outputs of other batches.

    Raises
    ------
    ParameterError : a source that is not there or matches nothing, ``out`` itself, or no clip at all
    """
    found: dict[Path, Clip] = {}
    for source in sources:
        clips = list(_listed(Path(source), out) if source.endswith(LIST_ENDING) else _named(source, out))
        if not clips:
            raise ParameterError(f"{source}: no clip in it: must hold {', '.join(VIDEO_ENDINGS)} files")
        for clip in clips:
            found.setdefault(clip.path, clip)
    if not found:
        raise ParameterError("no clips: must be folders, files, patterns or lists of clips")
    return list(found.values())


def _named(source: str, out: Path) -> Iterator[Clip]:
    path = Path(source)
    if path.is_dir():
        if out.exists() and path.samefile(out):
            raise ParameterError(f"--out {out}: is the folder of the clips itself: must be another")
        yield from _below(path, out, set())
    elif os.path.lexists(path):
        yield _clip(path)
    elif glob.has_magic(source):
        matches = sorted(map(Path, glob.glob(source, recursive=True)), key=natural_order)
        if not matches:
            raise ParameterError(f"{source}: nothing matches: must name at least one clip")
        for match in matches:
            yield from _below(match, out, set()) if match.is_dir() else [_clip(match)]
    else:
        raise ParameterError(f"{source}: no such file or folder")


def _listed(file: Path, out: Path) -> Iterator[Clip]:
    try:
        text = file.read_bytes().decode("utf-8-sig", "surrogateescape")  # a file's name may be any bytes
    except OSError as error:
        reason = "no such file" if isinstance(error, FileNotFoundError) else error.strerror
        raise ParameterError(f"list {file}: {reason}") from error
    if "\0" in text:
        raise ParameterError(f"list {file}: is not text: must name one clip a line")
    for number, line in enumerate(text.splitlines(), 1):
        entry = line.strip()
        if not entry or entry.startswith("#"):
            continue
        path = file.parent / entry
        if not os.path.lexists(path):
            yield Clip(str(path), _absolute(path), f"no such file or folder; line {number} of {file} names it")
        elif path.is_dir():
            yield from _below(path, out, set())
        else:
            yield _clip(path)


def _below(folder: Path, out: Path, above: Iterable[tuple[int, int]]) -> Iterator[Clip]:
    """Yield the clips of ``folder`` and of the folders in it; ``above`` keeps links from leading round in a circle."""
    try:
        about = folder.stat()
        here = {*above, (about.st_dev, about.st_ino)}
        entries = sorted((e for e in folder.iterdir() if not e.name.startswith(".")), key=natural_order)
        folders = {entry for entry in entries if entry.is_dir()}
        ours = (folder / MARK).is_dir()
    except OSError as error:
        yield Clip(str(folder), _absolute(folder), f"cannot be searched: {error.strerror}")
        return
    if (about.st_dev, about.st_ino) in above or ours or (out.exists() and folder.samefile(out)):
        return
    videos = {entry for entry in entries if entry.suffix.lower() in VIDEO_ENDINGS} - folders
    images = [entry for entry in entries if is_image(entry)]
    if not videos and not folders and (len(images) >= _FEWEST_IMAGES or (images and (folder / TIMES_FILE).is_file())):
        yield _clip(folder)
    for entry in entries:
        if entry in folders:
            yield from _below(entry, out, here)
        elif entry in videos:
            yield _clip(entry)


def _clip(path: Path) -> Clip:
    return Clip(str(path), _absolute(path))


def _absolute(path: Path) -> Path:
    return Path(os.path.abspath(path))  # links stay: a clip keeps the name it was given
