"""ON and OFF channels, and what adaptation leaves of them, one number at a time."""

from __future__ import annotations

Rows = list[list[float]]
CLOCK_MS = 1000 / 30


def share(tau_ms: float) -> float:
    """The present input's part of a two-tap low-pass on the model clock."""
    return CLOCK_MS / (CLOCK_MS + tau_ms)


def on_off(rows: Rows, on: Rows, off: Rows, residual: float) -> tuple[Rows, Rows]:
    """Half-wave rectification, plus what is left of the last step."""
    new_on = [[max(v, 0.0) + residual * on[y][x] for x, v in enumerate(line)] for y, line in enumerate(rows)]
    new_off = [[max(-v, 0.0) + residual * off[y][x] for x, v in enumerate(line)] for y, line in enumerate(rows)]
    return new_on, new_off


def adapted(value: float, before: float) -> float:
    """FDSR of one cell: X - D, rectified; 1 ms where X rises and 100 ms where it falls."""
    a = share(1.0) if value >= before else share(100.0)
    return max(value - (a * value + (1 - a) * before), 0.0)


def fdsr(now: Rows, before: Rows) -> Rows:
    """FDSR of a whole channel."""
    return [[adapted(x, b) for x, b in zip(*lines, strict=True)] for lines in zip(now, before, strict=True)]
