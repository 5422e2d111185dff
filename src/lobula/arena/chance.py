"""All chance of a run, from its one seed: a source for each use, so that no use disturbs another."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError

GOLDEN = np.uint64(0x9E3779B97F4A7C15)
"""2^64 over the golden ratio, odd: its multiples fall evenly over all 64-bit numbers."""

BLOCK = 256
"""Ticks whose keys are made at once."""


class Chance:
    """The sources of chance of a run.

    Attributes
    ----------
    placement, motors, controller : generators
    robots : one generator for each robot; robot 3 has the same one among 4 robots and among 7
    texture : an integer, the seed of the wall's pattern

    Raises
    ------
    ParameterError : a seed that is no whole number of at least 0
    """

    def __init__(self, seed: int, robots: int) -> None:
        if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or seed < 0:
            raise ParameterError(f"seed = {seed!r}: must be a whole number of at least 0")
        placement, motors, controller, texture, noise, own = np.random.SeedSequence(int(seed)).spawn(6)
        self.placement, self.motors, self.controller = map(np.random.default_rng, (placement, motors, controller))
        self.robots = [np.random.default_rng(each) for each in own.spawn(robots)]
        self.texture = int(texture.generate_state(1)[0])
        self._streams = _mixed(noise.generate_state(1, np.uint64) + np.arange(robots, dtype=np.uint64) * GOLDEN)
        self._block = -1
        self._keys = np.empty((BLOCK, robots), np.uint64)

    def keys(self, tick: int) -> NDArray[np.uint64]:
        """Return the noise keys (R,) of the pictures of ``tick``."""
        block, row = divmod(tick, BLOCK)
        if block != self._block:
            self._keys = self.keys_of(np.arange(block * BLOCK, (block + 1) * BLOCK))
            self._block = block
        keys: NDArray[np.uint64] = self._keys[row]
        return keys

    def keys_of(self, ticks: NDArray[np.int64]) -> NDArray[np.uint64]:
        """Return the noise keys (T, R) of the pictures of ``ticks`` (T,)."""
        return _mixed(self._streams + ticks[:, None].astype(np.uint64) * GOLDEN)


def _mixed(x: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return 64-bit numbers scrambled one by one so that neighbours have nothing in common (SplitMix64)."""
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))
