"""The courses of the open-loop tests: how one robot drives past, towards or away from another that stands still.

Places are seen from the standing robot's camera: ``ahead_cm`` along its optical axis, ``right_cm`` towards growing
columns. Every course is a straight line of the robot's centre at constant speed, with stillness before and after.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...params import Params, param

Motion = Literal["approach", "recession", "translation_right", "translation_left", "angular"]
FOUR: tuple[Motion, ...] = ("approach", "recession", "translation_right", "translation_left")
"""The motions of the paper's Fig. 4 and Fig. 5."""
NAMES: dict[str, str] = {
    "approach": "approach",
    "recession": "recession",
    "translation_right": "translation rightward",
    "translation_left": "translation leftward",
    "angular": "angular approach",
}

LINES = ("radial", "across")
"""How an angular approach goes: straight at the lens, so that it keeps its bearing and its edges lengthen; or to the
place right before the lens, so that it crosses the view."""


class Reading(NamedTuple):
    """One way to read the labels s40, s80 and s120 of the paper's figure."""

    name: str
    meaning: str
    speeds_cm_s: tuple[float, float, float]


SPEED_LABELS = ("s40", "s80", "s120")
READINGS = (
    Reading("motor", "motor power, of 256 for 35 cm/s", (5.5, 10.9, 16.4)),
    Reading("mm/s", "mm/s", (4.0, 8.0, 12.0)),
)


def speeds_text(reading: Reading) -> str:
    """Return the three speeds as ``5.5, 10.9 and 16.4``."""
    slow, middle, fast = reading.speeds_cm_s
    return f"{slow:g}, {middle:g} and {fast:g}"


@dataclass(frozen=True, kw_only=True)
class CourseParams(Params):
    """Distances and times of the courses. Gaps are from the lens to the nearest point of the moving robot."""

    near_cm: float = param(3.5, "cm", "gap where an approach ends and a recession starts", low=0.1, high=20,
                           source="project rule")  # fmt: skip
    far_cm: float = param(30.0, "cm", "gap where an approach starts and a recession ends", low=1, high=50,
                          source="project rule")  # fmt: skip
    pass_cm: float = param(6.0, "cm", "gap at which a translating robot passes", low=0.1, high=40,
                           source="as in the synthetic battery")  # fmt: skip
    angular_cm: float = param(20.0, "cm", "length of an angular approach; all angles fit into the arena", low=1,
                              high=25, source="chosen")  # fmt: skip
    angular_line: str = param(
        "radial", "", "how an angular approach goes", choices=LINES,
        source="chosen among eight set-ups by the paper's words, see the page of Fig. 6",
    )  # fmt: skip
    angular_near_cm: float = param(
        2.0, "cm", "gap where an angular approach ends", low=0.1, high=20,
        source="chosen among eight set-ups by the paper's words, see the page of Fig. 6",
    )  # fmt: skip
    lead_s: float = param(0.5, "s", "stillness before the motion", low=0.3, high=10, source="chosen")
    hold_s: float = param(0.3, "s", "stillness after the motion", low=0.1, high=10, source="chosen")
    window_s: float = param(
        1.6, "s", "spikes are counted over this, at every speed: the travel time of the fastest course", low=0.1,
        high=10, source="paper Sec. IV-A: approximately identical time window",
    )  # fmt: skip
    misplaced_cm: float = param(
        0.2, "cm", "from repeat to repeat the line shifts sideways and in depth within +- this", low=0, high=2,
        source="chosen: a robot placed by hand",
    )  # fmt: skip

    @property
    def travel_cm(self) -> float:
        """Length of each of the four courses: they last equally long at the same speed."""
        return self.far_cm - self.near_cm


class Place(NamedTuple):
    """A point on the floor, seen from the camera."""

    ahead_cm: float
    right_cm: float


