"""From the sums over the picture to potentials and spikes: the few scalar lines both baselines share."""

from __future__ import annotations

import math
from typing import NamedTuple

from lobula.model.network import NetworkParams
from lobula.model.neurons.lgmd import BELOW_ONE, LgmdParams
from lobula.model.neurons.sfa import adapt
from lobula.model.neurons.spiking import spike_count


class Potentials(NamedTuple):
    """What a baseline says of one frame; fields as in ``lobula.Reading``."""

    lgmd1: float
    lgmd2: float
    lptc_r: float
    lptc_l: float
    spikes: tuple[int, int, int, int]


class Neurons:
    """The scalar end of the network, for frames on the model clock: arousal, sigmoids, adaptation, spikes."""

    def __init__(self, p: NetworkParams, pixels: int) -> None:
        self.p = p
        self.dt_ms = p.clock.period_ms
        self.pixels = pixels
        self.lgmds = (p.lgmd1, p.lgmd2)
        self.raw = [0.5, 0.5]
        self.adapted = [0.5, 0.5]
        self.change_before = 0.0

    def arousal(self, mean_change: float) -> tuple[float, float]:
        """Return F / scale of both LGMDs: the mean change, low-passed, that raises the bias."""
        shares = (self.dt_ms / (self.dt_ms + lgmd.change_ms) for lgmd in self.lgmds)
        low_passed = (a * mean_change + (1.0 - a) * self.change_before for a in shares)
        lgmd1, lgmd2 = (f / lgmd.change_scale_grey for f, lgmd in zip(low_passed, self.lgmds, strict=True))
        self.change_before = mean_change
        return lgmd1, lgmd2

    def step(self, grouped: tuple[float, float], net_motion: float) -> Potentials:
        """Advance by the sums of the grouped cells of both LGMDs and the net motion of all correlators."""
        for k, (lgmd, total) in enumerate(zip(self.lgmds, grouped, strict=True)):
            self._lgmd(k, lgmd, total)
        lptc = self.p.lptc
        drive = abs(net_motion) / (self.pixels * lptc.sigmoid_grey2)
        v = min(BELOW_ONE, 2.0 / (1.0 + math.exp(-drive)) - 1.0)
        right, left = (v, 0.0) if net_motion > 0 else (0.0, -v)
        spikes = (
            spike_count(self.adapted[0], self.p.lgmd1.spiking),
            spike_count(self.adapted[1], self.p.lgmd2.spiking),
            spike_count(right, lptc.spiking),
            spike_count(left, lptc.spiking),
        )
        lgmd1, lgmd2 = self.adapted
        return Potentials(lgmd1, lgmd2, right, left, spikes)

    def _lgmd(self, k: int, p: LgmdParams, total: float) -> None:
        raw = min(BELOW_ONE, 1.0 / (1.0 + math.exp(-total / (self.pixels * p.sigmoid_grey))))
        self.adapted[k] = adapt(raw, self.raw[k], self.adapted[k], p.sfa, self.dt_ms, self.dt_ms)
        self.raw[k] = raw
