"""The pictures of a run as they were seen, written while it runs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from av.video.reformatter import VideoReformatter
from numpy.typing import NDArray

from ..errors import OutputError, ParameterError
from ..landing import part_of, set_aside
from ..runtime.sinks import Picture
from ..types import Reading
from .h264 import require_h264
from .mp4 import Mp4Writer
from .placing import place
from .trace import facts

_BLACK = (0, 0, 0)


class EvenPictures:
    """Makes every picture of a run one size with even sides: that of the first, or less if it is wider than ``most``.

    A row or column too many is cut off; a picture that comes in another size later is scaled to fit.
    """

    def __init__(self, most: int | None = None) -> None:
        self._most = most
        self._scaler = VideoReformatter()
        self._canvas: NDArray[np.uint8] | None = None

    def __call__(self, picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Return ``picture`` (h, w, 3) in that size; valid until the next call."""
        if self._canvas is None:
            height, width = picture.shape[:2]
            scale = 1.0 if self._most is None else min(1.0, self._most / width)
            self._canvas = np.zeros((_even(height * scale), _even(width * scale), 3), np.uint8)
        height, width = self._canvas.shape[:2]
        if picture.shape[0] - height in (0, 1) and picture.shape[1] - width in (0, 1):
            return picture[:height, :width]
        place(self._canvas, picture, self._scaler, _BLACK)
        return self._canvas


class Recording:
    """Writes ``path``, an H.264 MP4 of the source's own pictures, upright, at their own times.

    A run that is killed leaves ``NAME.part.mp4``, which plays up to its last half second; the next one sets it aside,
    and ``notes`` says so.

    Raises
    ------
    ParameterError : the suffix is not .mp4
    OutputError : PyAV was built without libx264
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        if self.path.suffix.lower() != ".mp4":
            raise ParameterError(f"video {self.path}: must end in .mp4")
        require_h264(self.path)
        self._header: Mapping[str, Any] = {}
        self._sized = EvenPictures()
        self._video: Mp4Writer | None = None
        self._failed = False
        self.notes: list[str] = []

    def open(self, header: Mapping[str, Any]) -> None:
        """Remember the run; the file starts with the first frame, whose shape sets its size."""
        self._header = header
        if not self.path.parent.is_dir():
            raise OutputError(f"cannot write {self.path}: no such folder {self.path.parent}")
        self.notes += set_aside(part_of(self.path, ".mp4"))

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Encode one picture."""
        if picture is None:
            return
        image = self._sized(picture())
        try:
            if self._video is None:
                fps = float(self._header.get("fps") or 30.0)
                height, width = image.shape[:2]
                about = facts(self._header)
                self._video = Mp4Writer(self.path, width, height, fps, about, crf=18, speed="superfast")
            self._video.write(image, reading.time_s)
        except OutputError:
            self._failed = True
            raise

    def event(self, record: Mapping[str, Any]) -> None:
        """Do nothing: the trace holds it."""

    def close(self, summary: Mapping[str, Any]) -> None:
        """Finish and check the file; after a failed frame, leave the part that plays. No frames, no file."""
        video, self._video = self._video, None
        if video is None:
            return
        if self._failed:
            video.abandon()
        else:
            video.finish()


def _even(pixels: float) -> int:
    return max(2 * int(pixels / 2), 2)
