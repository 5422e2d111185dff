"""Empty figures in the house's look; needs the extra ``plot``, opens no window."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Literal

from ..errors import MissingExtraError, pip_install
from .palette import LIGHT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def new_figure(width_in: float, height_in: float) -> Figure:
    """Return an empty figure.

    Raises
    ------
    MissingExtraError : matplotlib is not installed
    """
    try:
        module = importlib.import_module("matplotlib.figure")
    except ImportError as error:
        raise MissingExtraError(f"plots need matplotlib: {pip_install('plot')}") from error
    figure: Figure = module.Figure(figsize=(width_in, height_in), layout="constrained")  # no pyplot: no window
    return figure


def plain(axes: Axes, grid: Literal["x", "y"] = "x") -> None:
    """Give ``axes`` two thin spines, small ticks and a faint grid across ``grid``."""
    axes.set_facecolor(LIGHT.ground)
    axes.grid(visible=True, axis=grid, color=LIGHT.line, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(colors=LIGHT.dim, labelsize=8, length=3)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(LIGHT.line)
