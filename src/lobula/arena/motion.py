"""How robots move: two wheels, and a motor queue that holds nothing, or a stop and a turn in place.

Time goes in ticks, one camera frame each. Within a tick the wheels keep their speeds, so a robot that drives follows an
arc of a circle, and its place at the end is exact. Places are complex numbers, x + iy, in plain lists: for a handful of
robots that is several times as quick as arrays.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .world import World

FORWARD, STOP, TURN = 0, 1, 2
"""What a robot does in a tick."""


class Motion:
    """Places, headings and motor queues of all robots, and what they would do in the coming tick.

    Parameters
    ----------
    world : gives wheels, speeds and the turn law
    poses : (R, 3) x, y in cm and heading in rad, at the start
    own : R generators, each the source of one robot's speed, curvature and turns
    noise : the source of motor noise

    Attributes
    ----------
    places_cm, headings_rad, speeds_cm_s, phases : one of each for every robot
    distances_cm : the way each has driven so far
    codes, turning : (R,) int8, the phases; (R,) bool, whether the motor queue holds something; new whenever it changes
    """

    def __init__(
        self, world: World, poses: NDArray[np.float64], own: list[np.random.Generator], noise: np.random.Generator
    ) -> None:
        robots, tick_s = len(poses), world.tick_s
        self._law, self._wheels, self._tick_s = world.turn, world.robots, tick_s
        self._stop_ticks = round(world.turn.stop_s / tick_s)
        self._turn_ticks = max(1, round(world.turn.turn_s / tick_s))
        self._straight = not (world.robots.curvature_per_m or world.robots.motor_noise)
        self._own, self._noise = own, noise
        bend = world.robots.curvature_per_m / 100
        self.speeds_cm_s = [rng.uniform(world.robots.speed_low_cm_s, world.robots.speed_high_cm_s) for rng in own]
        self._bends_per_cm = [rng.uniform(-bend, bend) for rng in own]
        self.places_cm = [complex(x, y) for x, y, _ in poses.tolist()]
        self.headings_rad: list[float] = poses[:, 2].tolist()
        self.distances_cm = [0.0] * robots
        self.phases = [FORWARD] * robots
        self._left = [0] * robots  # ticks until the queue is empty
        self._turns_rad = [0.0] * robots  # turn in each tick of phase TURN
        self._chords = [0j] * robots
        self._lengths, self._spins = [0.0] * robots, [0.0] * robots
        self._changed()

    def avoid(self, robots: Iterable[int]) -> None:
        """Queue a stop and a turn for those of ``robots`` whose queue is empty; the others take no notice."""
        for r in robots:
            if self.phases[r] != FORWARD:
                continue
            rng = self._own[r]
            angle = math.radians(rng.uniform(self._law.low_deg, self._law.high_deg))
            side = 1 if rng.random() < 0.5 else -1
            self._turns_rad[r] = side * angle / self._turn_ticks
            self._left[r] = self._stop_ticks + self._turn_ticks
            self.phases[r] = STOP if self._stop_ticks else TURN
            self._changed()

    def chords(self) -> list[complex]:
        """Return how far each robot gets in the coming tick, cm, if nothing is in its way."""
        if self._stale or not self._straight:
            self._plan()
        return self._chords

    def advance(self, shares: list[float] | None = None) -> None:
        """Go through the tick of ``chords``; through ``shares`` of it for robots that are held up on the way."""
        for r, phase in enumerate(self.phases):
            if phase == STOP:
                continue
            share = 1.0 if shares is None else shares[r]
            self.places_cm[r] += share * self._chords[r]
            self.headings_rad[r] += share * self._spins[r]
            self.distances_cm[r] += share * self._lengths[r]
        for r, left in enumerate(self._left):
            if left:
                self._count_down(r, left - 1)

    def state(self) -> dict[str, Any]:
        """Return a copy of everything that changes during a run."""
        kept = {name: np.array(getattr(self, name)) for name in _KEPT}
        return {**kept, "own": [rng.bit_generator.state for rng in self._own], "noise": self._noise.bit_generator.state}

    def set_state(self, state: Mapping[str, Any]) -> None:
        """Continue from ``state``, which ``state()`` gave."""
        for name in _KEPT:
            setattr(self, name, state[name].tolist())
        for rng, kept in zip([*self._own, self._noise], [*state["own"], state["noise"]], strict=True):
            rng.bit_generator.state = kept
        self._changed()

    def _count_down(self, r: int, left: int) -> None:
        self._left[r] = left
        if left == 0:
            self.phases[r] = FORWARD
            self.headings_rad[r] = math.remainder(self.headings_rad[r], 2 * math.pi)
            self._changed()
        elif left == self._turn_ticks:
            self.phases[r] = TURN
            self._changed()

    def _changed(self) -> None:
        """Note that a phase has changed: what was planned for a tick no longer holds."""
        self._stale = True
        self.codes = np.array(self.phases, np.int8)
        self.turning: NDArray[np.bool_] = self.codes != FORWARD
        self.turning.flags.writeable = False  # controllers see it

    def _plan(self) -> None:
        robots, half_cm = len(self.phases), self._wheels.track_cm / 2
        jitter = [(0.0, 0.0)] * robots
        if self._wheels.motor_noise:
            jitter = (self._wheels.motor_noise * self._noise.standard_normal((robots, 2))).tolist()
        for r, phase in enumerate(self.phases):
            length = bent = 0.0
            if phase == FORWARD:
                left, right = (
                    (1 + side * half_cm * self._bends_per_cm[r]) * (1 + noise)
                    for side, noise in zip((-1, 1), jitter[r], strict=True)
                )
                ahead = self.speeds_cm_s[r] * self._tick_s
                length, bent = ahead * (left + right) / 2, ahead * (right - left) / (2 * half_cm)
            # of an arc of length s that bends by b, the chord is s sin(b/2) / (b/2) long and points b/2 off its start
            straightness = math.sin(bent / 2) / (bent / 2) if bent else 1.0
            self._chords[r] = cmath.rect(length * straightness, self.headings_rad[r] + bent / 2)
            self._lengths[r] = abs(length)
            self._spins[r] = self._turns_rad[r] if phase == TURN else bent
        self._stale = False


_KEPT = (
    "places_cm", "headings_rad", "speeds_cm_s", "distances_cm", "phases", "_bends_per_cm", "_left", "_turns_rad",
)  # fmt: skip
