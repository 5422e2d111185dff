"""The annotated video: the picture, what the four neurons make of it, and the decision in plain sight."""

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
from .canvas import Canvas, border, label, rgb, text
from .h264 import require_h264
from .mp4 import Mp4Writer
from .palette import DARK, STATE_LABELS, thresholds
from .placing import fitted, place
from .strip import STRIP_HEIGHT, Strip
from .trace import facts

WIDTH_PX, MAX_PICTURE_HEIGHT_PX = 640, 480
_NO_PICTURE = (360, WIDTH_PX)
_PANEL = rgb(DARK.panel)


class AnnotatedVideo:
    """Writes ``path``, an H.264 MP4: the source's picture on top, the running traces of ``Strip`` below.

    Frames keep their own time stamps. A run that is killed leaves ``NAME.part.mp4``, which plays; the next one sets it
    aside, and ``notes`` says so.

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
        self._video: Mp4Writer | None = None
        self._scaler = VideoReformatter()
        self._failed = False
        self.notes: list[str] = []

    def open(self, header: Mapping[str, Any]) -> None:
        """Remember the run; the file starts with the first frame, whose shape sets its size."""
        self._header = header
        if not self.path.parent.is_dir():
            raise OutputError(f"cannot write {self.path}: no such folder {self.path.parent}")
        self.notes += set_aside(part_of(self.path, ".mp4"))

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Draw and encode one frame."""
        image = picture() if picture else None
        if self._video is None:
            self._start(image)
        assert self._video is not None
        view = self._canvas[:-STRIP_HEIGHT]
        _place(view, image, self._scaler)
        mark_decision(view, reading)
        self._strip.push(index, reading)
        self._strip.draw(self._canvas[-STRIP_HEIGHT:])
        try:
            self._video.write(self._canvas, reading.time_s)
        except OutputError:
            self._failed = True
            raise

    def event(self, record: Mapping[str, Any]) -> None:
        """Do nothing: the frames show it."""

    def close(self, summary: Mapping[str, Any]) -> None:
        """Finish and check the file; after a failed frame, leave the part that plays. No frames, no file."""
        if self._video is None:
            return
        video, self._video = self._video, None
        if self._failed:
            video.abandon()
        else:
            video.finish()

    def _start(self, image: NDArray[np.uint8] | None) -> None:
        shape = image.shape if image is not None else _NO_PICTURE
        height, _ = fitted(shape, WIDTH_PX, MAX_PICTURE_HEIGHT_PX)
        self._canvas: Canvas = np.zeros((height + STRIP_HEIGHT, WIDTH_PX, 3), np.uint8)
        self._strip = Strip(WIDTH_PX, thresholds(self._header))
        fps = float(self._header.get("fps") or 30.0)
        self._video = Mp4Writer(self.path, WIDTH_PX, height + STRIP_HEIGHT, fps, facts(self._header))


def _place(view: Canvas, image: NDArray[np.uint8] | None, scaler: VideoReformatter) -> None:
    """Put the picture in the middle of ``view``; without one, say so."""
    if image is None:
        view[...] = _PANEL
        text(view, "no picture", view.shape[0] // 2, view.shape[1] // 2, rgb(DARK.dim), _PANEL, align="middle")
        return
    place(view, image, scaler, _PANEL)


def mark_decision(view: Canvas, reading: Reading) -> None:
    """Say collision, or a state other than ok, on the picture itself."""
    if reading.collision:
        border(view, 8, rgb(DARK.collision))
        label(view, "COLLISION", 8, 8, (255, 255, 255), rgb(DARK.collision), size_px=20)
    elif reading.state != "ok":
        label(view, STATE_LABELS[reading.state], 8, 8, rgb(DARK.ground), rgb(DARK.states[reading.state]), size_px=12)
