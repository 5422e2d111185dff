"""Lamina: centre-surround edges, ON and OFF channels, adaptation; shared by the four neurons."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ...params import Params
from ...types import Image
from .dog import DogParams, difference_of_gaussians
from .fdsr import FdsrParams, fdsr
from .on_off import OnOffParams, split_on_off


@dataclass(frozen=True, kw_only=True)
class LaminaParams(Params):
    """The second layer, in the order the signal takes."""

    dog: DogParams = field(default_factory=DogParams)
    on_off: OnOffParams = field(default_factory=OnOffParams)
    fdsr: FdsrParams = field(default_factory=FdsrParams)


class OnOff(NamedTuple):
    """A pair of channels, (H, W) each, >= 0."""

    on: Image
    off: Image


class LaminaOutput(NamedTuple):
    """What the lamina hands on: the edges and the adapted channels now and one step ago."""

    edges: Image
    adapted: OnOff
    adapted_before: OnOff


class Lamina:
    """DoG, ON/OFF split and adaptation; keeps the channels of the previous step."""

    def __init__(self, p: LaminaParams, shape: tuple[int, int]) -> None:
        self.p = p
        self.shape = shape
        self.reset()

    def reset(self) -> None:
        """Return to before the first frame: every channel empty."""
        self.channels = OnOff(*(np.zeros(self.shape, np.float32) for _ in range(2)))
        self.adapted = OnOff(*(np.zeros(self.shape, np.float32) for _ in range(2)))

    def step(self, change: Image, residual: float, clock_ms: float) -> LaminaOutput:
        """Advance one step; ``residual`` is the share of the previous channel kept over it."""
        edges = difference_of_gaussians(change, self.p.dog)
        channels = OnOff(*split_on_off(edges, *self.channels, residual))
        pairs = zip(channels, self.channels, strict=True)
        adapted = OnOff(*(fdsr(now, before, self.p.fdsr, clock_ms) for now, before in pairs))
        output = LaminaOutput(edges, adapted, self.adapted)
        self.channels, self.adapted = channels, adapted
        return output
