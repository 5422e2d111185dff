"""How rates settle while the time goes on; needs the extra ``plot``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from .axes import new_figure, plain
from .palette import LIGHT
from .series_colors import series_color

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Course(NamedTuple):
    """A rate in percent up to each time, and the one it is compared with (None: there is none)."""

    times_min: Sequence[float]
    rates: Sequence[float]
    other: float | None = None


def plot_elapsed(panels: Mapping[tuple[str, str], Mapping[str, Course]], *, other: str, title: str = "") -> Figure:
    """Return a figure with a panel for each row and column: every series' rate against the time elapsed.

    What it is compared with, ``other`` in words, is a broken line in the same colour.

    Raises
    ------
    MissingExtraError : matplotlib is not installed
    """
    rows, columns = (list(dict.fromkeys(key[axis] for key in panels)) for axis in (0, 1))
    figure = new_figure(4.6 * len(columns), 2.5 * len(rows) + 0.8)
    grid = figure.subplots(len(rows), len(columns), sharex=True, sharey="row", squeeze=False)
    for (row, column), courses in panels.items():
        axes = grid[rows.index(row), columns.index(column)]
        for number, (name, course) in enumerate(courses.items()):
            color = series_color(number)
            axes.plot(course.times_min, course.rates, color=color, linewidth=max(3.4 - 0.9 * number, 1.2), label=name)
            if course.other is not None:
                axes.axhline(course.other, color=color, linewidth=0.9, linestyle=(0, (4, 3)))
        plain(axes, "y")
        if row == rows[0]:
            axes.set_title(column, fontsize=10.5, color=LIGHT.text)
        if row == rows[-1]:
            axes.set_xlabel("min", color=LIGHT.text, fontsize=9)
        if column == columns[0]:
            axes.set_ylabel(f"{row}, %", color=LIGHT.text, fontsize=9)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    broken = grid[0, 0].plot([], [], color=LIGHT.dim, linewidth=0.9, linestyle=(0, (4, 3)))
    figure.legend([*handles, *broken], [*labels, other], loc="outside lower left", ncols=len(labels) + 1,
                  frameon=False, fontsize=8.5, labelcolor=LIGHT.text)  # fmt: skip
    if title:
        figure.suptitle(title, x=0.012, ha="left", fontsize=9, color=LIGHT.dim)
    return figure
