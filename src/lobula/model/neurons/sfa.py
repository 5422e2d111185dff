"""Spike frequency adaptation (SFA): a potential that no longer grows fades."""

from __future__ import annotations

from dataclasses import dataclass

from ...params import Params, param


@dataclass(frozen=True, kw_only=True)
class SfaParams(Params):
    """Looming keeps the potential growing; a passing or receding object does not."""

    enabled: bool = param(True, "", "off: the potential is not adapted (ablation)", source="published code: LGMD2")
    tau_ms: float = param(
        800.0, "ms", "time constant of the fading", low=10, high=10_000, source="published code: LGMD2"
    )
    growth: float = param(
        0.003, "1/tick", "growth for each clock tick above which nothing fades", low=0, high=0.5,
        source="published code: LGMD2",
    )  # fmt: skip


def adapt(raw: float, raw_before: float, potential: float, p: SfaParams, dt_ms: float, clock_ms: float) -> float:
    """Return the adapted potential from the raw one now and one step ago, and the adapted one of the step before.

        dK <= growth:  a (U(t-1) + dK)     otherwise:  a K(t);     a = tau / (tau + dt), floor 0.5

    Source: published code (docs/sources.md); in both LGMD papers the paper cites, not printed in it.
    """
    if not p.enabled:
        return raw
    share = p.tau_ms / (p.tau_ms + dt_ms)
    change = raw - raw_before
    adapted = potential + change if change <= p.growth * dt_ms / clock_ms else raw
    return max(0.5, share * adapted)
