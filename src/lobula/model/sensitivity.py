"""One knob: how readily the network decides for a collision."""

from __future__ import annotations

import math

from ..errors import ParameterError
from ..params import with_settings
from .network import NetworkParams

MIDDLE = 0.5


def with_sensitivity(params: NetworkParams, sensitivity: float) -> NetworkParams:
    """Return ``params`` with the decision made more or less readily; ``sensitivity`` 0..1, 0.5 changes nothing.

        f = 4^(0.5 - s);   collision_spikes <- max(1, round(f collision_spikes));   lptc_weight <- f lptc_weight

    From 0 to 1 the spikes an alarm needs fall from twice the preset's to half, and so does the weight of the
    translation that speaks against it. Potentials and spikes stay as they are.

    Raises
    ------
    ParameterError : not a number in 0..1
    """
    if not 0.0 <= sensitivity <= 1.0:  # NaN is never inside
        raise ParameterError(f"sensitivity = {sensitivity!r}: must be in [0, 1], 0.5 leaves the preset as it is")
    if sensitivity == MIDDLE:
        return params
    factor = 4.0 ** (MIDDLE - sensitivity)
    decision = params.decision
    changed: NetworkParams = with_settings(
        params,
        {"decision": {
            "collision_spikes": max(1, math.floor(factor * decision.collision_spikes + 0.5)),
            "lptc_weight": factor * decision.lptc_weight,
        }},
        f"sensitivity {sensitivity:g}",
    )  # fmt: skip
    return changed
