"""The last seconds of robots that were watched from above, in the form in which the arena's rules of scoring ask."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..arena.history import Past
from ..arena.world import World
from ..overhead import Tracks
from .manoeuvres import Manoeuvre, ManoeuvreParams, manoeuvres, motion_of

Floats = NDArray[np.float64]


class TrackedHistory:
    """Poses, motion and manoeuvres of a whole recording; T frames, R robots.

    Attributes
    ----------
    poses : (T, R, 3) x, y in cm and heading in rad, NaN where a robot is not known
    known : (T, R), where it is
    turns : the manoeuvres, in the order in which they began
    turning : (T, R), who is in one
    driven_cm : way of all robots together
    """

    def __init__(self, tracks: Tracks, world: World, params: ManoeuvreParams) -> None:
        table = tracks.poses()
        self.times_s = tracks.times_s
        self.poses: Floats = np.stack([table["x_cm"], table["y_cm"], table["heading_rad"]], axis=-1)
        self.known: NDArray[np.bool_] = np.isfinite(self.poses[..., 0])
        motion = motion_of(self.poses, self.times_s, params)
        # a turn whose robot was lost at its alarm cannot be judged
        self.turns = [turn for turn in manoeuvres(motion, self.times_s, params) if self.known[turn.alarm, turn.robot]]
        self.turning = np.zeros(self.known.shape, np.bool_)
        for turn in self.turns:
            self.turning[turn.alarm + 1 : turn.end + 1, turn.robot] = True
        self._speeds, self._standing = np.nan_to_num(motion.speed_cm_s), motion.standing
        self.driven_cm = float(motion.steps_cm[motion.drives].sum())
        self._back = math.ceil(world.scoring.back_s / world.tick_s)
        self._window = max(1, round(params.window_s / world.tick_s))

    def velocities_cm_s(self, frame: int, robot: int) -> Floats:
        """Return the velocities (R, 2) at ``frame``: 0 for those that stand or turn, but for ``robot`` if it turns."""
        # the slope falls before the stop comes: a robot drove as fast as it was seen to a moment ago
        speeds = self._speeds[max(0, frame - self._window) : frame + 1].max(axis=0)
        halted = self.turning[frame] | self._standing[frame]
        halted[robot] = self.turning[frame, robot]
        headings = self.poses[frame, :, 2]
        ways = np.column_stack([np.cos(headings), np.sin(headings)])
        return np.asarray(np.where(halted, 0.0, speeds)[:, None] * ways)

    def past(self, frame: int, robot: int) -> tuple[Past, list[int]]:
        """Return the last ``scoring.back_s`` up to ``frame`` of the robots known then, and which of all they are."""
        here = np.flatnonzero(self.known[frame]).tolist()
        first = max(0, frame - self._back)
        window = slice(first, frame + 1)
        poses = self.poses[window, here].copy()
        for own in poses.transpose(1, 0, 2):  # moments in which a robot was lost: it is where it came up again
            known = np.flatnonzero(np.isfinite(own[:, 0]))
            own[:] = own[known[np.searchsorted(known, np.arange(len(own)))]]
        past = Past(
            state=None,
            times_s=self.times_s[window],
            poses=poses,
            turning=self.turning[window, here],
            keys=np.zeros(len(poses), np.uint64),
            light=np.ones(len(poses)),
            velocities_cm_s=self.velocities_cm_s(frame, robot)[here],
            potentials=None,
            first_tick=first,
        )
        return past, here


def answered(turn: Manoeuvre, touching: NDArray[np.bool_], within: int) -> bool:
    """Return whether a turn came with a touch (T, R) of its robot, at most ``within`` frames before or after it."""
    return bool(touching[max(0, turn.alarm - within) : turn.alarm + within + 1, turn.robot].any())
