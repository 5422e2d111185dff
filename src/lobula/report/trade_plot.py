"""What is paid against what is gained: series of points in a plane, with intervals; needs the extra ``plot``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ..intervals import Interval
from .axes import new_figure, plain
from .palette import LIGHT
from .series_colors import series_color, series_marker

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


class Point(NamedTuple):
    """One point, its intervals, and a word beside it (may be empty)."""

    x: float
    y: float
    x_interval: Interval
    y_interval: Interval
    label: str = ""


def plot_trade(
    panels: Mapping[str, Mapping[str, Sequence[Point]]], *, x: str, y: str, lines: bool = True, title: str = ""
) -> Figure:
    """Return a figure with one panel beside the other: the points of each series, joined in their order.

    ``x`` and ``y`` tell in words what is drawn along the axes. The axes begin at 0 and are linear.

    Raises
    ------
    MissingExtraError : matplotlib is not installed
    """
    figure = new_figure(5.4 * len(panels), 4.9)
    grid = figure.subplots(1, len(panels), squeeze=False)[0]
    series = list(dict.fromkeys(name for panel in panels.values() for name in panel))
    for axes, (name, panel) in zip(grid, panels.items(), strict=True):
        for each, points in panel.items():
            _draw(axes, points, each, series.index(each), lines)
        plain(axes, "y")
        axes.grid(visible=True, axis="x", color=LIGHT.line, linewidth=0.6)
        axes.set_title(name, fontsize=10.5, color=LIGHT.text)
        axes.set_xlabel(x, color=LIGHT.text, fontsize=9)
        axes.set_xlim(left=0)
        axes.set_ylim(bottom=0)
    grid[0].set_ylabel(y, color=LIGHT.text, fontsize=9)
    handles = dict(pair for axes in grid for pair in zip(*axes.get_legend_handles_labels()[::-1], strict=True))
    figure.legend(handles.values(), handles.keys(), loc="outside lower left", ncols=min(len(handles), 3 * len(panels)),
                  frameon=False, fontsize=8.5, labelcolor=LIGHT.text)  # fmt: skip
    if title:
        figure.suptitle(title, x=0.012, ha="left", fontsize=9, color=LIGHT.dim)
    return figure


def _draw(axes: Axes, points: Sequence[Point], name: str, number: int, lines: bool) -> None:
    color = series_color(number)
    xs, ys = [p.x for p in points], [p.y for p in points]
    axes.errorbar(
        xs, ys,
        xerr=[[p.x - p.x_interval[0] for p in points], [p.x_interval[1] - p.x for p in points]],
        yerr=[[p.y - p.y_interval[0] for p in points], [p.y_interval[1] - p.y for p in points]],
        fmt="none", ecolor=color, elinewidth=0.7, alpha=0.55,
    )  # fmt: skip
    style = f"{series_marker(number)}{'-' if lines else ''}"
    axes.plot(xs, ys, style, color=color, markersize=5, linewidth=0.8, label=name, clip_on=False)
    for p in points:
        if p.label:
            axes.annotate(p.label, (p.x, p.y), xytext=(5, 4), textcoords="offset points", fontsize=7, color=LIGHT.dim)
