"""Pictures of a trace for papers and pages; needs the extra ``plot``, opens no window."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from ..landing import whole_file
from ..types import NEURONS, Frame, Neuron
from .axes import new_figure, plain
from .palette import LABELS, LIGHT, STATE_LABELS, thresholds
from .spans import Span, collision_spans, state_spans, thinned

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FIGURE_SUFFIXES = (".png", ".svg", ".pdf")

_LGMDS: tuple[Neuron, ...] = ("lgmd1", "lgmd2")
_LPTCS: tuple[Neuron, ...] = ("lptc_r", "lptc_l")


class Scene(NamedTuple):
    """One movie and what the network made of it: a column of ``plot_scenes``."""

    title: str
    frames: Sequence[Frame]
    trace: NDArray[np.void]


def plot_trace(trace: NDArray[np.void], about: Mapping[str, Any] | None = None) -> Figure:
    """Return a figure of the four potentials, their thresholds and spikes, the collisions and the states over time.

    Parameters
    ----------
    trace : (n,) TRACE_DTYPE, n >= 1
    about : the run's header, or what ``read_about`` gives; names the source and holds the thresholds

    Raises
    ------
    MissingExtraError : matplotlib is not installed
    ParameterError : a trace without rows
    """
    about = about or {}
    figure = new_figure(10.0, 6.2)
    column = figure.subplots(4, 1, sharex=True, height_ratios=[3, 3, 1.5, 0.55])
    _draw_column(column, _require_rows(trace, "plot_trace"), about)
    _draw_legends(column, [trace])
    figure.align_ylabels(column)
    figure.suptitle(_title(about), x=0.012, ha="left", fontsize=11, color=LIGHT.text)
    return figure


def plot_demo(frames: Sequence[Frame], trace: NDArray[np.void], title: str = "") -> Figure:
    """Return a figure with some of the ``frames`` on top, the moment of decision marked, and their trace below.

    Raises as ``plot_trace``.
    """
    return plot_scenes([Scene(title, frames, trace)])


def plot_scenes(scenes: Sequence[Scene], about: Mapping[str, Any] | None = None) -> Figure:
    """Return a figure with one column for each scene: its frames on top, its trace below. Raises as ``plot_trace``."""
    pictures = 6 if len(scenes) == 1 else 3
    figure = new_figure(max(10.0, 4.6 * len(scenes)), 7.2)
    grid = figure.add_gridspec(5, len(scenes), height_ratios=[2.6 if len(scenes) == 1 else 2.0, 3, 3, 1.5, 0.55])
    for number, scene in enumerate(scenes):
        trace = _require_rows(scene.trace, scene.title or "plot_demo")
        first = figure.add_subplot(grid[1, number])
        column = [first, *(figure.add_subplot(grid[row, number], sharex=first) for row in (2, 3, 4))]
        _draw_column(column, trace, about or {}, names=number == 0)
        _draw_pictures(figure.add_subplot(grid[0, number]), scene, trace, pictures)
        if number == len(scenes) - 1:
            _draw_legends(column, [one.trace for one in scenes])
    return figure


def save_figure(figure: Figure, path: str | Path) -> Path:
    """Write ``figure`` as png, svg or pdf, by the suffix of ``path``, whole or not at all.

    Raises
    ------
    ParameterError : another suffix
    OutputError : the file cannot be written
    """
    path = Path(path)
    kind = path.suffix.lower()
    if kind not in FIGURE_SUFFIXES:
        raise ParameterError(f"figure {path}: must end in {', '.join(FIGURE_SUFFIXES)}")
    dateless = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}.get(kind)  # same figure, same bytes
    salt = importlib.import_module("matplotlib").rc_context({"svg.hashsalt": "lobula"})
    with whole_file(path) as temporary, salt:
        figure.savefig(temporary, format=kind[1:], dpi=160, facecolor=LIGHT.ground, metadata=dateless)
    return path


def _require_rows(trace: NDArray[np.void], where: str) -> NDArray[np.void]:
    if len(trace) == 0:
        raise ParameterError(f"{where}: the trace has no rows: nothing to draw")
    return trace


def _draw_column(
    column: Sequence[Axes], trace: NDArray[np.void], about: Mapping[str, Any], *, names: bool = True
) -> None:
    """Draw a trace into four axes that share their time: LGMDs, LPTCs, spikes, states."""
    lgmds, lptcs, spikes, states = column
    levels = thresholds(about)
    for axes, neurons, (low, high) in ((lgmds, _LGMDS, (0.48, 1.02)), (lptcs, _LPTCS, (-1.05, 1.05))):
        for neuron in neurons:
            time_s, potential = thinned(trace["time_s"], trace[neuron])
            style = (0, (3, 2)) if neuron == "lgmd2" else "-"  # both LGMDs are seen where they are the same
            axes.plot(
                time_s, potential, color=LIGHT.neurons[neuron], linewidth=1.5, linestyle=style, label=LABELS[neuron]
            )
        for number, level in enumerate(sorted({levels[neuron] for neuron in neurons})):
            axes.axhline(
                level, color=LIGHT.dim, linewidth=0.9, linestyle=(0, (5, 3)), label="_" if number else "threshold"
            )
        axes.set_ylim(low, high)
    _draw_spikes(spikes, trace)
    _draw_states(states, trace)
    alarms = collision_spans(trace)
    for axes in column[:3]:
        low, high = axes.get_ylim()
        axes.broken_barh(
            [_bar(span) for span in alarms], (low, high - low), color=LIGHT.collision, alpha=0.14, linewidth=0, zorder=0
        )
        axes.vlines([span.start_s for span in alarms], low, high, color=LIGHT.collision, linewidth=1.0, zorder=1)
    for axes in column:
        plain(axes)
    start_s, end_s = float(trace["time_s"][0]), float(trace["time_s"][-1])
    lgmds.set_xlim(start_s, end_s if end_s > start_s else start_s + 1.0)
    states.set_xlabel("time (s)", color=LIGHT.text)
    for axes in column[:-1]:
        axes.tick_params(labelbottom=False)
    if names:
        for axes, name in zip(column, ("LGMD potential", "LPTC potential", "spikes"), strict=False):
            axes.set_ylabel(name, color=LIGHT.text)
    else:
        for axes in column[:3]:
            axes.tick_params(labelleft=False)


def _draw_spikes(axes: Axes, trace: NDArray[np.void]) -> None:
    """One row a neuron, one tick a frame, taller for more spikes."""
    for row, neuron in enumerate(reversed(NEURONS)):
        time_s, counts = thinned(trace["time_s"], trace[f"spikes_{neuron}"])
        seen = counts > 0
        height = np.minimum(0.3 * np.log2(1.0 + counts[seen]), 0.85)  # 1 spike 0.3 of the row, 3 spikes 0.6
        axes.vlines(time_s[seen], row, row + height, color=LIGHT.neurons[neuron], linewidth=1.2)
    axes.set_ylim(-0.15, 4)
    axes.set_yticks([0.4, 1.4, 2.4, 3.4], [LABELS[n] for n in reversed(NEURONS)])


def _draw_states(axes: Axes, trace: NDArray[np.void]) -> None:
    """A ribbon: collisions in its upper half, states other than ok in its lower half."""
    spans = state_spans(trace)
    for state in STATE_LABELS:  # the thin edges keep short ones visible
        bars = [_bar(span) for span in spans if span.name == state]
        axes.broken_barh(bars, (0.0, 0.45), color=LIGHT.states[state], linewidth=0.7)
    alarms = [_bar(span) for span in collision_spans(trace)]
    axes.broken_barh(alarms, (0.55, 0.45), color=LIGHT.collision, linewidth=0.7)
    axes.set_ylim(0, 1)
    axes.set_yticks([])


def _bar(span: Span) -> tuple[float, float]:
    return span.start_s, span.end_s - span.start_s


def _draw_pictures(axes: Axes, scene: Scene, trace: NDArray[np.void], count: int) -> None:
    """A strip of ``count`` frames, evenly spaced; the one nearest the first collision replaces its neighbour."""
    alarms = collision_spans(trace)
    time_s = np.array([frame.time_s for frame in scene.frames])
    chosen = np.round(np.linspace(0, len(time_s) - 1, count + 2)[1:-1]).astype(int)
    decision = int(np.abs(time_s - alarms[0].start_s).argmin()) if alarms else -1
    if alarms:
        chosen[np.abs(chosen - decision).argmin()] = decision
    height, width = scene.frames[0].image.shape[:2]
    gap = 0.06 * width
    for place, number in enumerate(chosen):
        left = place * (width + gap)
        axes.imshow(
            scene.frames[number].image,
            cmap="gray",
            vmin=0,
            vmax=255,
            interpolation="nearest",
            extent=(left, left + width, 0, height),
        )
        mark = LIGHT.collision if number == decision else LIGHT.line
        axes.plot(
            [left, left + width, left + width, left, left],
            [0, 0, height, height, 0],
            color=mark,
            linewidth=3.5 if number == decision else 0.8,
            solid_joinstyle="miter",
            clip_on=False,
        )
        words = f"{time_s[number]:.2f} s" + (": collision" if number == decision else "")
        axes.text(
            left + width / 2,
            -0.06 * height,
            words,
            ha="center",
            va="top",
            fontsize=8,
            color=LIGHT.collision if number == decision else LIGHT.dim,
            fontweight="bold" if number == decision else "normal",
        )
    axes.set_xlim(-0.02 * width, len(chosen) * (width + gap) - gap + 0.02 * width)
    axes.set_ylim(-0.2 * height, 1.04 * height)
    axes.set_aspect("equal")
    axes.axis("off")
    axes.set_title(scene.title, fontsize=11, color=LIGHT.text)


def _draw_legends(column: Sequence[Axes], traces: Sequence[NDArray[np.void]]) -> None:
    """Name the curves, and of the states those that occur in one of the ``traces``, to the right of ``column``."""
    lgmds, lptcs, spikes, _ = column
    patch = importlib.import_module("matplotlib.patches").Patch
    seen = {str(name) for trace in traces for name in np.unique(trace["state"])} - {"ok"}
    marks = [patch(color=LIGHT.states[state], label=name) for state, name in STATE_LABELS.items() if state in seen]
    if any(trace["collision"].any() for trace in traces):
        marks.insert(0, patch(color=LIGHT.collision, label="collision"))
    for axes, handles in ((lgmds, None), (lptcs, None), (spikes, marks)):
        axes.legend(
            handles=handles,
            loc="upper left",
            bbox_to_anchor=(1.0, 1.0),
            frameon=False,
            fontsize=9,
            handlelength=1.4,
            borderaxespad=0,
            labelcolor=LIGHT.text,
        )


def _title(about: Mapping[str, Any]) -> str:
    source = str(about.get("source", ""))
    name = source if "://" in source else Path(source).name
    preset = "preset {preset}, neurons {neurons}".format_map({"neurons": "all", **about}) if "preset" in about else ""
    return "   ".join(part for part in (name, preset, str(about.get("settings_hash", ""))) if part).replace("$", r"\$")
