"""What saturates, and what patches hear, cell by cell."""

from __future__ import annotations

Rows = list[list[float]]


def saturated(rows: Rows, limit: float) -> Rows:
    """No change counts more than ``limit``."""
    return [[min(abs(v), limit) * (1 if v > 0 else -1) for v in line] for line in rows]


def heard(rows: Rows, side: int, floor: float) -> tuple[float, float]:
    """Return ON and OFF of all whole patches: how far each mean is beyond the floor, times its pixels."""
    on = off = 0.0
    for top in range(0, len(rows) - side + 1, side):
        for left in range(0, len(rows[0]) - side + 1, side):
            mean = sum(sum(line[left : left + side]) for line in rows[top : top + side]) / side**2
            if mean > floor:
                on += (mean - floor) * side**2
            if mean < -floor:
                off += (-mean - floor) * side**2
    return on, off
