"""Spikes: the membrane potential, exponentially encoded as a count for each frame, Eq. (4) of the paper."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...params import Params, param


@dataclass(frozen=True, kw_only=True)
class SpikingParams(Params):
    """Eq. (4)."""

    gain: float = param(4.0, "", "K_sp", low=0.1, high=20, source="paper Sec. III")
    threshold: float = param(
        0.7, "", "T_sp, of the potential's magnitude", low=0.01, high=0.99, source="paper Sec. III"
    )


def spike_count(potential: float, p: SpikingParams) -> int:
    """Return floor(exp(K_sp (|U| - |T_sp|))): 0 below the threshold, 1 at it, more above.

    Source: paper Eq. (4).
    """
    return math.floor(math.exp(p.gain * (abs(potential) - p.threshold)))
