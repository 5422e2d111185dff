"""Contact: robots stop exactly where they touch a robot, an obstacle or the wall; which touches are new ones.

Nothing is elastic and nothing is pushed: who drives into something stands still for the rest of the tick, so bodies
never overlap. Within a tick every robot goes straight, along the chord of its arc; the difference is below 0.001 cm.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import NamedTuple

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

    What a robot can touch has a column: the robots, the obstacles, the wall. Places are complex numbers, x + iy, in cm.
    """

    def __init__(self, world: World, robots: int) -> None:
        radius = world.body.radius_cm
        width, depth = world.room.size_cm
        self.robots, self.wall = robots, robots + len(world.obstacles)
        self._round = world.room.shape == "circle"
        self._middle = complex(width / 2, depth / 2)
        self._half = width / 2 - radius, depth / 2 - radius  # what a robot's centre can reach, from the middle
        self._fixed = [complex(o.x_cm, o.y_cm) for o in world.obstacles]
        self._reach = [2 * radius] * robots + [radius + o.radius_cm for o in world.obstacles]

    def code(self, column: int) -> int:
        """Return how a contact names ``column``."""
        if column == self.wall:
            return WALL
        return column if column < self.robots else obstacle_code(column - self.robots)

    def gap_cm(self, places: Sequence[complex], robot: int, column: int) -> float:
        """Return the distance from edge to edge between ``robot`` and ``column``."""
        place = places[robot]
        if column == self.wall:
            return self._to_wall(place)
        other = places[column] if column < self.robots else self._fixed[column - self.robots]
        return abs(place - other) - self._reach[column]

    def near(self, places: Sequence[complex], chords: Sequence[complex]) -> list[tuple[int, int]]:
        """Return the pairs (robot, column) that could touch within the tick; the robot is one that drives."""
        lengths = [abs(chord) for chord in chords]
        pairs = []
        for i, (place, length) in enumerate(zip(places, lengths, strict=True)):
            for j in range(i):
                both = length + lengths[j]
                if both and abs(place - places[j]) - self._reach[j] < both:
                    pairs.append((j, i) if lengths[j] else (i, j))
            if length:
                if self._to_wall(place) < length:
                    pairs.append((i, self.wall))
                for k, middle in enumerate(self._fixed, self.robots):
                    if abs(place - middle) - self._reach[k] < length:
                        pairs.append((i, k))
        return pairs

    def hold_up(
        self, pairs: list[tuple[int, int]], places: Sequence[complex], chords: Sequence[complex]
    ) -> tuple[list[float], list[Touch]]:
        """Return the share of its chord that each robot gets through, and the touches, earliest first.

        ``pairs`` are those that ``near`` found. A touch needs at least one that moves towards the other.
        """
        at, way, shares = [*places, *self._fixed], [*chords, *[0j] * len(self._fixed)], [1.0] * self.robots
        touches: list[Touch] = []
        now = 0.0
        while pairs:
            first, robot, column = min((self._until(at, way, now, i, j), i, j) for i, j in pairs)
            if first > 1.0:
                break
            now = first
            touches.append(Touch(robot, column, now, self._direction(at, way, now, robot, column)))
            for who in (robot, column):
                if who < self.robots and way[who]:
                    at[who] += now * way[who]
                    way[who] = 0j
                    shares[who] = now
            pairs = [(i, j) for i, j in pairs if way[i] or (j < self.robots and way[j])]
        return shares, touches

    def _to_wall(self, place: complex) -> float:
        place -= self._middle
        if self._round:
            return self._half[0] - abs(place)
        return min(self._half[0] - abs(place.real), self._half[1] - abs(place.imag))

    def _until(self, at: Sequence[complex], way: Sequence[complex], now: float, i: int, j: int) -> float:
        """Return the share of the tick, ``now`` or later, at which robot ``i`` touches ``j``; infinite if never."""
        place = at[i] + now * way[i]
        if j != self.wall:
            return now + until_apart(place - at[j] - now * way[j], way[i] - way[j], self._reach[j])
        place -= self._middle
        if self._round:
            return now + until_out(place, way[i], self._half[0])
        across = until_beyond(place.real, way[i].real, self._half[0])
        return now + min(across, until_beyond(place.imag, way[i].imag, self._half[1]))

    def _direction(self, at: Sequence[complex], way: Sequence[complex], now: float, i: int, j: int) -> float:
        """Return where the touched thing lies as seen from robot ``i``, rad."""
        place = at[i] + now * way[i]
        if j != self.wall:
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

    def __init__(self, world: World, around: Surroundings) -> None:
        self._around = around
        self._apart_cm = world.scoring.separation_cm
        self._needed = max(1, round(world.scoring.separation_s / world.tick_s))
        self._open: dict[tuple[int, int], int] = {}  # robot and column: ticks apart so far

    def begin(self, robot: int, column: int) -> bool:
        """Note a touch and return whether it is the first of its episode."""
        pair = (min(robot, column), max(robot, column))
        new = pair not in self._open
        self._open[pair] = 0
        return new

    def step(self, places: Sequence[complex]) -> None:
        """End what has been apart for long enough; ``places`` at the end of the tick."""
        for (robot, column), ticks in list(self._open.items()):
            apart = self._around.gap_cm(places, robot, column) > self._apart_cm
            if apart and ticks + 1 >= self._needed:
                del self._open[robot, column]
            else:
                self._open[robot, column] = ticks + 1 if apart else 0

    def state(self) -> list[list[int]]:
        """Return a copy of what is open."""
        return [[robot, column, ticks] for (robot, column), ticks in self._open.items()]

    def set_state(self, state: list[list[int]]) -> None:
        """Continue from ``state``, which ``state()`` gave."""
        self._open = {(robot, column): ticks for robot, column, ticks in state}
