"""How much memory a network takes on a robot, and which size fits what is there."""

from __future__ import annotations

import math

from ..checks import MIN_HEIGHT, MIN_WIDTH
from ..errors import ParameterError
from ..model.network import NetworkParams

MAX_SIDE = 4096
"""Largest picture that is exported, px: no robot's camera has more."""

HEADER = 1264
"""Bytes of the settings, the sizes and the numbers that change with each step."""


def require_size(width: int, height: int) -> None:
    """Check the size of the picture.

    Raises
    ------
    ParameterError : it is below what the kernels need, or above ``MAX_SIDE``
    """
    if not (MIN_WIDTH <= width <= MAX_SIDE and MIN_HEIGHT <= height <= MAX_SIDE):
        raise ParameterError(
            f"size {width} x {height} px (width x height): must be {MIN_WIDTH} x {MIN_HEIGHT} "
            f"to {MAX_SIDE} x {MAX_SIDE}"
        )


def state_bytes(params: NetworkParams, width: int, height: int) -> int:
    """Return ``sizeof(lobula_state)``: all that the network remembers and works in, as lobula_sizes.h adds it up."""
    dog, lgmds = params.lamina.dog, (params.lgmd1, params.lgmd2)
    fdsr = params.lamina.fdsr.enabled
    layers = {lgmd.reads for lgmd in lgmds}
    inner = dog.radius_px if dog.enabled else 0
    outer = inner * dog.surround
    spacing = max(lgmd.neighbour_px for lgmd in lgmds)
    ring, excited = _power_of_two(2 * spacing + 2), _power_of_two(spacing + 2)
    pixels = width * height

    cell = 4 + 2 * fdsr + 4 * ("change" in layers)
    steps = (int(params.decision.window_ms) + 1) * 10 // (int(params.clock.period_ms) * 6) + 3
    remembered = HEADER + _eights(4 * (inner + outer + 2)) + 24 * steps + _eights(pixels) + _eights(cell * pixels)

    margin = max(spacing, outer, 4 * max(params.lptc.emd.spans_px))
    short_rows = 2 * outer + 2 + 10 * ring + 4
    long_rows = 4 * (outer > 0) + (2 if fdsr else 8) + len(layers) * (2 * excited + 4) + 4
    floats = short_rows * width + long_rows * (2 * margin + width + 1)
    return remembered + _eights(4 * floats) + 2 * _eights(2 * (pixels + 1))


def require_ram(params: NetworkParams, width: int, height: int, ram_kib: float) -> None:
    """Check that the network fits into ``ram_kib`` KiB.

    Raises
    ------
    ParameterError : it does not; the line says what it needs and what would fit
    """
    if not (math.isfinite(ram_kib) and ram_kib > 0):
        raise ParameterError(f"--ram {ram_kib:g}: must be a number of KiB above 0")
    needed = state_bytes(params, width, height)
    if needed <= ram_kib * 1024:
        return
    fits = largest_size(params, width, height, ram_kib)
    if fits is not None:
        rest = f"the largest of this shape that fits is {fits[0]} x {fits[1]}"
    else:
        least = state_bytes(params, MIN_WIDTH, MIN_HEIGHT)
        rest = f"none of this shape fits; the least there is, {MIN_WIDTH} x {MIN_HEIGHT}, needs {_kib(least)}"
    raise ParameterError(f"--ram {ram_kib:g}: {width} x {height} px need {_kib(needed)} with these settings: {rest}")


def largest_size(params: NetworkParams, width: int, height: int, ram_kib: float) -> tuple[int, int] | None:
    """Return the largest (width, height) of the shape of ``width`` x ``height`` that fits, None where none does."""
    for columns in range(width, MIN_WIDTH - 1, -1):
        rows = round(columns * height / width)
        if rows < MIN_HEIGHT:
            break
        if state_bytes(params, columns, rows) <= ram_kib * 1024:
            return columns, rows
    return None


def _kib(size: int) -> str:
    """Round up: what is said to be enough is enough."""
    return f"{math.ceil(size / 102.4) / 10:.1f} KiB"


def _eights(size: int) -> int:
    return (size + 7) // 8 * 8


def _power_of_two(at_least: int) -> int:
    n = 4
    while n < at_least:
        n *= 2
    return n
