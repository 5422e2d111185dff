"""Time stamps of one steady source as different programs write them, s."""

from __future__ import annotations

from itertools import accumulate, repeat

from lobula.model.clock import Beat, Clock, ClockParams

HABITS = ("multiplied", "summed", "backwards", "ms", "us", "90 kHz", "float32", "epoch")


def written(hz: float, count: int, habit: str) -> list[float]:
    """Return the stamps of ``count`` frames at ``hz``: exact but for the last bit, summed up, or rounded."""
    exact = [k / hz for k in range(count)]
    match habit:
        case "summed":
            return [0.0, *accumulate(repeat(1.0 / hz, count - 1))]
        case "backwards":  # sums that fall short where the plain ones run over
            return [(count / hz) - t for t in accumulate(repeat(1.0 / hz, count))][::-1]
        case "ms" | "us" | "90 kHz":
            unit = {"ms": 1e3, "us": 1e6, "90 kHz": 9e4}[habit]
            return [round(t * unit) / unit for t in exact]
        case "float32":
            return [round(t * 2**20) / 2**20 for t in exact]  # 24 bits, up to 16 s
        case "epoch":
            return [1.7e9 + t for t in exact]
    return exact


def steps_ms(hz: float, count: int, habit: str) -> list[float]:
    """Return the lengths of the network's steps over ``count`` frames, none of which repeats the one before."""
    clock, told = Clock(ClockParams()), []
    for t in written(hz, count, habit):
        if clock.beat(t) is Beat.TICK:
            dt_ms = clock.advances(t, 50.0, 50.0)
            assert dt_ms is not None
            told.append(dt_ms)
    return told
