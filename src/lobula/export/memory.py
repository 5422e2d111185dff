"""How much memory a network takes on a robot, and which size fits what is there."""

from __future__ import annotations

import math
from bisect import bisect_right

from ..checks import MIN_HEIGHT, MIN_WIDTH
from ..errors import ParameterError
from ..model.network import NetworkParams
from .config_header import config_header
from .constants import constant
from .sources import c_sources

MAX_SIDE = 4096
"""Largest picture that is exported, px: no robot's camera has more."""

SIZES = "lobula_sizes.h"

WAY_IN = 24
"""Bytes of ``lobula_state`` beside that memory: the time, and three numbers of the frame that comes in."""


STACK = 2560
"""Bytes of stack that a step takes at most; ``make firmware-test`` measures it on a Cortex-M4F, and fails above it."""


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
    text = config_header(params, "", width, height) + c_sources()[SIZES]
    return WAY_IN + constant("LOBULA_MEMORY_BYTES", text)


def require_ram(params: NetworkParams, width: int, height: int, ram_kib: float) -> None:
    """Check that the network and the stack that it needs fit into ``ram_kib`` KiB.

    Raises
    ------
    ParameterError : it does not; the line says what it needs and what would fit
    """
    if not (math.isfinite(ram_kib) and ram_kib > 0):
        raise ParameterError(f"--ram {ram_kib:g}: must be a number of KiB above 0")
    needed = state_bytes(params, width, height) + STACK
    if needed <= ram_kib * 1024:
        return
    fits = largest_size(params, width, height, ram_kib)
    if fits is not None:
        rest = f"the largest of this shape that fits is {fits[0]} x {fits[1]}"
    else:
        least = state_bytes(params, MIN_WIDTH, MIN_HEIGHT) + STACK
        rest = f"none of this shape fits; the least there is, {MIN_WIDTH} x {MIN_HEIGHT}, needs {in_kib(least)}"
    raise ParameterError(
        f"--ram {ram_kib:g}: {width} x {height} px need {in_kib(needed)} with these settings, {in_kib(STACK)} of stack "
        f"among it: {rest}"
    )


def largest_size(params: NetworkParams, width: int, height: int, ram_kib: float) -> tuple[int, int] | None:
    """Return the largest (width, height) of that shape that fits with its stack, None where none does."""
    sizes = [(columns, round(columns * height / width)) for columns in range(MIN_WIDTH, width + 1)]
    sizes = [size for size in sizes if size[1] >= MIN_HEIGHT]
    fitting = bisect_right(sizes, ram_kib * 1024 - STACK, key=lambda size: state_bytes(params, *size))
    return sizes[fitting - 1] if fitting else None


def in_kib(size: int) -> str:
    """Return ``size`` bytes in words, rounded up: what is said to be enough is enough."""
    return f"{math.ceil(size / 102.4) / 10:.1f} KiB"
