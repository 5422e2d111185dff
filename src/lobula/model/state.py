"""What a network remembers, as a plain dictionary: the same names from both engines, ready for ``numpy.savez``."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import ParameterError, ShapeError
from .decision import Entry
from .lamina import OnOff

if TYPE_CHECKING:
    from .network import ReferenceNetwork

StateDict = dict[str, Any]

PLANES = ("luma", "on", "off", "adapted_on", "adapted_off", "change_on", "change_off")
"""Maps (H, W) float32: the picture last taken in, the channels and the adapted channels of the lamina, and the channels
of the change itself."""

TIMES = ("frame_s", "tick_s", "step_s", "started_s", "turned_s", "held_s")
"""Moments, s; NaN where there was none yet: the last frame, tick and step, the start, the last turn, and
when the rule of the decision last held."""

NUMBERS = (
    "still", "flashing", "lgmd1_raw", "lgmd1_potential", "lgmd1_change_before", "lgmd2_raw",
    "lgmd2_potential", "lgmd2_change_before", "lptc_r", "lptc_l",
)  # fmt: skip

NAMES = (*PLANES, *TIMES, *NUMBERS, "window")
"""Every entry; ``window`` is (N, 4): time and the weighted spikes of LGMD-1, LGMD-2 and LPTC of each step in it."""


def check_state(state: Mapping[str, Any], shape: tuple[int, int]) -> None:
    """Raise where ``state`` is not one of a network of this ``shape``.

    Raises
    ------
    ParameterError : an entry is missing
    ShapeError : a plane of another size
    """
    for name in NAMES:
        if name not in state:
            raise ParameterError(f"load_state_dict: no entry {name!r}: must hold {', '.join(NAMES)}")
    for name in PLANES:
        if np.shape(state[name]) != tuple(shape):
            raise ShapeError(f"load_state_dict: {name} has shape {np.shape(state[name])}: must be {tuple(shape)}")
    if np.ndim(state["window"]) != 2 or np.shape(state["window"])[1] != 4:
        raise ShapeError(f"load_state_dict: window has shape {np.shape(state['window'])}: must be (N, 4)")


def state_dict(net: ReferenceNetwork) -> StateDict:
    """Return a copy of everything ``net`` remembers."""
    planes = (net.luma, *net.lamina.channels, *net.lamina.adapted, *net.change)
    times = (net.clock.frame_s, net.clock.tick_s, net.clock.step_s, net.started_s, net.turned_s, net.decision.held_s)
    numbers: list[float] = [net.clock.still, net.flashing]
    for lgmd in net.lgmds:
        numbers += [lgmd.raw, lgmd.potential, lgmd.change_before]
    numbers += [net.lptc.rightward, net.lptc.leftward]
    return {
        **{name: plane.copy() for name, plane in zip(PLANES, planes, strict=True)},
        **{name: math.nan if time is None else float(time) for name, time in zip(TIMES, times, strict=True)},
        **dict(zip(NUMBERS, numbers, strict=True)),
        "window": np.array(net.decision.window, np.float64).reshape(-1, 4),
    }


def load_state_dict(net: ReferenceNetwork, state: Mapping[str, Any]) -> None:
    """Make ``net`` continue from ``state``.

    Raises
    ------
    ParameterError, ShapeError : as ``check_state``
    """
    check_state(state, net.shape)
    luma, on, off, adapted_on, adapted_off, change_on, change_off = (
        np.array(state[name], np.float32) for name in PLANES
    )
    net.luma, net.change = luma, OnOff(change_on, change_off)
    net.lamina.channels, net.lamina.adapted = OnOff(on, off), OnOff(adapted_on, adapted_off)
    net.clock.frame_s, tick_s, step_s, started_s, net.turned_s, net.decision.held_s = (
        None if math.isnan(state[name]) else float(state[name]) for name in TIMES
    )
    net.clock.tick_s, net.clock.step_s, net.started_s = tick_s or 0.0, step_s or 0.0, started_s or 0.0
    net.clock.still, net.flashing = bool(state["still"]), bool(state["flashing"])
    for name, lgmd in zip(("lgmd1", "lgmd2"), net.lgmds, strict=True):
        lgmd.raw, lgmd.potential = float(state[f"{name}_raw"]), float(state[f"{name}_potential"])
        lgmd.change_before = float(state[f"{name}_change_before"])
    net.lptc.rightward, net.lptc.leftward = float(state["lptc_r"]), float(state["lptc_l"])
    net.decision.window = deque(Entry(*map(float, row)) for row in np.asarray(state["window"]))
