"""Pictures from image files: a folder, or the files a pattern names, in natural order."""

from __future__ import annotations

import csv
import glob
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..errors import FrameSourceError
from .selection import Picture
from .stills import read_still

IMAGE_ENDINGS = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".pgm", ".ppm", ".webp")
TIMES_FILE = "times.csv"
DEFAULT_RATE_HZ = 30.0
MOST_NAMED = 20
"""Damaged files that are named; the others are counted."""


def natural_order(path: Path) -> list[tuple[int, int, str]]:
    """Return the key that sorts frame2.png before frame10.png."""
    pieces = re.split(r"(\d+)", str(path))
    return [(0, int(p), p) if p.isdecimal() else (1, 0, p.casefold()) for p in pieces]


def open_folder(folder: Path, rate_hz: float | None) -> FolderReader:
    """Open the images of a folder; its times.csv (columns file, time_s), if any, gives their order and stamps.

    An explicit ``rate_hz`` goes before times.csv.

    Raises
    ------
    FrameSourceError : no images, or a times.csv that does not fit them
    """
    files, times_s = folder_images(folder, timed=rate_hz is None)
    if times_s is not None:
        return FolderReader(str(folder), files, times_s=times_s)
    return FolderReader(str(folder), files, rate_hz=rate_hz or DEFAULT_RATE_HZ)


def folder_images(folder: Path, timed: bool = True) -> tuple[list[Path], list[float] | None]:
    """Return the images of a folder in their order, and their stamps if it has a times.csv and ``timed`` asks for it.

    Raises
    ------
    FrameSourceError : no images, or a times.csv that does not fit them
    """
    times_file = folder / TIMES_FILE
    if timed and times_file.is_file():
        return _read_times(times_file)
    there = list(folder.iterdir())
    files = sorted((path for path in there if is_image(path)), key=natural_order)
    if not files:
        videos = "; a video is a source of its own, and a folder of them is for `lobula batch`" if there else ""
        raise FrameSourceError(f"{folder}: no images in it: must hold {', '.join(IMAGE_ENDINGS)} files{videos}")
    return files, None


def is_image(path: Path) -> bool:
    """Whether a file of a folder is taken for one of its pictures, by its name."""
    return path.suffix.lower() in IMAGE_ENDINGS and not path.name.startswith(".")


def open_pattern(pattern: str, rate_hz: float | None) -> FolderReader:
    """Open the image files that match a shell pattern.

    Raises
    ------
    FrameSourceError : nothing matches
    """
    files = sorted((Path(p) for p in glob.glob(pattern, recursive=True) if Path(p).is_file()), key=natural_order)
    if not files:
        raise FrameSourceError(f"{pattern}: no file matches: must name at least one image")
    return FolderReader(pattern, files, rate_hz=rate_hz or DEFAULT_RATE_HZ)


class FolderReader:
    """Reads image files one by one; times as given, counted from the first, or ``index / rate_hz``.

    Raises
    ------
    FrameSourceError : none of the files is an image
    """

    def __init__(
        self, name: str, files: list[Path], *, rate_hz: float = DEFAULT_RATE_HZ, times_s: list[float] | None = None
    ) -> None:
        self.name = name
        self._files = files
        self._times_s = [i / rate_hz for i in range(len(files))] if times_s is None else times_s
        span_s = self._times_s[-1] - self._times_s[0]
        self.fps = rate_hz if times_s is None else (len(files) - 1) / span_s if span_s > 0 else 0.0
        self.frame_count: int | None = len(files)
        self.damaged = 0
        self.notes: list[str] = []
        self.first: Any = None
        for self._first_index, path in enumerate(files):
            self.first = read_still(path)
            if self.first is not None:
                break
        else:
            raise FrameSourceError(f"{name}: none of its {len(files)} files is an image that FFmpeg decodes")
        for path in files[: self._first_index]:
            self._leave_out(path)
        self.rotation = round(-self.first.rotation / 90) * 90 % 360

    def pictures(self, start_s: float | None = None) -> Iterator[Picture]:
        """Yield the pictures in order; damaged files are counted and left out.

        Raises
        ------
        FrameSourceError : the last file is damaged, or a file went missing
        """
        first_s = self._times_s[0]
        yield Picture(self.first, self._times_s[self._first_index] - first_s, self._first_index)
        data: Any = self.first
        for i, path in enumerate(self._files[self._first_index + 1 :], self._first_index + 1):
            time_s = self._times_s[i] - first_s
            if start_s is not None and time_s < start_s:
                continue
            data = read_still(path)
            if data is None:
                self._leave_out(path)
            else:
                yield Picture(data, time_s, i)
        if data is None:
            raise FrameSourceError(f"{self._files[-1]}: damaged or not an image", on_the_way=True)

    def _leave_out(self, path: Path) -> None:
        self.damaged += 1
        if self.damaged <= MOST_NAMED:
            self.notes.append(f"{path}: damaged or not an image: left out")
        elif self.damaged == MOST_NAMED + 1:
            self.notes.append(f"{self.name}: more such files are counted without their names")

    def close(self) -> None:
        """Nothing is held open."""


def _read_times(times_file: Path) -> tuple[list[Path], list[float]]:
    files: list[Path] = []
    times_s: list[float] = []
    try:
        with times_file.open(newline="", encoding="utf-8-sig") as text:
            rows = csv.DictReader(text)
            if rows.fieldnames is None:
                raise FrameSourceError(f"{times_file}: is empty: must hold the columns file and time_s")
            if not {"file", "time_s"} <= set(rows.fieldnames or ()):
                raise FrameSourceError(f"{times_file}: columns {rows.fieldnames}: must hold file and time_s")
            for row in rows:
                where = f"{times_file}: line {rows.line_num}"
                path = times_file.parent / (row["file"] or "")
                if not path.is_file():
                    raise FrameSourceError(f"{where}: no file {row['file']!r} in the folder")
                files.append(path)
                times_s.append(_time(row["time_s"], times_s, where))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        if isinstance(error, FrameSourceError):
            raise
        raise FrameSourceError(f"{times_file}: {getattr(error, 'strerror', None) or error}") from error
    if not files:
        raise FrameSourceError(f"{times_file}: no rows: must name at least one image")
    return files, times_s


def _time(text: str | None, earlier: list[float], where: str) -> float:
    try:
        time_s = float(text or "")
    except ValueError:
        time_s = math.nan
    if not math.isfinite(time_s):
        raise FrameSourceError(f"{where}: time_s = {text!r}: must be a number of seconds")
    if earlier and time_s <= earlier[-1]:
        word = "stands still" if time_s == earlier[-1] else "runs backwards"
        raise FrameSourceError(f"{where}: time {word}: {time_s:.6f} s after {earlier[-1]:.6f} s: must increase")
    return time_s
