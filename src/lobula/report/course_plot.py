"""What was seen on several courses and the potentials it called forth, a column for each; needs the extra ``plot``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from ..types import Neuron
from .axes import new_figure, plain
from .palette import LABELS, LIGHT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ROWS: tuple[tuple[tuple[Neuron, ...], tuple[float, float]], ...] = (
    (("lgmd1",), (0.48, 1.02)),
    (("lgmd2",), (0.48, 1.02)),
    (("lptc_r", "lptc_l"), (-1.08, 1.08)),
)
"""Neurons of each row of potentials, and its range."""


class CourseColumn(NamedTuple):
    """One course: ``images`` (T, H, W) as first seen, traces of (T,) for every repeat, and when something moved.

    The pictures taken at ``shown_s`` stand on top.
    """

    title: str
    images: NDArray[np.uint8]
    traces: Sequence[NDArray[Any]]
    moving_s: tuple[float, float]
    shown_s: Sequence[float]


def plot_courses(columns: Sequence[CourseColumn], thresholds: Mapping[Neuron, float], title: str = "") -> Figure:
    """Return a figure: pictures on top, then LGMD-1, LGMD-2 and both LPTCs over time, thresholds dashed.

    The first trace of a column is drawn strong, the others faint; the time of motion is shaded.

    Raises
    ------
    MissingExtraError : matplotlib is not installed
    ParameterError : no column, or one without a trace
    """
    if not columns or not all(column.traces for column in columns):
        raise ParameterError("plot_courses: a course without a trace: must have at least one")
    figure = new_figure(3.1 * len(columns) + 0.9, 6.9)
    grid = figure.add_gridspec(len(ROWS) + 1, len(columns), height_ratios=[1.0, 1.35, 1.35, 1.6])
    for place, column in enumerate(columns):
        _draw_pictures(figure.add_subplot(grid[0, place]), column)
        first: Axes | None = None
        for row, (neurons, (low, high)) in enumerate(ROWS, start=1):
            axes = figure.add_subplot(grid[row, place], sharex=first)
            first = first or axes
            _draw_potentials(axes, column, neurons, thresholds)
            axes.set_ylim(low, high)
            axes.set_xlim(0, column.traces[0]["time_s"][-1])
            if row == 1:
                axes.plot(column.shown_s, [high - 0.015] * len(column.shown_s), "v", markersize=4, color=LIGHT.dim,
                          markeredgewidth=0)  # fmt: skip
            _label(axes, neurons, first_column=place == 0, last_row=row == len(ROWS))
    figure.align_ylabels()
    if title:
        figure.suptitle(title, x=0.012, ha="left", fontsize=9, color=LIGHT.dim)
    return figure


def _draw_pictures(axes: Axes, column: CourseColumn) -> None:
    """Draw the pictures side by side, each with its time."""
    times_s = column.traces[0]["time_s"]
    height, width = column.images.shape[1:]
    step = 1.08 * width
    for place, time_s in enumerate(column.shown_s):
        number = int(np.abs(times_s - time_s).argmin())
        left = place * step
        axes.imshow(
            column.images[number], cmap="gray", vmin=0, vmax=255, interpolation="nearest",
            extent=(left, left + width, 0, height),
        )  # fmt: skip
        axes.text(left + width / 2, -0.08 * height, f"{times_s[number]:.2f} s", ha="center", va="top", fontsize=7.5,
                  color=LIGHT.dim)  # fmt: skip
    axes.set_xlim(-0.02 * width, (len(column.shown_s) - 1) * step + 1.02 * width)
    axes.set_ylim(-0.3 * height, 1.02 * height)
    axes.set_aspect("equal")
    axes.axis("off")
    axes.set_title(column.title, fontsize=10.5, color=LIGHT.text)


def _draw_potentials(
    axes: Axes, column: CourseColumn, neurons: Sequence[Neuron], thresholds: Mapping[Neuron, float]
) -> None:
    axes.axvspan(*column.moving_s, color=LIGHT.panel, zorder=0)
    for neuron in neurons:
        axes.axhline(thresholds[neuron], color=LIGHT.dim, linewidth=0.9, linestyle=(0, (5, 3)), zorder=1)
        for number, trace in reversed(list(enumerate(column.traces))):
            axes.plot(
                trace["time_s"], trace[neuron], color=LIGHT.neurons[neuron], zorder=3 - bool(number),
                linewidth=0.6 if number else 1.7, alpha=0.35 if number else 1.0,
            )  # fmt: skip
    plain(axes)


def _label(axes: Axes, neurons: Sequence[Neuron], *, first_column: bool, last_row: bool) -> None:
    """Name the axes where they stand at the edge of the figure, each neuron in its own colour."""
    axes.tick_params(labelleft=first_column, labelbottom=last_row)
    if last_row:
        axes.set_xlabel("time (s)", color=LIGHT.text, fontsize=9)
    if first_column:
        axes.set_ylabel("potential", color=LIGHT.text, fontsize=9)
        for neuron, (x, y, va) in zip(neurons, ((0.03, 0.95, "top"), (0.03, 0.05, "bottom")), strict=False):
            axes.text(x, y, LABELS[neuron], transform=axes.transAxes, va=va, fontsize=9.5, fontweight="bold",
                      color=LIGHT.neurons[neuron])  # fmt: skip
