"""Everything that is compared on labelled clips, with every threshold: each clip run through all of it once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..engine.network import Network
from ..model.network import NetworkParams
from ..model.presets import preset
from ..params import with_settings
from ..runtime.opening import open as open_frames
from ..types import Frame
from .labels import Label
from .scoring import ClipScore, last_frame, score_clip
from .signals import SIGNALS, score_signal, signal_trace

SIZES = {(99, 72): "ultrafast", (320, 240): "fast"}
"""Working sizes of the signals and the preset of the flow at each: the network's own, and what a user might take."""

THRESHOLDS = np.geomspace(1e-3, 1e5, 241)
"""Of the signals, in steps of 8 %; fixed beforehand, so that no clip has a say in them."""

SPIKES = range(1, 21)
POTENTIALS = np.arange(50, 97, 2) / 100
WHO = {"lgmd2": "LGMD-2 alone", "lgmds": "the LGMD pair", "all": "all four neurons"}
BASE = "paper"
FIXED = ("paper", "published", "lobula")


class Gathered(NamedTuple):
    """Scores by contender: of presets with nothing chosen, and of candidates of which one is to be chosen."""

    fixed: dict[str, dict[str, ClipScore]]
    candidates: dict[str, dict[str, dict[str, ClipScore]]]


def gather(labels: Sequence[Label], clips: Path, advance: Callable[[], None]) -> Gathered:
    """Run every contender with every candidate over every clip; ``advance`` is called for each clip.

    Raises
    ------
    FrameSourceError : a clip cannot be read
    """
    found = Gathered({}, {})
    models = dict(_models())
    for label in labels:
        for size, flow in SIZES.items():
            pictures = list(_pictures(clips / label.file, label, size))
            _score_signals(found.candidates, label, pictures, size, flow)
            if size == (99, 72):
                for name in FIXED:
                    found.fixed.setdefault(name, {})[label.file] = _score_network(preset(name), label, pictures)
                for name, candidates in models.items():
                    for candidate, params in candidates.items():
                        by_clip = found.candidates.setdefault(name, {}).setdefault(candidate, {})
                        by_clip[label.file] = _score_network(params, label, pictures)
        advance()
    return found


def _models() -> Iterator[tuple[str, dict[str, NetworkParams]]]:
    """Yield each selection of neurons with the settings at each of its thresholds."""
    for neurons, words in WHO.items():
        base = preset(BASE, neurons=neurons)
        spikes = {f"{n}": {"decision": {"collision_spikes": n}} for n in SPIKES}
        spiking = {f"{u:.2f}": {"spiking": {"threshold": float(u)}} for u in POTENTIALS}
        yield (
            f"{words}, spikes for an alarm",
            {text: with_settings(base, changed, "candidate") for text, changed in spikes.items()},
        )
        yield (
            f"{words}, T_sp",
            {text: with_settings(base, {"lgmd1": one, "lgmd2": one}, "candidate") for text, one in spiking.items()},
        )


def _score_signals(
    found: dict[str, dict[str, dict[str, ClipScore]]], label: Label, pictures: Sequence[Frame],
    size: tuple[int, int], flow: str,
) -> None:  # fmt: skip
    trace = signal_trace(pictures, flow)
    for name in SIGNALS:
        known: dict[bytes, ClipScore] = {}  # most thresholds lie between the same two values
        for threshold in THRESHOLDS:
            above = (trace.signals[name] > threshold).tobytes()
            if above not in known:
                known[above] = score_signal(label, trace, trace.signals[name], float(threshold))
            by_clip = found.setdefault(f"{name}, {size[0]}x{size[1]}", {}).setdefault(f"{threshold:.3g}", {})
            by_clip[label.file] = known[above]


def _score_network(params: NetworkParams, label: Label, pictures: Sequence[Frame]) -> ClipScore:
    images, times_s = np.stack([picture.image for picture in pictures]), [picture.time_s for picture in pictures]
    trace = Network(params).run(images, times_s)
    trace["frame"] = [picture.index for picture in pictures]
    return score_clip(label, trace)


def _pictures(path: Path, label: Label, size: tuple[int, int]) -> Iterator[Frame]:
    last = last_frame(label)
    with open_frames(path, size=size) as frames:
        for frame in frames:
            if last is not None and frame.index > last:
                return
            yield frame
