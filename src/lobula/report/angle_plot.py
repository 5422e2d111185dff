"""Spike counts against the angle an object comes from, and a plan of how it comes; needs the extra ``plot``."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from ..types import NEURONS
from .axes import new_figure
from .count_plot import Counts, count_axis
from .palette import LABELS, LIGHT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MARKS = {"lgmd1": "o", "lgmd2": "s", "lptc_r": ">", "lptc_l": "<"}


class GroundPlan(NamedTuple):
    """The set-up from above, seen from the lens: cm ahead and to the right.

    ``lines`` (A, 2, 2) are the start and the end of the centre of what moves, ``radius_cm`` its size and that of the
    robot that looks, whose centre lies ``behind_cm`` behind the lens.
    """

    lines: NDArray[np.float64]
    radius_cm: float
    behind_cm: float
    view_deg: float


class AnglePanel(NamedTuple):
    """One speed: ``counts[angle_deg]`` holds the spikes of every repeat by neuron; the group is not looked at."""

    title: str
    counts: Mapping[float, Counts]


def plot_angles(ground: GroundPlan, rows: Sequence[Sequence[AnglePanel]], ylabel: str, title: str = "") -> Figure:
    """Return a figure: the ground plan on the left, a panel for each speed on the right.

    Marks are medians over the repeats, bars the middle half of them, faint lines the extremes.

    Raises
    ------
    MissingExtraError : matplotlib is not installed
    ParameterError : no panel
    """
    if not rows or not all(rows):
        raise ParameterError("plot_angles: no panels: must have at least one in each row")
    columns = max(map(len, rows))
    figure = new_figure(3.1 * columns + 3.6, 2.75 * len(rows) + 0.4)
    grid = figure.add_gridspec(len(rows), columns + 1, width_ratios=[1.05, *[1.0] * columns])
    _draw_plan(figure.add_subplot(grid[:, 0]), ground)
    top = max(
        (max(c, default=0) for row in rows for p in row for by in p.counts.values() for c in by.values()), default=0
    )
    first: Axes | None = None
    for i, row in enumerate(rows):
        for j, panel in enumerate(row):
            axes = figure.add_subplot(grid[i, j + 1], sharex=first, sharey=first)
            first = first or axes
            _draw_panel(axes, panel)
            count_axis(axes, top)
            axes.set_title(panel.title, fontsize=10, color=LIGHT.text)
            axes.tick_params(labelleft=j == 0, labelbottom=i == len(rows) - 1)
            if j == 0:
                axes.set_ylabel(ylabel, color=LIGHT.text, fontsize=9)
            if i == len(rows) - 1:
                axes.set_xlabel("comes from (deg)", color=LIGHT.text, fontsize=9)
    marks = _legend_marks()
    figure.legend(handles=marks, loc="outside lower right", ncols=len(marks), frameon=False, fontsize=9,
                  labelcolor=LIGHT.text)  # fmt: skip
    if title:
        figure.suptitle(title, x=0.012, ha="left", fontsize=9, color=LIGHT.dim)
    return figure


def _draw_panel(axes: Axes, panel: AnglePanel) -> None:
    angles = np.array(sorted(panel.counts))
    step = float(np.diff(angles).min()) if len(angles) > 1 else 1.0
    for place, neuron in enumerate(NEURONS):
        by_angle = [np.concatenate([v for (n, _), v in panel.counts[a].items() if n == neuron]) for a in angles]
        low, lower, middle, upper, high = np.array([np.quantile(v, (0, 0.25, 0.5, 0.75, 1)) for v in by_angle]).T
        x = angles + (place - 1.5) * 0.13 * step
        color = LIGHT.neurons[neuron]
        axes.plot(x, middle, color=color, linewidth=1.2, zorder=2)
        axes.vlines(x, low, high, color=color, linewidth=0.7, alpha=0.5, zorder=2)
        axes.vlines(x, lower, upper, color=color, linewidth=2.6, zorder=3)
        axes.plot(x, middle, _MARKS[neuron], color=color, markersize=4.5, markeredgecolor=LIGHT.ground,
                  markeredgewidth=0.5, zorder=4)  # fmt: skip
    axes.set_xticks(angles, [f"{angle:+g}" if angle else "0" for angle in angles])
    axes.tick_params(axis="x", labelsize=7)


def _legend_marks() -> list[Any]:
    line = importlib.import_module("matplotlib.lines").Line2D
    return [
        line([], [], color=LIGHT.neurons[n], marker=_MARKS[n], markersize=5, linewidth=1.2, label=LABELS[n])
        for n in NEURONS
    ]


def _draw_plan(axes: Axes, ground: GroundPlan) -> None:
    """Draw the looking robot at the bottom, its view as a wedge, and every line with the robot at its end."""
    patches = importlib.import_module("matplotlib.patches")
    reach = float(np.abs(ground.lines).max())
    half_deg = ground.view_deg / 2
    look = {"color": LIGHT.states["flash"], "alpha": 0.16, "linewidth": 0}
    axes.add_patch(patches.Wedge((0, 0), 1.08 * reach, 90 - half_deg, 90 + half_deg, **look))
    for start, end in ground.lines[:, :, ::-1]:  # drawn with right as x and ahead as y
        along = (end - start) / np.hypot(*(end - start))
        arrow = {"arrowstyle": "-|>", "color": LIGHT.dim, "linewidth": 0.9, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", end - ground.radius_cm * along, start, arrowprops=arrow)
        axes.add_patch(patches.Circle(end, ground.radius_cm, facecolor="none", edgecolor=LIGHT.dim, linewidth=0.7))
        angle = np.degrees(np.arctan2(start[0] - end[0], start[1] - end[1]))
        x, y = start - 0.1 * reach * along
        axes.text(x, y, f"{angle:+.0f}" if round(angle) else "0", ha="center", va="center",
                  fontsize=8, color=LIGHT.text)  # fmt: skip
    axes.add_patch(patches.Circle((0, -ground.behind_cm), ground.radius_cm, color=LIGHT.text))
    axes.plot(0, 0, "o", color=LIGHT.collision, markersize=3.5)
    axes.set_xlim(-1.18 * reach, 1.18 * reach)
    axes.set_ylim(-ground.behind_cm - 1.4 * ground.radius_cm, 1.16 * reach)
    axes.set_aspect("equal")
    axes.axis("off")
    axes.set_title("set-up from above", fontsize=10, color=LIGHT.text)
