"""Contact: robots stop exactly where they touch a robot, an obstacle or the wall; which touches are new ones.

Nothing is elastic and nothing is pushed: who drives into something stands still for the rest of the tick, so bodies
never overlap. Within a tick every robot goes straight, along the chord of its arc; the difference is below 0.001 cm.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .world import World

WALL = -1
"""The wall, where a contact names what was touched."""


def obstacle_code(number: int) -> int:
    """Return how a contact names obstacle ``number`` of the world."""
    return -2 - number


class Contact(NamedTuple):
    """A touch: who, what, when within the tick, and where.

    ``robot`` was driving; ``other`` is a robot's number, WALL or an ``obstacle_code``. ``direction_rad`` points from
    the robot's centre to the place of contact, ``heading_rad`` is where the robot was heading.
    """

    robot: int
    other: int
    time_s: float
    direction_rad: float
    heading_rad: float


class Touch(NamedTuple):
    """A touch as the geometry sees it: columns of the table of gaps, share of the tick, direction."""

    robot: int
    column: int
    share: float
    direction_rad: float


class Surroundings:
    """Distances between bodies, and how far each robot gets in a tick.

    Columns of a table of gaps: the robots, the obstacles, the wall.
    """

    def __init__(self, world: World, robots: int) -> None:
        radius = world.body.radius_cm
        width, depth = world.room.size_cm
        self.robots, self.columns = robots, robots + len(world.obstacles) + 1
        self.radius_cm = radius
        self._round = world.room.shape == "circle"
        self._middle = complex(width / 2, depth / 2)
        self._half = np.array([width / 2 - radius, depth / 2 - radius])  # what a centre can reach, from the middle
        fixed = [complex(o.x_cm, o.y_cm) for o in world.obstacles]
        self._reach = np.array([2 * radius] * robots + [radius + o.radius_cm for o in world.obstacles])
        self._own = np.where(np.eye(robots, self.columns - 1, dtype=np.bool_), np.inf, 0.0)  # no robot is near itself
        self._own -= self._reach
        self._bodies = np.array([0j] * robots + fixed)
        self._gaps = np.empty((robots, self.columns))

    def code(self, column: int) -> int:
        """Return how a contact names ``column``."""
        if column == self.columns - 1:
            return WALL
        return column if column < self.robots else obstacle_code(column - self.robots)

    def gaps(self, places_cm: NDArray[np.complex128]) -> NDArray[np.float64]:
        """Return the distances (R, columns) from edge to edge, cm, at ``places_cm`` (R,); good until the next call."""
        self._bodies[: self.robots] = places_cm
        np.abs(places_cm[:, None] - self._bodies, out=self._gaps[:, :-1])
        self._gaps[:, :-1] += self._own
        if self._round:
            self._gaps[:, -1] = self._half[0] - np.abs(places_cm - self._middle)
        else:
            out = np.abs((places_cm - self._middle).view(np.float64)).reshape(-1, 2)
            self._gaps[:, -1] = (self._half - out).min(axis=1)
        return self._gaps

    def hold_up(
        self, gaps: NDArray[np.float64], places_cm: NDArray[np.complex128], chords: NDArray[np.complex128]
    ) -> tuple[NDArray[np.float64], list[Touch]]:
        """Return the share (R,) of its chord that each robot gets through, and the touches, earliest first.

        ``gaps`` are those at ``places_cm``. Touches with nobody moving towards the other are none.
        """
        robots = self.robots
        ways = np.abs(chords)
        reach = np.zeros(self.columns)
        reach[:robots] = ways
        near = gaps < ways[:, None] + reach
        near &= ways[:, None] > 0
        both = near[:, :robots]
        both &= ~(both.T & np.tri(robots, dtype=np.bool_))  # a pair that drives, once
        pairs: list[list[int]] = np.argwhere(near).tolist()
        shares, touches = [1.0] * robots, []
        at, way = [*places_cm.tolist(), *self._bodies[robots:].tolist()], [*chords.tolist()]
        way += [0j] * (self.columns - robots)
        now = 0.0
        while pairs:
            first, robot, column = min((self._until(at, way, now, i, j), i, j) for i, j in pairs)
            if first > 1.0:
                break
            now = first
            touches.append(Touch(robot, column, now, self._direction(at, way, now, robot, column)))
            for who in (robot, column):
                if who < robots and way[who]:
                    at[who] += now * way[who]
                    way[who] = 0j
                    shares[who] = now
            pairs = [[i, j] for i, j in pairs if way[i] or (j < robots and way[j])]
        return np.array(shares), touches

    def _until(self, at: Sequence[complex], way: Sequence[complex], now: float, i: int, j: int) -> float:
        """Return the share of the tick, ``now`` or later, at which robot ``i`` touches ``j``; infinite if never."""
        place = at[i] + now * way[i]
        if j < self.columns - 1:
            return now + until_apart(place - at[j] - now * way[j], way[i] - way[j], float(self._reach[j]))
        place -= self._middle
        if self._round:
            return now + until_out(place, way[i], float(self._half[0]))
        across = until_beyond(place.real, way[i].real, float(self._half[0]))
        return now + min(across, until_beyond(place.imag, way[i].imag, float(self._half[1])))

    def _direction(self, at: Sequence[complex], way: Sequence[complex], now: float, i: int, j: int) -> float:
        """Return where the touched thing lies as seen from robot ``i``, rad."""
        place = at[i] + now * way[i]
        if j < self.columns - 1:
            return cmath.phase(at[j] + now * way[j] - place)
        place -= self._middle
        if self._round:
            return cmath.phase(place)
        beside = abs(place.real) - self._half[0] >= abs(place.imag) - self._half[1]
        return cmath.phase(complex(place.real, 0.0) if beside else complex(0.0, place.imag))


def until_apart(apart: complex, closing: complex, reach: float) -> float:
    """Return when ``abs(apart + t closing)`` comes down to ``reach``; 0 for bodies that touch and close in."""
    b = apart.real * closing.real + apart.imag * closing.imag
    if b >= 0:
        return math.inf
    a, c = abs(closing) ** 2, abs(apart) ** 2 - reach**2
    root = b * b - a * c
    return max(0.0, c / (math.sqrt(root) - b)) if root >= 0 else math.inf


def until_out(place: complex, way: complex, reach: float) -> float:
    """Return when ``abs(place + t way)`` grows to ``reach``; 0 for a body that touches the wall and drives at it."""
    a = abs(way) ** 2
    if a == 0:
        return math.inf
    b = place.real * way.real + place.imag * way.imag
    inside = max(0.0, reach**2 - abs(place) ** 2)
    root = math.sqrt(b * b + a * inside)
    return inside / (root + b) if b > 0 else (root - b) / a


def until_beyond(place: float, way: float, reach: float) -> float:
    """Return when ``place + t way`` leaves the stretch from ``-reach`` to ``reach``; never if it stands still."""
    return max(0.0, (math.copysign(reach, way) - place) / way) if way else math.inf


class Episodes:
    """Which touches are new: one episode for a robot and what it touches, however often they touch during it.

    An episode ends when the two have been farther apart than ``separation_cm`` for ``separation_s``.
    """

    def __init__(self, world: World, robots: int, columns: int) -> None:
        self._apart_cm = world.scoring.separation_cm
        self._needed = max(1, round(world.scoring.separation_s / world.tick_s))
        self._robots = robots
        self._open = np.zeros((robots, columns), np.bool_)
        self._apart = np.zeros((robots, columns), np.int64)  # ticks apart so far

    def begin(self, robot: int, column: int) -> bool:
        """Note a touch and return whether it is the first of its episode."""
        if column < self._robots:
            robot, column = min(robot, column), max(robot, column)
        new = not self._open[robot, column]
        self._open[robot, column] = True
        self._apart[robot, column] = 0
        return bool(new)

    def step(self, gaps: NDArray[np.float64]) -> None:
        """End what has been apart for long enough; ``gaps`` (R, columns) at the end of the tick."""
        if self._open.any():
            self._apart = np.where(self._open & (gaps > self._apart_cm), self._apart + 1, 0)
            self._open &= self._apart < self._needed

    def state(self) -> dict[str, Any]:
        """Return a copy of what is open."""
        return {"open": self._open.copy(), "apart": self._apart.copy()}

    def set_state(self, state: Mapping[str, Any]) -> None:
        """Continue from ``state``, which ``state()`` gave."""
        self._open, self._apart = np.array(state["open"]), np.array(state["apart"])
