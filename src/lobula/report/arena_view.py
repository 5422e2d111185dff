"""The arena from above: tracks that fade, robots with their headings and views, marks of what happened."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .arena_marks import COLOURS, RED, Marks, draw_mark
from .arena_pen import disc, line, path, ring, sector, tint_thinly
from .arena_plan import ArenaPlan, Ground
from .canvas import Canvas, Colour, label, mix, rgb, text
from .palette import DARK

ROBOT_COLOURS: tuple[Colour, ...] = tuple(
    rgb(c) for c in ("#8ba6c9", "#b79ad0", "#93c29a", "#cdb487", "#84c0c4", "#cf9bab", "#a8adba", "#bcc586")
)
"""Robot r has number r modulo 8 of them: pale, so that the marks of events stand out."""

FOCUS_COLOUR = rgb(DARK.text)
"""Of the robot whose own view is shown beside."""

_ALARM, _TURNING, _INK = rgb(DARK.collision), rgb(DARK.states["turning"]), rgb(DARK.ground)
_STEP_PX = 1.0


class Course(NamedTuple):
    """T frames of R robots: when, where (x, y in cm, heading in rad), who stops and turns, whose alarm led to it."""

    times_s: NDArray[np.float64]  # (T,)
    poses: NDArray[np.float64]  # (T, R, 3)
    turning: NDArray[np.bool_]  # (T, R)
    alarms: NDArray[np.bool_]  # (T, R)


class ArenaView:
    """Draws moments of a run.

    Parameters
    ----------
    plan, course, marks : the room, what the robots did, what happened
    height, width : of the pictures, px
    tail_s : how long tracks and marks take to fade
    word_s : how long the name of an event, its first two letters, stands beside its mark
    """

    def __init__(
        self, plan: ArenaPlan, course: Course, marks: Marks, height: int, width: int, *, tail_s: float = 10.0,
        word_s: float = 1.5,
    ) -> None:  # fmt: skip
        self.plan, self.course, self.marks = plan, course, marks
        self._tail_s, self._word_s = tail_s, word_s
        self._ground = Ground(plan, height, width)
        self._rows, self._columns = self._ground.px(course.poses[..., 0], course.poses[..., 1])  # (T, R)
        self._mark_rows, self._mark_columns = self._ground.px(marks.places_cm[:, 0], marks.places_cm[:, 1])

    def draw(self, canvas: Canvas, frame: int, focus: int | None = None) -> None:
        """Draw frame number ``frame`` on ``canvas`` (height, width, 3), of which nothing is kept."""
        canvas[...] = self._ground.picture
        now_s = self.course.times_s[frame]
        first = int(np.searchsorted(self.course.times_s, now_s - self._tail_s))
        self._draw_tracks(canvas, first, frame, focus)
        for robot in range(self._rows.shape[1]):
            self._draw_sight(canvas, frame, robot, focus)
        self._draw_marks(canvas, frame)
        for robot in range(self._rows.shape[1]):
            self._draw_robot(canvas, frame, robot, focus)
        self._draw_words(canvas, frame)

    def draw_all(self, canvas: Canvas) -> None:
        """Draw the whole course with all marks, and the robots where they end."""
        canvas[...] = self._ground.picture
        robots = self._rows.shape[1]
        # the more crosses every spot, the fainter each track
        crossed = len(self._rows) * robots * self._ground.scale / max(self._ground.floor.sum(), 1)
        share = float(np.clip(0.9 - 0.15 * np.log1p(crossed), 0.3, 0.8))
        for robot in range(robots):
            ink = np.zeros(canvas.shape[:2], np.float32)
            for first in range(0, len(self._rows), 1000):
                self._ink_track(ink, robot, slice(first, first + 1001), share, share)
            tint_thinly(canvas, ink, ROBOT_COLOURS[robot % len(ROBOT_COLOURS)])
        kinds = [str(kind) for kind in self.marks.kinds]
        share = float(np.clip(1.1 - len(kinds) / 1500, 0.4, 0.9))
        for number in sorted(range(len(kinds)), key=lambda n: kinds[n] in RED):  # contacts on top
            draw_mark(canvas, kinds[number], self._mark_rows[number], self._mark_columns[number], share)
        for robot in range(robots):
            self._draw_robot(canvas, len(self._rows) - 1, robot, None)

    def _draw_tracks(self, canvas: Canvas, first: int, frame: int, focus: int | None) -> None:
        now_s, times_s = self.course.times_s[frame], self.course.times_s
        start = 1 - (now_s - times_s[first]) / self._tail_s
        for robot in range(self._rows.shape[1]):
            rows, columns = self._rows[first : frame + 1, robot], self._columns[first : frame + 1, robot]
            top, left = max(int(rows.min()) - 3, 0), max(int(columns.min()) - 3, 0)
            part = canvas[top : int(rows.max()) + 4, left : int(columns.max()) + 4]
            ink = np.zeros(part.shape[:2], np.float32)
            self._ink_track(ink, robot, slice(first, frame + 1), 0.75 * start, 0.75, (top, left))
            tint_thinly(part, ink, self._colour(robot, focus))

    def _ink_track(
        self, ink: NDArray[np.float32], robot: int, frames: slice, start: float, end: float,
        origin: tuple[int, int] = (0, 0),
    ) -> None:  # fmt: skip
        """Draw a stretch of a track into ``ink``, whose upper left pixel is ``origin``, from one share to another."""
        rows, columns = self._rows[frames, robot] - origin[0], self._columns[frames, robot] - origin[1]
        way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(rows), np.diff(columns)))])
        at = np.arange(0.0, way[-1] + _STEP_PX, _STEP_PX)
        shares = np.interp(at, way, np.linspace(start, end, len(way)))
        path(ink, np.interp(at, way, rows), np.interp(at, way, columns), shares, 2.0)

    def _draw_sight(self, canvas: Canvas, frame: int, robot: int, focus: int | None) -> None:
        heading, ahead = self.course.poses[frame, robot, 2], self.plan.pupil_cm * self._ground.scale
        sector(
            canvas, self._rows[frame, robot] - ahead * math.sin(heading),
            self._columns[frame, robot] + ahead * math.cos(heading), heading, math.radians(self.plan.fov_deg / 2),
            self.plan.sight_cm * self._ground.scale, self._colour(robot, focus), 0.5 if robot == focus else 0.28,
            self._ground.floor,
        )  # fmt: skip

    def _draw_marks(self, canvas: Canvas, frame: int) -> None:
        lasts_s = 2 * self._tail_s
        for number, age_s in self._marks_since(frame, lasts_s):
            place = self._mark_rows[number], self._mark_columns[number]
            draw_mark(canvas, str(self.marks.kinds[number]), *place, 1 - age_s / lasts_s)

    def _draw_words(self, canvas: Canvas, frame: int) -> None:
        """Name the newest events, clear of the body that is there."""
        clear = self.plan.body_cm * self._ground.scale
        for number, _ in self._marks_since(frame, self._word_s):
            row = max(2, round(self._mark_rows[number] - clear) - 14)
            column = min(round(self._mark_columns[number] + 0.7 * clear), canvas.shape[1] - 34)
            kind = str(self.marks.kinds[number])
            label(canvas, kind[:2], row, column, _INK, COLOURS[kind], size_px=8)

    def _marks_since(self, frame: int, lasts_s: float) -> list[tuple[int, float]]:
        """Number and age of each mark that is younger than ``lasts_s``."""
        last = int(np.searchsorted(self.marks.frames, frame, side="right"))
        ages_s = self.course.times_s[frame] - self.course.times_s[self.marks.frames[:last]]
        return [(number, float(ages_s[number])) for number in np.flatnonzero(ages_s < lasts_s).tolist()]

    def _draw_robot(self, canvas: Canvas, frame: int, robot: int, focus: int | None) -> None:
        row, column = float(self._rows[frame, robot]), float(self._columns[frame, robot])
        heading, radius = self.course.poses[frame, robot, 2], self.plan.body_cm * self._ground.scale
        colour = self._colour(robot, focus)
        body = mix(_INK, colour, 0.25)
        edge = colour
        if self.course.turning[frame, robot]:
            edge = _TURNING
        if self.course.alarms[frame, robot]:
            edge = _ALARM
        disc(canvas, row, column, radius - 0.5, body)
        ring(canvas, row, column, radius - 1.5, 3.0 if edge != colour else 2.0, edge)
        tip = row - radius * math.sin(heading), column + radius * math.cos(heading)
        inner = 0.5 * radius
        line(canvas, (row - inner * math.sin(heading), column + inner * math.cos(heading)), tip, 3.5, colour)
        size_px = min(9.0, 0.45 * radius)
        text(canvas, str(robot), round(row - size_px / 2), round(column), colour, body, size_px=size_px, align="middle")

    def _colour(self, robot: int, focus: int | None) -> Colour:
        return FOCUS_COLOUR if robot == focus else ROBOT_COLOURS[robot % len(ROBOT_COLOURS)]
