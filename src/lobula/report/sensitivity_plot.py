"""Rates against a setting, setting by setting; needs the extra ``plot``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from .axes import new_figure, plain
from .palette import LIGHT
from .rate_plot import Rate
from .series_colors import series_color, series_marker

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Lines = Mapping[str, Mapping[str, Rate]]
"""Rates by series and by the setting's value in words, in their order."""


def plot_sensitivity(panels: Mapping[tuple[str, str], Lines], *, title: str = "") -> Figure:
    """Return a figure with a row for each rate and a column for each setting: marks with intervals, joined by lines.

    Raises
    ------
    MissingExtraError : matplotlib is not installed
    """
    rows, columns = (list(dict.fromkeys(key[axis] for key in panels)) for axis in (0, 1))
    figure = new_figure(2.7 * len(columns) + 0.6, 2.3 * len(rows) + 0.8)
    grid = figure.subplots(len(rows), len(columns), sharey="row", sharex="col", squeeze=False)
    for (row, column), lines in panels.items():
        axes = grid[rows.index(row), columns.index(column)]
        for number, (name, rates) in enumerate(lines.items()):
            shift = 0.08 * (number - (len(lines) - 1) / 2)
            known = [(place + shift, r) for place, r in enumerate(rates.values()) if r.value == r.value]
            axes.errorbar(
                [x for x, _ in known], [r.value for _, r in known],
                yerr=[[r.value - r.low for _, r in known], [r.high - r.value for _, r in known]],
                fmt=f"{series_marker(number)}-", color=series_color(number), markersize=4, linewidth=1.0, capsize=2,
                label=name,
            )  # fmt: skip
        values = list(next(iter(lines.values())))
        axes.set_xticks(range(len(values)), values)
        plain(axes, "y")
        if row == rows[-1]:
            axes.set_xlabel(column, color=LIGHT.text, fontsize=9)
        if column == columns[0]:
            axes.set_ylabel(f"{row}, %", color=LIGHT.text, fontsize=9)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower left", ncols=len(labels), frameon=False, fontsize=8.5,
                  labelcolor=LIGHT.text)  # fmt: skip
    if title:
        figure.suptitle(title, x=0.012, ha="left", fontsize=9, color=LIGHT.dim)
    return figure
