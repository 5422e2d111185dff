"""One clip of an alarm: its pictures and its part of the trace, finished beside the run."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

from ..errors import OutputError
from ..landing import part_of
from .memory import give_back
from .mp4 import Mp4File
from .ring import Slot
from .trace import TraceWriter


class Clip:
    """``path`` and the csv of the same name. Both are readable at any moment, the video as ``NAME.part.mp4``.

    Raises
    ------
    OutputError : a file cannot be written
    """

    def __init__(self, path: Path, template: Any, header: Mapping[str, Any]) -> None:
        self._frames = 0
        self._video = Mp4File(path, template, header)
        self._trace = TraceWriter(path.with_suffix(".csv"))
        try:
            self._trace.open(header)
        except OutputError:
            self._video.abandon()
            raise

    def add(self, slot: Slot) -> None:
        """Append a frame."""
        self._trace.frame(slot.number, slot.reading, None)
        self._video.add(slot.coded)
        self._frames += 1

    def finish(self) -> None:
        """Close both files and check the video."""
        self._trace.close({})
        self._video.finish(self._frames)

    def abandon(self) -> None:
        """Close both files as they are, after a failure."""
        with suppress(OutputError):
            self._trace.close({})
        self._video.abandon()


class Finisher:
    """Finishes clips in a thread: copying, checking and above all waiting for the disk would hold up the frames."""

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, "lobula clips")
        self._under_way: list[Future[None]] = []

    def take(self, clip: Clip) -> None:
        """Finish ``clip`` when its turn comes."""
        self._under_way.append(self._thread.submit(_finish, clip))

    def outcomes(self) -> list[OutputError | None]:
        """Return what became of the clips that are done since the last call, oldest first; None is success."""
        outcomes: list[OutputError | None] = []
        while self._under_way and self._under_way[0].done():
            error = self._under_way.pop(0).exception()
            if error is not None and not isinstance(error, OutputError):
                raise error
            outcomes.append(error)
        return outcomes

    def close(self) -> None:
        """Wait until all are done."""
        self._thread.shutdown()


def _finish(clip: Clip) -> None:
    try:
        clip.finish()
    finally:
        give_back()


def free_name(folder: Path, stem: str) -> Path:
    """Return ``folder/stem.mp4``, numbered on if that is there already or being written."""
    path, number = folder / f"{stem}.mp4", 1
    while path.exists() or part_of(path).exists():
        number += 1
        path = folder / f"{stem}-{number}.mp4"
    return path
