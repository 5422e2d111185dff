"""What a search tried and the front of it, on what it was searched on and on what was held out; needs ``plot``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ..intervals import Interval
from .axes import new_figure, plain
from .palette import LIGHT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MARGIN = 0.03
"""Of the range, below 0."""

_STYLES: dict[str, dict[str, Any]] = {
    "trials": {"marker": "o", "color": LIGHT.dim, "alpha": 0.45, "markersize": 4.0, "zorder": 1},
    "front": {"marker": "s", "color": LIGHT.neurons["lgmd1"], "markersize": 5.0, "zorder": 2},
    "preset": {"marker": "D", "color": LIGHT.neurons["lptc_l"], "markersize": 7.0, "zorder": 3},
    "best": {"marker": "^", "color": LIGHT.neurons["lptc_r"], "markersize": 7.0, "zorder": 4},
}


class Mark(NamedTuple):
    """A point: its numbers by name, the intervals of those that have one, and a word beside it (may be empty)."""

    numbers: Mapping[str, float]
    intervals: Mapping[str, Interval]
    label: str = ""


class Series(NamedTuple):
    """Points of one ``kind`` (trials, front, preset or best) and what they are called."""

    kind: str
    name: str
    marks: Sequence[Mark]


def plot_front(
    panels: Mapping[str, Sequence[Series]], views: Sequence[tuple[str, str]], words: Mapping[str, str], title: str = ""
) -> Figure:
    """Return a figure with a column for each panel and a row for each view: two numbers, to the right and upwards.

    ``words`` are those of the numbers. The panels of a row share their axes, which begin just below 0.

    Raises
    ------
    MissingExtraError : matplotlib is not installed
    """
    figure = new_figure(5.4 * len(panels), 0.9 + 3.5 * len(views))
    grid = figure.subplots(len(views), len(panels), squeeze=False, sharex=True, sharey="row")
    for place, (row, (x, y)) in enumerate(zip(grid, views, strict=True)):
        for axes, (name, series) in zip(row, panels.items(), strict=True):
            plain(axes, "y")
            axes.grid(visible=True, axis="x", color=LIGHT.line, linewidth=0.6)
            for one in filter(lambda one: one.marks, series):  # the layout cannot measure an empty one
                _draw(axes, one, x, y)
            _label(axes, series, x, y)
            axes.set_title(name if place == 0 else "", fontsize=10.5, color=LIGHT.text)
            axes.set_xlabel(words[x] if place == len(views) - 1 else "", color=LIGHT.text, fontsize=9)
        row[0].set_xlim(left=-MARGIN * row[0].get_xlim()[1])  # intervals at 0 are to be seen
        row[0].set_ylim(bottom=-MARGIN * row[0].get_ylim()[1])
        row[0].set_ylabel(words[y], color=LIGHT.text, fontsize=9)
    handles = dict(pair for axes in grid[0] for pair in zip(*axes.get_legend_handles_labels()[::-1], strict=True))
    figure.legend(handles.values(), handles.keys(), loc="outside lower left", ncols=len(handles),
                  frameon=False, fontsize=8.5, labelcolor=LIGHT.text)  # fmt: skip
    if title:
        figure.suptitle(title, x=0.012, ha="left", fontsize=9, color=LIGHT.dim)
    return figure


def _draw(axes: Axes, series: Series, x: str, y: str) -> None:
    style = _STYLES[series.kind]
    axes.plot(
        [mark.numbers[x] for mark in series.marks], [mark.numbers[y] for mark in series.marks],
        linestyle="none", label=series.name, clip_on=False, **style,
    )  # fmt: skip
    for mark in series.marks:
        if mark.intervals:
            ends = {name: mark.intervals.get(name, (mark.numbers[name],) * 2) for name in (x, y)}
            (left, right), (low, high) = ends[x], ends[y]
            axes.plot([left, right], [mark.numbers[y]] * 2, color=style["color"], linewidth=0.8, alpha=0.7)
            axes.plot([mark.numbers[x]] * 2, [low, high], color=style["color"], linewidth=0.8, alpha=0.7)


def _label(axes: Axes, series: Sequence[Series], x: str, y: str) -> None:
    """Write the words beside the points, those of points that lie together behind one another."""
    there: dict[tuple[float, float], list[str]] = {}
    for mark in (mark for one in series for mark in one.marks if mark.label):
        there.setdefault((round(mark.numbers[x], 3), round(mark.numbers[y], 3)), []).append(mark.label)
    for place, labels in there.items():
        axes.annotate(", ".join(labels), place, xytext=(5, 4), textcoords="offset points", fontsize=7, color=LIGHT.dim)