@dataclass(frozen=True, kw_only=True)
class Course:
    """A straight drive of the robot's centre from ``start`` to ``end``.

    ``angle_deg`` is the bearing an angular approach comes from: negative from the left, 0 straight ahead.
    """

    motion: Motion
    start: Place
    end: Place
    speed_cm_s: float
    angle_deg: float = 0.0

    @property
    def travel_s(self) -> float:
        """How long it moves."""
        return math.dist(self.start, self.end) / self.speed_cm_s

    def window_s(self, p: CourseParams) -> tuple[float, float]:
        """Return the start and the end of the time over which spikes are counted.

        The last ``p.window_s`` of what comes, the first of what goes, the middle of what passes.
        """
        begins, ends = p.lead_s, p.lead_s + self.travel_s
        if self.motion == "recession":
            return begins, begins + p.window_s
        if self.motion in ("approach", "angular"):
            return ends - p.window_s, ends
        middle = (begins + ends) / 2
        return middle - p.window_s / 2, middle + p.window_s / 2

    def times_s(self, p: CourseParams, rate_hz: float) -> NDArray[np.float64]:
        """Return the stamps of the pictures, (T,) s, from 0 until the stillness after the motion is over."""
        return np.arange(math.floor((p.lead_s + self.travel_s + p.hold_s) * rate_hz + 1e-9) + 1) / rate_hz

    def places(self, times_s: NDArray[np.float64], p: CourseParams) -> NDArray[np.float64]:
        """Return where the robot's centre is at ``times_s``: (T, 2) cm, ahead and right."""
        done = np.clip((times_s - p.lead_s) / self.travel_s, 0.0, 1.0)[:, None]
        return np.asarray(self.start) * (1 - done) + np.asarray(self.end) * done

    def shifted(self, ahead_cm: float, right_cm: float) -> Course:
        """Return the same drive beside its line, farther by ``ahead_cm`` and ``right_cm`` to the right."""
        moved = (Place(at.ahead_cm + ahead_cm, at.right_cm + right_cm) for at in (self.start, self.end))
        start, end = moved
        return Course(motion=self.motion, start=start, end=end, speed_cm_s=self.speed_cm_s, angle_deg=self.angle_deg)


def course(motion: Motion, speed_cm_s: float, p: CourseParams, radius_cm: float) -> Course:
    """Return one of the four courses of Fig. 4, for a robot of ``radius_cm``.

    Source: paper Sec. IV-A: frontal approach, recession, nearby translation; distances as ``CourseParams`` says.
    """
    if motion in ("approach", "recession"):
        ends = [Place(gap + radius_cm, 0.0) for gap in (p.far_cm, p.near_cm)]
        backwards = motion == "recession"
    else:
        ends = [Place(p.pass_cm + radius_cm, side * p.travel_cm / 2) for side in (-1, 1)]
        backwards = motion == "translation_left"
    start, end = reversed(ends) if backwards else ends
    return Course(motion=motion, start=start, end=end, speed_cm_s=speed_cm_s)


def angular(angle_deg: float, speed_cm_s: float, p: CourseParams, radius_cm: float) -> Course:
    """Return an approach from the bearing ``angle_deg`` that ends ``p.angular_near_cm`` before the lens.

    ``radial``: on a line that points at the lens. ``across``: on a line that makes ``angle_deg`` with the optical axis
    and ends on it. Both are the frontal approach at 0.

    Source: paper Sec. IV-A; its drawing of the set-up is lost.
    """
    bearing = math.radians(angle_deg)
    ahead, right = math.cos(bearing), math.sin(bearing)
    reach_cm = p.angular_near_cm + radius_cm
    end = Place(reach_cm * ahead, reach_cm * right) if p.angular_line == "radial" else Place(reach_cm, 0.0)
    start = Place(end.ahead_cm + p.angular_cm * ahead, end.right_cm + p.angular_cm * right)
    return Course(motion="angular", start=start, end=end, speed_cm_s=speed_cm_s, angle_deg=angle_deg)
