"""Rates with their intervals, side by side with someone else's; needs the extra ``plot``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from .axes import new_figure, plain
from .palette import LIGHT
from .series_colors import series_color, series_marker

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


class Rate(NamedTuple):
    """A rate in percent, its interval, and the one it is compared with (None: there is none)."""

    value: float
    low: float
    high: float
    other: float | None = None


Panel = Mapping[tuple[str, str], Rate]
"""Rates by group and series."""


def plot_rates(
    panels: Mapping[str, Panel], *, groups: Sequence[str], series: Sequence[str], other: str, title: str = ""
) -> Figure:
    """Return a figure with one panel beside the other: a mark with its interval for each group and series.

    What it is compared with, ``other`` in words, is a hollow mark to the left of it.

    Raises
    ------
    MissingExtraError : matplotlib is not installed
    """
    figure = new_figure(5.0 * len(panels), 3.7)
    grid = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for axes, (name, panel) in zip(grid, panels.items(), strict=True):
        _draw(axes, panel, groups, series)
        plain(axes, "y")
        axes.set_title(name, fontsize=10.5, color=LIGHT.text)
    grid[0].set_ylabel("%", color=LIGHT.text, fontsize=9)
    handles, labels = grid[0].get_legend_handles_labels()
    hollow = grid[0].plot([], [], "o", mfc=LIGHT.ground, mec=LIGHT.dim, markersize=5)
    figure.legend([*handles, *hollow], [*labels, other], loc="outside lower left", ncols=len(series) + 1,
                  frameon=False, fontsize=8.5, labelcolor=LIGHT.text)  # fmt: skip
    if title:
        figure.suptitle(title, x=0.012, ha="left", fontsize=9, color=LIGHT.dim)
    return figure


def _draw(axes: Axes, panel: Panel, groups: Sequence[str], series: Sequence[str]) -> None:
    width = 0.8 / max(len(series), 1)
    for number, name in enumerate(series):
        color, mark = series_color(number), series_marker(number)
        offset = (number - (len(series) - 1) / 2) * width
        places = [(place + offset, panel[group, name]) for place, group in enumerate(groups) if (group, name) in panel]
        known = [(x, rate) for x, rate in places if rate.value == rate.value]
        axes.errorbar(
            [x for x, _ in known], [r.value for _, r in known],
            yerr=[[r.value - r.low for _, r in known], [r.high - r.value for _, r in known]],
            fmt=mark, color=color, markersize=6, capsize=3, linewidth=1.2, label=name,
        )  # fmt: skip
        theirs = [(x - 0.22 * width, r.other) for x, r in places if r.other is not None]
        axes.plot([x for x, _ in theirs], [y for _, y in theirs], mark, mfc=LIGHT.ground, mec=color, markersize=5)
    axes.set_xticks(range(len(groups)), groups)
    axes.set_xlim(-0.5, len(groups) - 0.5)
