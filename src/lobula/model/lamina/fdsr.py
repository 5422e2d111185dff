"""Fast-depolarising slow-repolarising (FDSR) adaptation: what merely flickers is subtracted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...params import Params, param
from ...types import Image
from ..filters import low_pass_share


@dataclass(frozen=True, kw_only=True)
class FdsrParams(Params):
    """A low-pass that follows rises at once and falls slowly is taken off its own input."""

    enabled: bool = param(True, "", "off: the channel goes on unadapted (ablation)", source="paper Sec. II-B")
    rise_ms: float = param(1.0, "ms", "time constant of rises", low=0.1, high=100, source="re-implementation: Drosmot")


def fdsr(channel: Image, previous: Image, p: FdsrParams, dt_ms: float) -> Image:
    """Return the adapted channel M, (H, W) and >= 0, from the channel X now and one step ago.

        D = a X(t) + (1 - a) X(t-1),   a = a(rise) where X rises, a(fall) where it falls,   M = [X - D]+

    X - D = (1 - a)(X(t) - X(t-1)): a falling channel is silent whatever its time constant, so there is no setting for
    it; a rising one passes its rise, scaled down.

    Source: paper Sec. II-B names the mechanism; form and constant from Drosmot (docs/sources.md).
    Reading: two taps (the previous input), not a recursive state.
    """
    if not p.enabled:
        return channel
    rise = channel - previous
    share = np.float32(1.0 - low_pass_share(dt_ms, p.rise_ms))
    adapted: Image = np.maximum(share * rise, np.float32(0))
    return adapted
