"""Who stopped and turned, and when: read off the motion of robots that were watched from outside."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..params import Params, param

Floats = NDArray[np.float64]

_LOST_S = 0.5


@dataclass(frozen=True, kw_only=True)
class ManoeuvreParams(Params):
    """What counts as a turn in place and as a touch in a track."""

    window_s: float = param(0.2, "s", "speeds and rates of turn are slopes over this long", low=0.01, high=2,
                            source="chosen: the stop before a turn")  # fmt: skip
    still_share: float = param(0.5, "", "of its usual speed; a robot below it stands", low=0.05, high=0.95,
                               source="chosen: half-way, where a smoothed step lies right")  # fmt: skip
    turning_deg_s: float = param(40.0, "deg/s", "a robot that stands and turns faster turns in place", low=1, high=2000,
                                 source="chosen: a quarter of 120 deg in 0.8 s")  # fmt: skip
    least_turn_deg: float = param(30.0, "deg", "smallest turn that is a manoeuvre", low=1, high=180, source="chosen")
    touch_cm: float = param(0.1, "cm", "bodies with a smaller gap touch", low=0, high=10,
                            source="chosen: the aim for the tracks' error")  # fmt: skip
    touch_s: float = param(0.05, "s", "a manoeuvre that begins so near in time to a touch of its robot is its answer",
                           low=0, high=5, source="chosen: a frame or two")  # fmt: skip


class Manoeuvre(NamedTuple):
    """A turn in place: column of the robot, the frame in which it came to stand, and last frame of the turn."""

    robot: int
    alarm: int
    end: int


class Motion(NamedTuple):
    """How robots move, (T, R) each: speed, rate of turn to the left, and whether they stand; NaN, false if unknown.

    ``steps_cm`` is how far each came since the frame before, ``drives`` whether that is a drive's step.
    """

    speed_cm_s: Floats
    turn_rad_s: Floats
    standing: NDArray[np.bool_]
    steps_cm: Floats
    drives: NDArray[np.bool_]


def motion_of(poses: Floats, times_s: Floats, params: ManoeuvreParams) -> Motion:
    """Return the motion of robots at ``poses`` (T, R, 3), x, y in cm and heading in rad, NaN where not known."""
    x, y, heading = np.moveaxis(poses, -1, 0)
    speed = np.hypot(_slope(x, times_s, params.window_s), _slope(y, times_s, params.window_s))
    turn = _slope(heading, times_s, params.window_s, period=2 * math.pi)
    steps = np.full(speed.shape, np.nan)
    steps[1:] = np.hypot(np.diff(x, axis=0), np.diff(y, axis=0))
    least = params.still_share * np.array([_usual(own) for own in speed.T])
    passed_s = np.diff(times_s, prepend=times_s[0])[:, None]
    with np.errstate(invalid="ignore"):
        return Motion(speed, turn, speed < least, steps, steps >= least * passed_s)


def manoeuvres(motion: Motion, times_s: Floats, params: ManoeuvreParams) -> list[Manoeuvre]:
    """Return the turns in place of all robots, in the order in which they began.

    A turn begins with the stop before it: the alarm is the frame from which on the robot stood. Two turns on end,
    without a drive between them, are two manoeuvres if the robot held still between them.
    """
    found = []
    reach = int(np.searchsorted(times_s, times_s[0] + params.window_s / 2 + 1e-9)) - 1
    for robot in range(motion.standing.shape[1]):
        held = _held(motion.turn_rad_s[:, robot], times_s)
        standing, rate = motion.standing[held, robot], motion.turn_rad_s[held, robot]
        with np.errstate(invalid="ignore"):
            turning = standing & (np.abs(rate) > math.radians(params.turning_deg_s))
        free_from = 0
        for first, last in _runs(turning):
            angle = float(np.nansum(rate[first : last + 1] * np.gradient(times_s)[first : last + 1]))
            if abs(angle) < math.radians(params.least_turn_deg):
                continue
            start = first
            while start > free_from and standing[start - 1]:
                start -= 1
            # the smoothed speed says about when it stopped, the steps themselves say when
            window = slice(max(0, start - reach), start + reach + 1)
            driven = np.flatnonzero(motion.drives[window, robot])
            if start > 0:  # a turn that the recording began in has no alarm
                found.append(Manoeuvre(robot, window.start + int(driven[-1]) if len(driven) else start - 1, last))
            free_from = last + 1
    return sorted(found, key=lambda one: (one.alarm, one.robot))


def _slope(values: Floats, times_s: Floats, window_s: float, period: float = math.inf) -> Floats:
    """Return the slopes (T, R) of straight lines through the values within half a window of each frame.

    Values a ``period`` apart are the same. NaN where fewer than three values are known.
    """
    count = len(times_s)
    sums = np.zeros((5, *values.shape))  # of 1, t, v, t t, t v; both counted from the frame itself
    reach = 1
    while reach < count and np.min(times_s[reach:] - times_s[:-reach]) <= window_s / 2 + 1e-9:
        reach += 1
    for step in range(-reach, reach + 1):
        here = np.arange(max(0, -step), count - max(0, step))
        t = (times_s[here + step] - times_s[here])[:, None]
        v = values[here + step] - values[here]
        if math.isfinite(period):
            v = (v + period / 2) % period - period / 2
        known = np.isfinite(v) & (np.abs(t) <= window_s / 2 + 1e-9)
        t, v = np.where(known, t, 0.0), np.where(known, v, 0.0)
        sums[:, here] += known, t, v, t * t, t * v
    n, t, v, tt, tv = sums
    spread = n * tt - t * t
    enough = (n >= 3) & (spread > 0)
    return np.where(enough, (n * tv - t * v) / np.where(enough, spread, 1.0), np.nan)


def _held(values: Floats, times_s: Floats) -> NDArray[np.intp]:
    """Return for every frame the last one in which the value (T,) is known, if it is no longer ago than ``_LOST_S``.

    A robot that is lost for a moment goes on with what it did.
    """
    here = np.arange(len(values))
    last = np.maximum.accumulate(np.where(np.isfinite(values), here, 0))
    return np.where(times_s - times_s[last] <= _LOST_S, last, here)


def _usual(speed: Floats) -> float:
    """Return the median speed of a robot (T,) while it drives: anything above a fifth of its fastest."""
    known = speed[np.isfinite(speed)]
    driving = known[known > 0.2 * known.max(initial=0.0)]
    return float(np.median(driving)) if len(driving) else 0.0


def _runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the first and the last index of every run of true."""
    edges = np.diff(np.concatenate([[0], flags.astype(np.int8), [0]]))
    return list(zip(np.flatnonzero(edges == 1).tolist(), (np.flatnonzero(edges == -1) - 1).tolist(), strict=True))
