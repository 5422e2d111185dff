"""How robots move: two wheels, and a motor queue that holds nothing, or a stop and a turn in place.

Time goes in ticks, one camera frame each. Within a tick the wheels keep their speeds, so a robot that drives follows an
arc of a circle, and its place at the end is exact.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .world import World

FORWARD, STOP, TURN = 0, 1, 2
"""What a robot does in a tick."""


class Motion:
    """Places, headings and motor queues of all robots.

    Parameters
    ----------
    world : gives wheels, speeds and the turn law
    poses : (R, 3) x, y in cm and heading in rad, at the start
    own : R generators, each the source of one robot's speed, curvature and turns
    noise : the source of motor noise

    Attributes
    ----------
    places_cm : (R,) complex, x + iy
    headings_rad, speeds_cm_s, distances_cm : (R,); the last is the way driven so far
    phases : (R,) int8, FORWARD, STOP or TURN
    """

    def __init__(
        self, world: World, poses: NDArray[np.float64], own: list[np.random.Generator], noise: np.random.Generator
    ) -> None:
        robots, tick_s = len(poses), world.tick_s
        self._law = world.turn
        self._stop_ticks = round(world.turn.stop_s / tick_s)
        self._turn_ticks = max(1, round(world.turn.turn_s / tick_s))
        self._own, self._noise = own, noise
        self._motor_noise, self._track_cm, self._tick_s = world.robots.motor_noise, world.robots.track_cm, tick_s
        low, high = world.robots.speed_low_cm_s, world.robots.speed_high_cm_s
        bend = world.robots.curvature_per_m / 100
        self.speeds_cm_s = np.array([rng.uniform(low, high) for rng in own])
        self._bends_per_cm = np.array([rng.uniform(-bend, bend) for rng in own])
        self.places_cm = poses[:, 0] + 1j * poses[:, 1]
        self.headings_rad = poses[:, 2].astype(np.float64)
        self.distances_cm = np.zeros(robots)
        self.phases = np.zeros(robots, np.int8)
        self._left = np.zeros(robots, np.int64)  # ticks until the queue is empty
        self._turns_rad = np.zeros(robots)  # turn in each tick of phase TURN
        self._chords = np.zeros(robots, np.complex128)
        self._lengths = np.zeros(robots)
        self._spins = np.zeros(robots)
        self._stale = True  # chords and spins belong to other phases
        self._straight = not (world.robots.curvature_per_m or world.robots.motor_noise)

    @property
    def turning(self) -> NDArray[np.bool_]:
        """(R,), whether the motor queue holds something."""
        turning: NDArray[np.bool_] = self.phases != FORWARD
        return turning

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
            self._stale = True

    def stride(self) -> tuple[NDArray[np.complex128], NDArray[np.float64]]:
        """Return the way across the coming tick (R,), cm, complex, and the turn (R,), rad, if nothing is in the way."""
        if self._stale or not self._straight:
            self._plan()
        return self._chords, self._spins

    def advance(self, shares: NDArray[np.float64] | None = None) -> None:
        """Go through the tick of ``stride``; ``shares`` (R,) of it for robots that are held up on the way."""
        if shares is None:
            self.places_cm += self._chords
            self.headings_rad += self._spins
            self.distances_cm += self._lengths
        else:
            self.places_cm += self._chords * shares
            self.headings_rad += self._spins * shares
            self.distances_cm += self._lengths * shares
        if self._left.any():
            self._count_down()

    def state(self) -> dict[str, Any]:
        """Return a copy of everything that changes during a run."""
        kept = {name: getattr(self, name).copy() for name in _KEPT}
        return {**kept, "own": [rng.bit_generator.state for rng in self._own], "noise": self._noise.bit_generator.state}

    def set_state(self, state: Mapping[str, Any]) -> None:
        """Continue from ``state``, which ``state()`` gave."""
        for name in _KEPT:
            setattr(self, name, np.array(state[name]))
        for rng, kept in zip([*self._own, self._noise], [*state["own"], state["noise"]], strict=True):
            rng.bit_generator.state = kept
        self._stale = True

    def _plan(self) -> None:
        driving = self.phases == FORWARD
        speeds, bends = self.speeds_cm_s, self._bends_per_cm
        if self._motor_noise:
            half = self._track_cm / 2
            wheels = speeds * np.stack([1 - bends * half, 1 + bends * half])
            wheels *= 1 + self._motor_noise * self._noise.standard_normal(wheels.shape)
            speeds, yaws = wheels.mean(axis=0), (wheels[1] - wheels[0]) / self._track_cm
        else:
            yaws = bends * speeds
        bent = np.where(driving, yaws * self._tick_s, 0.0)
        self._lengths = np.where(driving, np.abs(speeds) * self._tick_s, 0.0)
        # of an arc of length s that bends by b: the chord is s sinc(b / 2) long and points b / 2 off the start
        chords = np.where(driving, speeds * self._tick_s, 0.0) * np.sinc(bent / (2 * math.pi))
        self._chords = chords * np.exp(1j * (self.headings_rad + bent / 2))
        self._spins = np.where(self.phases == TURN, self._turns_rad, bent)
        self._stale = False

    def _count_down(self) -> None:
        busy = self._left > 0
        self._left -= busy
        started = busy & (self._left == self._turn_ticks)
        ended = busy & (self._left == 0)
        if started.any() or ended.any():
            self.phases[started] = TURN
            self.phases[ended] = FORWARD
            self.headings_rad[ended] = np.remainder(self.headings_rad[ended] + math.pi, 2 * math.pi) - math.pi
            self._stale = True


_KEPT = (
    "places_cm", "headings_rad", "speeds_cm_s", "distances_cm", "phases", "_bends_per_cm", "_left", "_turns_rad",
)  # fmt: skip
