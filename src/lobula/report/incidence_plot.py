"""Contacts by the angle they came from and the state of the LPTCs; needs the extra ``plot``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .axes import new_figure, plain
from .palette import LIGHT

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Bars(NamedTuple):
    """Numbers between neighbouring ``edges_deg`` (N + 1,), apart by the LPTCs' state; (N,) each."""

    edges_deg: NDArray[np.float64]
    active: NDArray[Any]
    quiet: NDArray[Any]
    unknown: NDArray[Any]


def plot_incidence(panels: Mapping[tuple[str, str], Bars], *, what: str, title: str = "") -> Figure:
    """Return a figure with a panel for each row and column: ``what`` against the angle of incidence, 0 is head-on.

    Raises
    ------
    MissingExtraError : matplotlib is not installed
    """
    rows, columns = (list(dict.fromkeys(key[axis] for key in panels)) for axis in (0, 1))
    figure = new_figure(3.3 * len(columns), 2.2 * len(rows) + 0.8)
    grid = figure.subplots(len(rows), len(columns), sharex=True, sharey="row", squeeze=False)
    kinds = (
        ("an LPTC above its threshold", "active", LIGHT.neurons["lptc_r"]),
        ("both below", "quiet", LIGHT.line),
        ("not known", "unknown", LIGHT.panel),
    )
    for (row, column), bars in panels.items():
        axes = grid[rows.index(row), columns.index(column)]
        edges, floor = bars.edges_deg, np.zeros(len(bars.edges_deg) - 1)
        for label, name, color in kinds:
            heights = getattr(bars, name)
            axes.bar(
                edges[:-1], heights, np.diff(edges) * 0.92, bottom=floor, align="edge", color=color,
                edgecolor=LIGHT.dim, linewidth=0.5, label=label,
            )  # fmt: skip
            floor = floor + heights
        plain(axes, "y")
        axes.yaxis.get_major_locator().set_params(integer=True)
        axes.set_xticks(edges, [f"{edge:g}" for edge in edges])
        if row == rows[0]:
            axes.set_title(column, fontsize=10, color=LIGHT.text)
        if row == rows[-1]:
            axes.set_xlabel("incidence, deg", color=LIGHT.text, fontsize=9)
        if column == columns[0]:
            axes.set_ylabel(f"{what}\n{row}", color=LIGHT.text, fontsize=9)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower left", ncols=len(labels), frameon=False, fontsize=8.5,
                  labelcolor=LIGHT.text)  # fmt: skip
    if title:
        figure.suptitle(title, x=0.012, ha="left", fontsize=9, color=LIGHT.dim)
    return figure
