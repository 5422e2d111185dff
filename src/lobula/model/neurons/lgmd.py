"""The two lobula giant movement detectors (LGMD): what approaches, and only that, excites them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ...params import Params, param
from ...types import Image
from ..filters import low_pass_share
from ..lamina import OnOff
from ..medulla.coarse import Coarse
from ..medulla.grouping import GroupingParams, group
from ..medulla.lateral_inhibition import InhibitionParams, compete, lateral_inhibition
from .sfa import SfaParams, adapt
from .spiking import SpikingParams, spike_count

BELOW_ONE = math.nextafter(1.0, 0.0)
"""Potentials stay inside their open interval even where the sigmoid rounds to 1."""


@dataclass(frozen=True, kw_only=True)
class LgmdParams(Params):
    """One LGMD: LGMD-1 and LGMD-2 differ in these values only."""

    reads: str = param(
        "change", "", "the layer that excites it: the retina's change or the lamina's adapted channels",
        choices=("change", "lamina"), source="published code: NewLGMDs",
    )  # fmt: skip
    on: InhibitionParams = field(default_factory=InhibitionParams)
    off: InhibitionParams = field(default_factory=InhibitionParams)
    neighbour_px: int = param(
        1, "px", "distance of the neighbours in the 3 x 3 kernels", low=1, high=32, source="chosen"
    )
    change_scale_grey: float = param(
        20.0, "grey", "mean change of the picture that raises the bias w to 1", low=0.1, high=1000,
        source="published code: NewLGMDs",
    )  # fmt: skip
    change_ms: float = param(
        10.0, "ms", "low-pass of that mean change", low=0.1, high=1000, source="published code: NewLGMDs"
    )
    on_gain: float = param(
        1.0, "", "theta 1: weight of the ON branch", low=0, high=8, source="published code: NewLGMDs"
    )
    off_gain: float = param(
        1.0, "", "theta 2: weight of the OFF branch", low=0, high=8, source="published code: NewLGMDs"
    )
    product_gain: float = param(
        0.0, "1/grey", "theta 3: weight of ON times OFF", low=0, high=8, source="published code: NewLGMDs"
    )
    grouping: GroupingParams = field(default_factory=GroupingParams)
    coarse_gain: float = param(
        0.0, "", "weight of patches that darken, beside the grouped cells; 0: not heard", low=0, high=100,
        source="chosen",
    )  # fmt: skip
    coarse_on_weight: float = param(
        5.0, "", "patches that brighten are taken off so many times", low=0, high=100, source="chosen"
    )
    sigmoid_grey: float = param(
        1.0, "grey", "C_sig: sum for each pixel that drives the sigmoid", low=1e-6, high=100,
        source="published code: NewLGMDs",
    )  # fmt: skip
    sfa: SfaParams = field(default_factory=SfaParams)
    spiking: SpikingParams = field(default_factory=SpikingParams)


class Lgmd:
    """One LGMD with its medulla; keeps the potential, raw and adapted, and the mean change of the previous step."""

    def __init__(self, p: LgmdParams, clock_ms: float) -> None:
        self.p = p
        self.clock_ms = clock_ms
        self.reset()

    def reset(self) -> None:
        """Return to rest: both potentials at 0.5."""
        self.raw = self.potential = 0.5
        self.change_before = 0.0

    def step(self, now: OnOff, before: OnOff, patches: Coarse, mean_change: float, dt_ms: float) -> Mapping[str, Image]:
        """Advance one step and return the maps of this neuron by layer.

        ``now`` and ``before`` are the channels it reads, this step and the one before; ``patches`` is what the coarse
        cells say; ``mean_change`` is the mean of |P| over the picture, grey.
        """
        p = self.p
        share = low_pass_share(self.clock_ms, p.change_ms)
        arousal = (share * mean_change + (1.0 - share) * self.change_before) / p.change_scale_grey
        self.change_before = mean_change
        maps: dict[str, Image] = {}
        branches = []
        for name, inhibition, e, e_before in zip(("on", "off"), (p.on, p.off), now, before, strict=True):
            i = lateral_inhibition(e, e_before, inhibition, p.neighbour_px, self.clock_ms)
            branches.append(compete(e, i, max(inhibition.bias, arousal)))
            maps[f"inhibition_{name}"] = i
        on, off = branches
        s = np.float32(p.on_gain) * on + np.float32(p.off_gain) * off + np.float32(p.product_gain) * (on * off)
        grouped = group(s, p.grouping, p.neighbour_px)
        looming = max(0.0, patches.off - p.coarse_on_weight * patches.on)
        total = grouped.total + p.coarse_gain * looming
        raw = min(BELOW_ONE, 1.0 / (1.0 + math.exp(-total / (s.size * p.sigmoid_grey))))
        self.potential = adapt(raw, self.raw, self.potential, p.sfa, dt_ms, self.clock_ms)
        self.raw = raw
        return {**maps, "summation": s, "grouped": grouped.image}

    def spikes(self) -> int:
        """Spikes of the present step."""
        return spike_count(self.potential, self.p.spiking)
