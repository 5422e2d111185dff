"""The whole network, in the paper's order: retina, lamina, medulla, neurons, decision.

This is the definition, for reading and as the oracle of the C core. ``lobula.Network`` checks the input and runs
either.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..params import Params
from ..types import Image, Reading, Spikes, State
from .clock import SLACK_MS, Beat, Clock, ClockParams
from .decision import Decision, DecisionParams
from .lamina import Lamina, LaminaParams, OnOff
from .lamina.on_off import split_on_off
from .medulla.coarse import CoarseParams, coarse
from .neurons.lgmd import Lgmd, LgmdParams
from .neurons.lptc import Lptc, LptcParams
from .retina import (
    SAME_LIGHT,
    FlashParams,
    Light,
    SaturationParams,
    change_statistics,
    find_flash,
    frame_difference,
    saturate,
)
from .state import StateDict, load_state_dict, state_dict

LGMD_MAPS = ("inhibition_on", "inhibition_off", "summation", "grouped")
TAPS = (
    "change", "lamina", "adapted_on", "adapted_off", "motion",
    *(f"{neuron}_{layer}" for neuron in ("lgmd1", "lgmd2") for layer in LGMD_MAPS),
)  # fmt: skip
"""Maps that ``step(..., taps=...)`` can return, (H, W) float32 each."""


@dataclass(frozen=True, kw_only=True)
class NetworkParams(Params):
    """Every setting of the network, by layer."""

    clock: ClockParams = field(default_factory=ClockParams)
    flash: FlashParams = field(default_factory=FlashParams)
    saturation: SaturationParams = field(default_factory=SaturationParams)
    coarse: CoarseParams = field(default_factory=CoarseParams)
    lamina: LaminaParams = field(default_factory=LaminaParams)
    lgmd1: LgmdParams = field(default_factory=LgmdParams)
    lgmd2: LgmdParams = field(default_factory=LgmdParams)
    lptc: LptcParams = field(default_factory=LptcParams)
    decision: DecisionParams = field(default_factory=DecisionParams)


class ReferenceNetwork:
    """The network in NumPy. ``step`` takes luminance (H, W), uint8 or float32 in 0..255, already checked."""

    def __init__(self, p: NetworkParams, shape: tuple[int, int]) -> None:
        self.p = p
        self.shape = shape
        self.clock = Clock(p.clock)
        self.lamina = Lamina(p.lamina, shape)
        self.lgmds = tuple(Lgmd(q, p.clock.period_ms) for q in (p.lgmd1, p.lgmd2))
        self.lptc = Lptc(p.lptc, p.clock.period_ms)
        self.decision = Decision(p.decision)
        self.reset()

    def reset(self) -> None:
        """Return to before the first frame."""
        self.clock.reset()
        self._rest()
        self.decision.reset()
        self.turned_s: float | None = None

    def state_dict(self) -> StateDict:
        """Return a copy of everything it remembers; ``state.NAMES`` lists the entries."""
        return state_dict(self)

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Continue from a ``state_dict`` of either engine, made with the same settings and size."""
        load_state_dict(self, state)

    def _rest(self) -> None:
        """Empty every layer; what the decision remembers stays, so that a gap does not cut off an event."""
        self.luma = np.zeros(self.shape, np.float32)
        self.started_s = 0.0
        self.flashing = False
        self.change = OnOff(*(np.zeros(self.shape, np.float32) for _ in range(2)))
        self.lamina.reset()
        self.lptc.reset()
        for lgmd in self.lgmds:
            lgmd.reset()

    def step(self, image: NDArray[Any], time_s: float, *, turning: bool = False, taps: Collection[str] = ()) -> Reading:
        """Advance by one frame. ``turning`` says that the camera itself turns: nothing is decided meanwhile."""
        if turning:
            self.turned_s = time_s
            self.decision.clear()
        match self.clock.beat(time_s):
            case Beat.START:
                self._rest()
                self.luma = image.astype(np.float32)
                self.started_s = time_s
                self.decision.clear()
            case Beat.WAIT:
                pass
            case Beat.TICK:
                about = change_statistics(image, self.luma)
                dt_ms = self.clock.advances(time_s, about.mean_abs, about.max_abs)
                if dt_ms is not None:
                    light = find_flash(image, self.luma, about, self.p.flash)
                    return self._advance(image, light, time_s, dt_ms, turning, taps)
                self.flashing = False
        return self._reading(time_s, Spikes(), turning, {name: np.zeros(self.shape, np.float32) for name in taps})

    def _advance(
        self, image: NDArray[Any], light: Light | None, time_s: float, dt_ms: float, turning: bool,
        taps: Collection[str],
    ) -> Reading:  # fmt: skip
        ticks = dt_ms / self.p.clock.period_ms
        residual = self.p.lamina.on_off.residual**ticks
        change_scale = ticks**-self.p.clock.change_exponent
        whole = frame_difference(image, self.luma, change_scale, light or SAME_LIGHT)
        mean_change = float(np.abs(whole).sum(dtype=np.float64)) / whole.size
        patches = coarse(whole, self.p.coarse)
        p = saturate(whole, self.p.saturation)
        lamina = self.lamina.step(p, residual, self.p.clock.period_ms)
        change = OnOff(*split_on_off(p, *self.change, residual))
        maps: dict[str, Image] = {
            "change": p, "lamina": lamina.edges,
            "adapted_on": lamina.adapted.on, "adapted_off": lamina.adapted.off,
        }  # fmt: skip
        for name, lgmd in zip(("lgmd1", "lgmd2"), self.lgmds, strict=True):
            reads_change = lgmd.p.reads == "change"
            now, before = (change, self.change) if reads_change else (lamina.adapted, lamina.adapted_before)
            layers = lgmd.step(now, before, patches, mean_change, dt_ms)
            maps |= {f"{name}_{layer}": image for layer, image in layers.items()}
        maps["motion"] = self.lptc.step(lamina.adapted, lamina.adapted_before, ticks, change_scale)
        self.luma, self.change, self.flashing = image.astype(np.float32), change, light is not None

        lgmd1, lgmd2 = (lgmd.spikes() for lgmd in self.lgmds)
        spikes = Spikes(lgmd1, lgmd2, *self.lptc.spikes())
        if not self._warming_up(time_s) and not self._turning(time_s):
            self.decision.step(time_s, spikes, ticks)
        return self._reading(time_s, spikes, turning, {name: maps[name] for name in taps})

    def _warming_up(self, time_s: float) -> bool:
        return (time_s - self.started_s) * 1000.0 < self.p.decision.warm_up_ms - SLACK_MS

    def _turning(self, time_s: float) -> bool:
        if self.turned_s is None:
            return False
        return (time_s - self.turned_s) * 1000.0 <= self.p.decision.after_turn_ms + SLACK_MS

    def _reading(self, time_s: float, spikes: Spikes, turning: bool, taps: dict[str, Image]) -> Reading:
        state: State = "ok"
        if self._warming_up(time_s):
            state = "warming_up"
        elif turning or self._turning(time_s):
            state = "turning"
        elif self.flashing:
            state = "flash"
        lgmd1, lgmd2 = (lgmd.potential for lgmd in self.lgmds)
        return Reading(
            time_s, lgmd1, lgmd2, self.lptc.rightward, self.lptc.leftward, spikes,
            self.decision.collision(time_s), state, taps,
        )  # fmt: skip
