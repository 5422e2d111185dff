"""Hand-made pasts for the tests of sight and cause: all drive straight at constant velocity up to the last frame."""

from __future__ import annotations

import math

import numpy as np

from lobula.arena.history import Past

RATE_HZ = 30.0


def past_of(*robots, seconds=1.1, turning=(), state="saved", potentials=None):
    """Return a past that ends at the given (x, y, heading in deg, speed) of each robot.

    ``turning`` lists (robot, from_s, to_s) before the last frame in which a robot turns in place: it stands still from
    then on, and its velocity at the last frame is 0 if that is one of them.
    """
    frames = round(seconds * RATE_HZ) + 1
    before_s = np.arange(frames - 1, -1, -1) / RATE_HZ
    poses = np.zeros((frames, len(robots), 3))
    velocities = np.zeros((len(robots), 2))
    turns = np.zeros((frames, len(robots)), bool)
    for r, from_s, to_s in turning:
        turns[:, r] |= (before_s <= from_s + 1e-9) & (before_s >= to_s - 1e-9)
    for r, (x, y, heading_deg, speed) in enumerate(robots):
        heading = math.radians(heading_deg)
        way = speed * np.array([math.cos(heading), math.sin(heading)])
        velocities[r] = 0 if turns[-1, r] else way
        poses[:, r, :2] = np.array([x, y]) - before_s[:, None] * way
        poses[:, r, 2] = heading
    return Past(
        state=state,
        times_s=10.0 + np.arange(frames) / RATE_HZ,
        poses=poses,
        turning=turns,
        keys=np.arange(1000, 1000 + frames, dtype=np.uint64),
        light=np.linspace(0.9, 1.1, frames),
        velocities_cm_s=velocities,
        potentials=potentials,
        first_tick=300,
    )
