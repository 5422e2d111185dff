"""The film of a run in the arena: everybody from above, and beside it what one robot sees and what its neurons say."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..types import Neuron, Reading
from .arena_marks import COLOURS, Marks, draw_legend
from .arena_plan import ArenaPlan
from .arena_view import FOCUS_COLOUR, ArenaView, Course
from .canvas import Canvas, box, rgb, text
from .mp4 import Mp4Writer
from .palette import DARK
from .png import write_png
from .strip import STRIP_HEIGHT, Strip
from .video import mark_decision

WIDTH_PX, HEIGHT_PX = 1280, 720
_SIDE, _HEAD, _LEGEND, _MARGIN = 424, 40, 52, 12
_VIEW_HEIGHT, _LOG_PITCH = 288, 20
_GROUND, _TEXT, _DIM, _PANEL = rgb(DARK.ground), rgb(DARK.text), rgb(DARK.dim), rgb(DARK.panel)


class Tale(NamedTuple):
    """A run for its film: the room, what the robots did, what happened, and words.

    plan, course, marks : see ``ArenaPlan``, ``Course``, ``Marks``
    title : what ran, in one line
    scores : N + 1 lines, each the score after so many of the N marks
    """

    plan: ArenaPlan
    course: Course
    marks: Marks
    title: str
    scores: Sequence[str]


class Line(NamedTuple):
    """Something that happened to the robot whose view is shown: in which frame, of which kind, in words."""

    frame: int
    kind: str
    words: str


class Own(NamedTuple):
    """What the film shows of one robot.

    robot : its number
    readings : of every frame; None where its controller tells none
    thresholds : at which potential each neuron spikes
    log : what happened to it, in the order of its frames
    """

    robot: int
    readings: Sequence[Reading] | None
    thresholds: Mapping[Neuron, float]
    log: Sequence[Line]


class ArenaVideo:
    """Writes ``path``, an H.264 MP4 of 1280 x 720 px.

    Frames of the run are given one by one, in their order, each at most once. A film that is cut short leaves
    ``NAME.part.mp4``, which plays.

    Parameters
    ----------
    speed : how many times as fast as the run
    fps : of the film
    about : kept in the file as its comment

    Raises
    ------
    OutputError : the file cannot be written, or PyAV was built without libx264
    """

    def __init__(
        self, path: str | Path, tale: Tale, own: Own, *, speed: float = 1.0, fps: float = 30.0,
        about: Mapping[str, Any] | None = None,
    ) -> None:  # fmt: skip
        self._tale, self._own, self._speed = tale, own, speed
        self._canvas: Canvas = np.zeros((HEIGHT_PX, WIDTH_PX, 3), np.uint8)
        self._canvas[...] = _GROUND
        tail_s = min(max(10.0, 6.0 * speed), 45.0)
        height, width = HEIGHT_PX - _HEAD - _LEGEND, WIDTH_PX - _SIDE
        self._view = ArenaView(
            tale.plan, tale.course, tale.marks, height, width, tail_s=tail_s, word_s=min(1.5 * max(1.0, speed), 6.0)
        )
        self._strip = Strip(_SIDE, own.thresholds)
        self._next = 0  # the first frame that the strip has not taken in
        self._video = Mp4Writer(path, WIDTH_PX, HEIGHT_PX, fps, about)

    def frame(self, number: int, image: NDArray[np.uint8]) -> None:
        """Draw frame ``number`` of the run, with what the robot sees in it, (H, W), and encode it."""
        self.draw(number, image)
        self._video.write(self._canvas, float(self._tale.course.times_s[number]) / self._speed)

    def draw(self, number: int, image: NDArray[np.uint8]) -> Canvas:
        """Draw a frame and return the picture, which the next one overwrites."""
        canvas, tale, side = self._canvas, self._tale, WIDTH_PX - _SIDE
        self._view.draw(canvas[_HEAD:-_LEGEND, :side], number, self._own.robot)
        past = int(np.searchsorted(tale.marks.frames, number, side="right"))
        canvas[:_HEAD] = _GROUND
        _head(canvas[:_HEAD, :side], float(tale.course.times_s[number]), self._speed, tale.scores[past], tale.title)
        canvas[-_LEGEND:, :side] = _GROUND
        draw_legend(canvas, HEIGHT_PX - _LEGEND, 10, side - 10, Counter(tale.marks.kinds[:past].tolist()))
        self._draw_own(canvas[:, side:], number, image)
        return canvas

    def finish(self) -> None:
        """Finish and check the file.

        Raises
        ------
        OutputError : it does not read back as it should
        """
        self._video.finish()

    def abandon(self) -> None:
        """Stop before the end: what was encoded stays in ``NAME.part.mp4``."""
        self._video.abandon()

    def _draw_own(self, panel: Canvas, number: int, image: NDArray[np.uint8]) -> None:
        own = self._own
        text(panel, f"robot {own.robot} sees", 14, _MARGIN, FOCUS_COLOUR, _GROUND)
        view = panel[_HEAD : _HEAD + _VIEW_HEIGHT, _MARGIN:-_MARGIN]
        view[...] = _PANEL
        _place(view, image)
        below = _HEAD + _VIEW_HEIGHT
        if own.readings is not None:
            for row in range(self._next, number + 1):
                self._strip.push(row, own.readings[row])
            self._next = number + 1
            mark_decision(view, own.readings[number])
            self._strip.draw(panel[below + 4 : below + 4 + STRIP_HEIGHT])
            below += 4 + STRIP_HEIGHT
        log = panel[below:, _MARGIN:]
        log[...] = _GROUND
        past = [line for line in own.log if line.frame <= number]
        for place, line in enumerate(past[::-1][: (len(log) - 8) // _LOG_PITCH]):
            row, words = 8 + place * _LOG_PITCH, f"{line.kind}  {line.words}"
            box(log, row, 0, 9, 4, COLOURS[line.kind])
            at = clock(float(self._tale.course.times_s[line.frame]))
            text(log, f"{at}  {words}", row, 12, _DIM if place else _TEXT, _GROUND, size_px=9)


def write_still(path: str | Path, tale: Tale) -> None:
    """Write ``path``, a PNG: the whole run from above, with all tracks and marks.

    Raises
    ------
    OutputError : the file cannot be written
    """
    width = WIDTH_PX - _SIDE
    canvas: Canvas = np.zeros((HEIGHT_PX, width, 3), np.uint8)
    canvas[...] = _GROUND
    view = ArenaView(tale.plan, tale.course, tale.marks, HEIGHT_PX - _HEAD - _LEGEND, width)
    view.draw_all(canvas[_HEAD:-_LEGEND])
    _head(canvas[:_HEAD], float(tale.course.times_s[-1]), None, tale.scores[-1], tale.title)
    draw_legend(canvas, HEIGHT_PX - _LEGEND, 10, width - 10, Counter(tale.marks.kinds.tolist()))
    write_png(path, canvas)


def clock(time_s: float) -> str:
    """Return ``m:ss.s``, or ``h:mm:ss.s`` from an hour on."""
    tenths = int(time_s * 10 + 1e-6)
    minutes, rest = divmod(tenths, 600)
    hours, minutes = divmod(minutes, 60)
    head = f"{hours}:{minutes:02}" if hours else f"{minutes}"
    return f"{head}:{rest // 10:02}.{rest % 10}"


def _head(canvas: Canvas, time_s: float, speed: float | None, score: str, title: str) -> None:
    """Write the time, how fast it goes, what runs and how it stands."""
    text(canvas, clock(time_s), 12, 10, _TEXT, _GROUND, size_px=16)
    if speed is not None and speed != 1:
        text(canvas, f"x{speed:g}", 16, 118, _DIM, _GROUND, size_px=11)
    text(canvas, title, 17, 176, _DIM, _GROUND, size_px=9)
    text(canvas, score, 16, canvas.shape[1] - 10, _TEXT, _GROUND, size_px=11, align="right")


def _place(view: Canvas, image: NDArray[np.uint8]) -> None:
    """Put the picture in the middle of ``view``: pixels repeated, or every n-th of a large one."""
    height, width = image.shape
    scale = min(view.shape[0] / height, view.shape[1] / width)
    times, every = max(1, int(scale)), max(1, int(np.ceil(1 / scale - 1e-9)))
    large = image[::every, ::every].repeat(times, axis=0).repeat(times, axis=1)
    top, left = (view.shape[0] - large.shape[0]) // 2, (view.shape[1] - large.shape[1]) // 2
    view[top : top + large.shape[0], left : left + large.shape[1]] = large[:, :, None]
