"""The two lobula plate tangential cells (LPTC): one for rightward, one for leftward translation."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from ...params import Params, param
from ...types import Image
from ..lamina import OnOff
from ..medulla.emd import EmdParams, emd
from .lgmd import BELOW_ONE
from .spiking import SpikingParams, spike_count


@dataclass(frozen=True, kw_only=True)
class LptcParams(Params):
    """ON-ON and OFF-OFF correlators, summed over the picture, right against left."""

    emd: EmdParams = field(default_factory=EmdParams)
    sigmoid_grey2: float = param(
        0.01, "grey^2", "K_hs: net motion for each pixel that drives the sigmoid", low=1e-9, high=1000,
        source="re-implementation: Drosmot",
    )  # fmt: skip
    spiking: SpikingParams = field(default_factory=lambda: SpikingParams(threshold=0.2))


class Lptc:
    """Both LPTCs: they share one net sum, whose sign says which of them speaks."""

    def __init__(self, p: LptcParams, clock_ms: float) -> None:
        self.p = p
        self.clock_ms = clock_ms
        self.reset()

    def reset(self) -> None:
        """Return to rest: both potentials at 0."""
        self.rightward = self.leftward = 0.0

    def step(self, now: OnOff, before: OnOff, ticks: float, change_scale: float = 1.0) -> Image:
        """Advance one step of ``ticks``, which counts its change ``change_scale`` times, on the adapted channels.

        Return the local motion, (H, W), rightward positive.

            V = 2 / (1 + exp(-|HS| / (n K_hs))) - 1;   rightward = V if HS > 0;   leftward = -V if HS < 0

        Source: paper Sec. II-D gives the ranges; form and K_hs from Drosmot (docs/sources.md).
        """
        on, off = (
            emd(x, x_before, self.p.emd, self.clock_ms, ticks, change_scale)
            for x, x_before in zip(now, before, strict=True)
        )
        hs = on.total + off.total
        drive = abs(hs) / (on.image.size * self.p.sigmoid_grey2)
        v = min(BELOW_ONE, 2.0 / (1.0 + math.exp(-drive)) - 1.0)
        self.rightward, self.leftward = (v, 0.0) if hs > 0 else (0.0, -v if hs < 0 else 0.0)
        return on.image + off.image

    def spikes(self) -> tuple[int, int]:
        """Spikes of the present step, right and left."""
        return spike_count(self.rightward, self.p.spiking), spike_count(self.leftward, self.p.spiking)
