"""Box plots of spike counts, a panel for each course and speed; needs the extra ``plot``."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..errors import ParameterError
from ..types import NEURONS, Neuron
from .axes import new_figure, plain
from .palette import LABELS, LIGHT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Counts = Mapping[tuple[Neuron, str], Sequence[int]]
"""Spikes in every repeat, by neuron and group."""

_TICKS = (0, 1, 3, 10, 30, 100, 300, 1000, 3000)


def plot_boxes(
    panels: Mapping[tuple[str, str], Counts],
    *,
    rows: Mapping[str, str],
    columns: Mapping[str, str],
    groups: Mapping[str, str],
    title: str = "",
) -> Figure:
    """Return a figure with a panel for each row and column, and in it a box for each neuron and group.

    A box holds the middle half of the repeats, its line is the median, whiskers reach to the extremes; every repeat is
    a dot. The axis is linear up to 1 and logarithmic above. ``rows``, ``columns`` and ``groups`` give the order and the
    text of their keys; the second group is drawn hollow.

    Raises
    ------
    MissingExtraError : matplotlib is not installed
    ParameterError : no panel
    """
    if not panels:
        raise ParameterError("plot_boxes: no panels: must have at least one")
    figure = new_figure(2.9 * len(columns) + 0.9, 2.25 * len(rows) + 0.7)
    grid = figure.subplots(len(rows), len(columns), sharex=True, sharey=True, squeeze=False)
    top = max((max(counts, default=0) for panel in panels.values() for counts in panel.values()), default=0)
    for i, (row, row_text) in enumerate(rows.items()):
        for j, (column, column_text) in enumerate(columns.items()):
            axes = grid[i, j]
            _draw_panel(axes, panels[row, column], list(groups))
            count_axis(axes, top)
            if i == 0:
                axes.set_title(column_text, fontsize=10.5, color=LIGHT.text)
            if j == 0:
                axes.set_ylabel(row_text, color=LIGHT.text, fontsize=9)
    _draw_legend(figure, groups)
    if title:
        figure.suptitle(title, x=0.012, ha="left", fontsize=9, color=LIGHT.dim)
    return figure


def count_axis(axes: Axes, top: float) -> None:
    """Make the y axis of ``axes`` one of counts up to ``top``: linear to 1, then logarithmic."""
    axes.set_yscale("symlog", linthresh=1, linscale=0.45)
    ticks = [tick for tick in _TICKS if tick <= 1.5 * max(top, 2)]
    axes.set_yticks(ticks, [f"{tick}" for tick in ticks])
    axes.set_yticks([], minor=True)
    axes.set_ylim(-0.3, 1.6 * max(top, 2))
    plain(axes, "y")


def _draw_panel(axes: Axes, counts: Counts, groups: Sequence[str]) -> None:
    width = 0.8 / len(groups)
    for place, neuron in enumerate(NEURONS):
        color = LIGHT.neurons[neuron]
        for number, group in enumerate(groups):
            values = np.asarray(counts.get((neuron, group), ()), np.float64)
            if not values.size:
                continue
            x = place + (number - (len(groups) - 1) / 2) * width
            box = {"facecolor": LIGHT.ground if number else color, "edgecolor": color, "alpha": 0.9 if number else 0.45}
            axes.boxplot(
                values, positions=[x], widths=0.72 * width, whis=(0, 100), patch_artist=True, showcaps=False,
                boxprops=box, medianprops={"color": color, "linewidth": 2.0},
                whiskerprops={"color": color, "linewidth": 1.0},
            )  # fmt: skip
            spread = np.linspace(-0.2, 0.2, len(values)) * width if len(values) > 1 else np.zeros(1)
            axes.plot(x + spread, values, ".", color=color, markersize=2.6, zorder=3)
    axes.set_xlim(-0.6, len(NEURONS) - 0.4)
    axes.set_xticks(range(len(NEURONS)), [LABELS[n] for n in NEURONS])


def _draw_legend(figure: Figure, groups: Mapping[str, str]) -> None:
    patch = importlib.import_module("matplotlib.patches").Patch
    marks = [
        patch(
            facecolor=LIGHT.ground if number else LIGHT.dim, edgecolor=LIGHT.dim, alpha=0.9 if number else 0.55,
            label=text,
        )
        for number, text in enumerate(groups.values())
    ]  # fmt: skip
    figure.legend(handles=marks, loc="outside lower left", ncols=len(marks), frameon=False, fontsize=8.5,
                  labelcolor=LIGHT.text)  # fmt: skip
