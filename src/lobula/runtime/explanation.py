"""Why the network did, or did not, alarm at a given moment: the layers, the sums, the rule."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..engine.network import Network
from ..errors import ParameterError
from ..frames.source import FrameSource
from ..model.clock import SLACK_MS
from ..model.decision import Decision, Entry
from ..model.network import TAPS, NetworkParams
from ..types import Frame, Image, Reading

_SPEAKING_FOR_IT = ("approach", "not passing")


class Condition(NamedTuple):
    """One part of the rule: its name, whether it holds, and the numbers that say so."""

    name: str
    holds: bool
    because: str


class Layer(NamedTuple):
    """One map in two numbers: the mean and the largest of its absolute values."""

    mean: float
    peak: float


@dataclass(frozen=True, kw_only=True)
class Explanation:
    """What the network made of one frame.

    Attributes
    ----------
    frame, reading : the frame and what the network said of it; ``reading.taps`` holds every map
    advanced : whether the frame moved the network on; one that repeats the frame before, or that a fast source adds
        to an unfinished tick, does not, and its maps are empty
    layers : every map in two numbers
    window : the spikes that the decision looks back on, oldest first, weighted by the length of their step
    lgmd, lptc : A and B of the rule, the sums over the window
    conditions : every part of the rule; a collision needs all of them
    """

    frame: Frame
    reading: Reading
    advanced: bool
    layers: Mapping[str, Layer]
    window: tuple[Entry, ...]
    lgmd: float
    lptc: float
    conditions: tuple[Condition, ...]

    @property
    def verdict(self) -> str:
        """One sentence: the decision and what it hangs on."""
        unmet = next((c.because for c in self.conditions if not c.holds), None)
        if unmet is None:
            return "collision: " + "; ".join(c.because for c in self.conditions if c.name in _SPEAKING_FOR_IT)
        return (
            f"collision, since the rule held a moment ago: now {unmet}"
            if self.reading.collision
            else (f"no collision: {unmet}")
        )


def explain(
    source: FrameSource,
    network: Network,
    at_s: float,
    *,
    yaw_rate_deg_s: Callable[[float], float] | None = None,
) -> Explanation:
    """Run ``network`` from the first frame of ``source`` to the one nearest ``at_s`` and explain that one.

    ``yaw_rate_deg_s`` gives the rate at which the camera itself turned at a frame's time, s.

    Raises
    ------
    ParameterError : a live source, or a moment outside the source
    FrameSourceError : the source failed on the way
    """
    if source.live:
        raise ParameterError(f"{source.name}: is live: must be a recording, whose moments can be found again")
    if not (math.isfinite(at_s) and at_s >= 0):
        raise ParameterError(f"at {at_s:g} s: must be a time of 0 s or more")
    for frame, following in _with_following(source):
        wanted = following is None or abs(frame.time_s - at_s) <= abs(following.time_s - at_s)
        rate_deg_s = None if yaw_rate_deg_s is None else yaw_rate_deg_s(frame.time_s)
        reading = network.step(frame, yaw_rate_deg_s=rate_deg_s, taps=TAPS if wanted else ())
        if wanted:
            gap_s = max(1.0 / source.fps if source.fps else 0.0, 0.1)
            if following is None and at_s > frame.time_s + gap_s:
                raise ParameterError(f"at {at_s:g} s: {source.name} ends at {frame.time_s:.3f} s: must lie inside it")
            return _explanation(frame, reading, network.params, network.state_dict())
    raise ParameterError(f"{source.name}: holds no frame")


def _with_following(source: FrameSource) -> Iterator[tuple[Frame, Frame | None]]:
    frame = next(source, None)
    while frame is not None:
        following = next(source, None)
        yield frame, following
        frame = following


def _explanation(frame: Frame, reading: Reading, p: NetworkParams, state: Mapping[str, Any]) -> Explanation:
    decision = _decision(p, state)
    lgmd, lptc = decision.evidence(frame.time_s)
    conditions = conditions_at(frame.time_s, p, state)
    layers = {name: _layer(reading.taps[name]) for name in TAPS}
    return Explanation(
        frame=frame, reading=reading, advanced=state["step_s"] == frame.time_s, layers=layers,
        window=tuple(decision.window), lgmd=lgmd, lptc=lptc, conditions=conditions,
    )  # fmt: skip


def _decision(p: NetworkParams, state: Mapping[str, Any]) -> Decision:
    decision = Decision(p.decision)
    decision.window = deque(Entry(*map(float, row)) for row in state["window"])
    return decision


def _layer(image: Image | NDArray[Any]) -> Layer:
    size = np.abs(image)
    return Layer(float(size.mean(dtype=np.float64)), float(size.max()))


def conditions_at(time_s: float, p: NetworkParams, state: Mapping[str, Any]) -> tuple[Condition, ...]:
    """Return the rule of ``Decision.holds`` taken apart, and what keeps it from being asked at all.

    ``state`` is the ``state_dict`` of a network with the settings ``p`` as it was at ``time_s``, s.
    """
    d, decision = p.decision, _decision(p, state)
    a, b = (math.floor(x + 0.5) for x in decision.evidence(time_s))
    alone = d.neurons == "lgmd2"
    who, window = "LGMD-2" if alone else "both LGMDs", f"in the last {d.window_ms:g} ms"
    steps = sum(e.lgmd2 > 0 and (alone or e.lgmd1 > 0) for e in decision.window)
    enough = a >= d.collision_spikes
    conditions = [
        _since(time_s, state["started_s"], d.warm_up_ms, "warmed up", "the start", at_once=True),
        _since(time_s, state["turned_s"], d.after_turn_ms, "not turning", "the last turn"),
        Condition("more than one step", steps >= 2, f"{who} spiked in {steps} steps {window}, 2 are needed"),
        Condition("approach", enough, f"{who} gave {a} spikes {window}, {d.collision_spikes} are needed"),
    ]
    if d.neurons == "all":
        wins, factor = a > d.lptc_weight * b, "" if d.lptc_weight == 1 else f"{d.lptc_weight:g} x "
        says = f"{a} spikes of the LGMDs are {'more' if wins else 'not more'} than {factor}{b} of the LPTCs {window}"
        conditions.append(Condition("not passing", wins, says))
    return tuple(conditions)


def _since(time_s: float, begun_s: float, span_ms: float, name: str, what: str, at_once: bool = False) -> Condition:
    """Whether more than ``span_ms`` have passed since ``begun_s``, or, ``at_once``, just as much; NaN: it never was."""
    passed_ms = (time_s - begun_s) * 1000.0
    if math.isnan(passed_ms):
        return Condition(name, True, "the camera has not turned")
    holds = passed_ms >= span_ms - SLACK_MS if at_once else passed_ms > span_ms + SLACK_MS
    return Condition(name, holds, f"{passed_ms:.0f} ms since {what}, {span_ms:g} are needed")
