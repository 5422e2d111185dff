"""First-order filters as the published code writes them: two taps, present and previous input."""

from __future__ import annotations


def low_pass_share(dt_ms: float, tau_ms: float) -> float:
    """Return a = dt / (dt + tau): the share of the present input; 1 - a is the share of the previous one.

    ``dt_ms`` is the model clock, whatever the frames' own interval: the two taps say how much of the last step an
    effect keeps, and steps of another length keep as much (docs/time.md tells what else was tried).

    Source: published code of the LGMD family.
    """
    return dt_ms / (dt_ms + tau_ms)
