"""One mechanism off at a time: what it costs on approach, recession, translation, noise and changes of light."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..engine.network import Network
from ..model.network import NetworkParams
from ..params import with_settings
from ..stimuli import Movie, looming, translating
from .battery import Scored, score
from .outcome import Engine

Cut = Callable[[NetworkParams], NetworkParams]


def _set(**settings: Any) -> Cut:
    return lambda params: with_settings(params, settings, "ablation")


def _no_bias(params: NetworkParams) -> NetworkParams:
    return replace(params, lgmd2=replace(params.lgmd2, on=params.lgmd2.off))


ABLATIONS: dict[str, Cut] = {
    "nothing": lambda params: params,
    "DoG": _set(lamina={"dog": {"enabled": False}}),
    "FDSR": _set(lamina={"fdsr": {"enabled": False}}),
    "ON/OFF bias": _no_bias,
    "grouping": _set(lgmd1={"grouping": {"enabled": False}}, lgmd2={"grouping": {"enabled": False}}),
    "SFA": _set(lgmd1={"sfa": {"enabled": False}}, lgmd2={"sfa": {"enabled": False}}),
    "flash": _set(flash={"enabled": False}),
    "LPTC veto": _set(decision={"lptc_weight": 0.0}),
}
"""Name of the mechanism to the change of settings that takes it away."""


@dataclass(frozen=True, kw_only=True)
class Cost:
    """How the battery goes without one mechanism."""

    without: str
    approaches_seen: tuple[int, int]
    """Dark approaches that called a collision before contact, of how many."""
    recession_alarms: tuple[int, int]
    recession_lgmd2_spikes: int
    """Dark objects, both."""
    translation_alarms: tuple[int, int]
    noise_spikes: int
    light_spikes: int
    """All four neurons, over the still and noisy movies, and over flicker and flashes."""
    light_alarms: tuple[int, int]


def ablate(params: NetworkParams, engine: Engine = "auto") -> Iterator[Cost]:
    """Yield the cost of each of ``ABLATIONS`` on ``params``.

    Without the DoG or FDSR the signal is many times larger. So that what is compared is selectivity and not gain, the
    thresholds and scales behind the cut are set anew, to the same drive on one approach and one translation.
    """
    for name, cut in ABLATIONS.items():
        yield _cost(name, score(_rescaled(cut(params), params, engine), engine=engine))


def _rescaled(cut: NetworkParams, whole: NetworkParams, engine: Engine) -> NetworkParams:
    approach, passing = looming(scene="arena"), translating(scene="arena", distance_cm=6.0)
    taps = ("adapted_on", "adapted_off")
    lgmd = {}
    gain = _largest(cut, approach, taps, engine) / _largest(whole, approach, taps, engine)
    for name in ("lgmd1", "lgmd2"):
        p = getattr(cut, name)
        grouping = replace(p.grouping, threshold_grey=gain * p.grouping.threshold_grey)
        if p.reads == "lamina":
            lgmd[name] = replace(p, grouping=grouping)
    scaled = replace(cut, **lgmd)
    for name in lgmd:
        drive = _largest(scaled, approach, (f"{name}_grouped",), engine)
        p = getattr(scaled, name)
        scale = p.sigmoid_grey * drive / _largest(whole, approach, (f"{name}_grouped",), engine)
        scaled = replace(scaled, **{name: replace(p, sigmoid_grey=scale)})
    motion = _largest(scaled, passing, ("motion",), engine) / _largest(whole, passing, ("motion",), engine)
    return replace(scaled, lptc=replace(scaled.lptc, sigmoid_grey2=motion * scaled.lptc.sigmoid_grey2))


def _largest(params: NetworkParams, movie: Movie, taps: tuple[str, ...], engine: Engine) -> float:
    """Largest mean of the named maps over the movie."""
    net = Network(params, engine=engine)
    return max(
        abs(sum(float(image.mean(dtype=np.float64)) for image in net.step(frame, taps=taps).taps.values()))
        for frame in movie.frames()
    )


def _cost(name: str, battery: list[Scored]) -> Cost:
    def of(*kinds: str) -> list[Scored]:
        return [s for s in battery if s.case.expectation.kind.startswith(kinds)]

    def dark(kind: str) -> list[Scored]:
        return [s for s in of(kind) if s.case.expectation.dark]

    def alarms(scored: list[Scored]) -> tuple[int, int]:
        return sum(s.result.all_s is not None for s in scored), len(scored)

    def spikes(scored: list[Scored]) -> int:
        return sum(sum(s.result.spikes.values()) for s in scored)

    receding, light = dark("receding"), of("flicker", "flash")
    return Cost(
        without=name,
        approaches_seen=alarms(dark("looming")),
        recession_alarms=alarms(receding),
        recession_lgmd2_spikes=sum(s.result.spikes["lgmd2"] for s in receding),
        translation_alarms=alarms(dark("translating")),
        noise_spikes=spikes(of("still", "noise")),
        light_spikes=spikes(light),
        light_alarms=alarms(light),
    )
