"""Elementary motion detectors (EMD): pairs of cells that compare now with a moment ago, Eq. (3) of the paper."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...errors import ParameterError
from ...params import Params, param
from ...types import Image
from ..clock import whole_quarters
from ..filters import low_pass_share


@dataclass(frozen=True, kw_only=True)
class EmdParams(Params):
    """Every cell meets its right-hand neighbours at several spans, each pair with the delay of its span."""

    spans_px: tuple[int, ...] = param(
        (1, 2, 3, 4),
        "px",
        "distances of the paired cells",
        low=1,
        high=64,
        source="chosen: what passes a robot moves 1 to 3 px",
    )
    delays_ms: tuple[float, ...] = param(
        (40.0, 30.0, 20.0, 10.0), "ms", "delay of each span", low=0.1, high=500, source="published code: LPLC2"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if len(self.spans_px) != len(self.delays_ms) or len(self.spans_px) > MAX_SPANS:
            raise ParameterError(
                f"EmdParams.spans_px has {len(self.spans_px)} entries, delays_ms {len(self.delays_ms)}: "
                f"must be as many, at most {MAX_SPANS}"
            )


MAX_SPANS = 8


MAX_STRETCH = 4.0
"""Spans stretch up to this many ticks, for sources down to 7.5 Hz."""


class Motion(NamedTuple):
    """Local motion (H, W), positive rightward, luminance units squared; and its sum in float64."""

    image: Image
    total: float


def stretched(spans_px: tuple[int, ...], ticks: float) -> tuple[int, ...]:
    """Return the spans for a step of ``ticks``, in whole quarters, px, at least 1."""
    times = whole_quarters(min(ticks, MAX_STRETCH))
    return tuple(max(1, math.floor(span * times + 0.5)) for span in spans_px)


def emd(
    channel: Image, previous: Image, p: EmdParams, clock_ms: float, ticks: float, change_scale: float = 1.0
) -> Motion:  # fmt: skip
    """Correlate one channel, (H, W) and >= 0, with itself over all spans.

    Each cell X1 meets the cell X2 that lies d pixels to its right,

        R_d = D[X1] X2 - X1 D[X2],   D[X] = a X(t) + (1 - a) X(t-1),   a = clock / (clock + tau_d)

    where the products X1(t) X2(t) cancel: R_d = (1 - a)(X1(t-1) X2(t) - X1(t) X2(t-1)). R > 0 for rightward motion,
    R < 0 for leftward, 0 for a still picture. Pairs lie wholly inside the picture and are booked at X1. In a step of
    several clock ticks things go further: the spans are stretched with it, so the speed they prefer stays. Such a step
    counts its change ``change_scale`` times, a product of two changes the square of that; once is divided out, so
    that motion shrinks as the sums of the LGMDs do that it is compared with.

    Source: paper Eq. (3); delays from LPLC2 (docs/sources.md).
    Reading: the pure delay of Eq. (3) is the two-tap low-pass of the published code.
    """
    motion = np.zeros_like(channel)
    total = 0.0
    for span, delay in zip(stretched(p.spans_px, ticks), p.delays_ms, strict=True):
        if span >= channel.shape[1]:
            continue
        share = np.float32((1.0 - low_pass_share(clock_ms, delay)) / change_scale)
        pairs = share * (previous[:, :-span] * channel[:, span:] - channel[:, :-span] * previous[:, span:])
        motion[:, :-span] += pairs
        total += float(pairs.sum(dtype=np.float64))
    return Motion(motion, total)
