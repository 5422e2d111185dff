"""How each neuron and state looks: one set of labels, ranges and colours for the video, the plots and the page.

The four neuron colours and the red of a collision stay apart for the three kinds of colour blindness. Red means
collision and nothing else, and never stands alone: a word or a border goes with it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from ..types import NEURONS, Neuron


class Theme(NamedTuple):
    """Colours as ``#rrggbb``, for one kind of background."""

    ground: str
    panel: str
    line: str
    text: str
    dim: str
    collision: str
    neurons: Mapping[str, str]
    states: Mapping[str, str]


LIGHT = Theme(
    ground="#ffffff",
    panel="#f5f6f8",
    line="#d5d9e0",
    text="#1a1d23",
    dim="#5d6572",
    collision="#c8102e",
    neurons={"lgmd1": "#084a9c", "lgmd2": "#c45bab", "lptc_r": "#b87400", "lptc_l": "#07806a"},
    states={"ok": "#0a7d63", "warming_up": "#8a93a1", "stale": "#6b5b95", "flash": "#d9a400", "turning": "#2f8fa3"},
)
DARK = Theme(
    ground="#0f1216",
    panel="#181c22",
    line="#333a45",
    text="#eceff3",
    dim="#9aa4b2",
    collision="#ff4a4a",
    neurons={"lgmd1": "#3f93e6", "lgmd2": "#f2b0e2", "lptc_r": "#eea824", "lptc_l": "#2cc79a"},
    states={"ok": "#36c79f", "warming_up": "#8b95a5", "stale": "#a08fd6", "flash": "#ffd84d", "turning": "#55bfd3"},
)

LABELS: Mapping[Neuron, str] = {"lgmd1": "LGMD-1", "lgmd2": "LGMD-2", "lptc_r": "LPTC-R", "lptc_l": "LPTC-L"}
MEANINGS: Mapping[Neuron, str] = {
    "lgmd1": "looming, bright or dark",
    "lgmd2": "looming, dark only",
    "lptc_r": "motion to the right",
    "lptc_l": "motion to the left",
}
STATE_LABELS: Mapping[str, str] = {
    "ok": "ok",
    "warming_up": "warming up",
    "stale": "stale",
    "flash": "flash",
    "turning": "turning",
}

EVENT_LABELS: Mapping[str, str] = {
    "AA": "avoided approach",
    "AT": "avoided passer-by",
    "AP": "avoided wall",
    "spurious": "avoided nothing",
    "CR": "hit robot",
    "CP": "hit wall",
}
"""What happens in the arena, in words; obstacles count as wall."""

RANGES: Mapping[Neuron, tuple[float, float]] = {
    "lgmd1": (0.5, 1.0),
    "lgmd2": (0.5, 1.0),
    "lptc_r": (0.0, 1.0),
    "lptc_l": (-1.0, 0.0),
}
"""Membrane potential of each neuron, bottom and top of its axis."""


def event_colours(theme: Theme) -> dict[str, str]:
    """Return the colour of each kind of event in the arena; both kinds of contact are red and differ in their mark."""
    n = theme.neurons
    avoided = {"AA": n["lptc_l"], "AT": n["lptc_r"], "AP": n["lgmd1"], "spurious": theme.dim}
    return {**avoided, "CR": theme.collision, "CP": theme.collision}


_PAPER_THRESHOLDS: Mapping[Neuron, float] = {"lgmd1": 0.7, "lgmd2": 0.7, "lptc_r": 0.2, "lptc_l": 0.2}


def thresholds(about: Mapping[str, Any]) -> dict[Neuron, float]:
    """Return the potential at which each neuron starts to spike, in its own sign; ``about`` is a run's header.

    A header without ``thresholds`` gets the paper's: 0.7 for the LGMDs, 0.2 and -0.2 for the LPTCs.
    """
    given = {**_PAPER_THRESHOLDS, **about.get("thresholds", {})}
    return {n: -abs(given[n]) if n == "lptc_l" else float(given[n]) for n in NEURONS}
