"""First-order filters as the published code writes them: two taps, present and previous input."""

from __future__ import annotations


def low_pass_share(dt_ms: float, tau_ms: float) -> float:
    """Return a = dt / (dt + tau): the share of the present input; 1 - a is the share of the previous one.

    Source: published code of the LGMD family (MODEL.md, section 0).
    """
    return dt_ms / (dt_ms + tau_ms)
