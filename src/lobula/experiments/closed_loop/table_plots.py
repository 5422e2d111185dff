"""The drawings of Table I: rates beside the paper's, rates over time, walls by angle, avoidance against contact."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...arena.scoring import Score, Tally, by_incidence, over_time
from ...intervals import Interval, garwood
from ...report.elapsed_plot import Course, plot_elapsed
from ...report.incidence_plot import Bars, plot_incidence
from ...report.rate_plot import Rate, plot_rates
from ...report.trade_plot import Point, plot_trade
from .paper_table import LABELS, PAPER
from .table_jobs import CONTROLS, Groups, TablePlan, model_name

if TYPE_CHECKING:
    from matplotlib.figure import Figure

OTHER = "the paper"
TIMES = 60
"""Points of a course over the time elapsed."""


class Model(NamedTuple):
    """A model of the table: its key in the groups, its words, and which of the paper's it is (None: none of them)."""

    key: str
    label: str
    neurons: str | None


def models(plan: TablePlan, preset: str | None = None) -> Iterator[Model]:
    """Yield the paper's models of ``preset``; or of all presets, told apart where there are several, then our own."""
    for name in plan.presets if preset is None else (preset,):
        for neurons, label in LABELS.items():
            several = preset is None and len(plan.presets) > 1
            yield Model(model_name(name, neurons), f"{label}, {name}" if several else label, neurons)
    if preset is None:
        yield from own_models(plan)


def own_models(plan: TablePlan) -> Iterator[Model]:
    """Yield our own models."""
    for name in plan.own:
        yield Model(name, f"ours, preset {name}", None)


def controls() -> Iterator[Model]:
    """Yield the controllers that do not look."""
    for name in CONTROLS.values():
        yield Model(name, name, None)


def draw_rates(plan: TablePlan, groups: Groups, title: str) -> Figure:
    """Draw SR1 and SR2 with Wilson intervals beside the paper's."""
    panels: dict[str, dict[tuple[str, str], Rate]] = {"SR1: periphery": {}, "SR2: robots": {}}
    for model in models(plan):
        for robots in plan.densities:
            score, theirs = groups[model.key, robots].score, PAPER.get((robots, model.neurons or ""))
            rates = ((score.sr1, score.sr1_interval), (score.sr2, score.sr2_interval))
            for place, (panel, (rate, interval)) in enumerate(zip(panels.values(), rates, strict=True)):
                panel[f"{robots} robots", model.label] = Rate(
                    100 * rate, 100 * interval[0], 100 * interval[1], None if theirs is None else theirs[place]
                )
    names = [f"{robots} robots" for robots in plan.densities]
    return plot_rates(panels, groups=names, series=[m.label for m in models(plan)], other=OTHER, title=title)


def draw_elapsed(plan: TablePlan, groups: Groups, title: str) -> Figure:
    """Draw SR1 and SR2 of all events up to each time."""
    ends_min = np.linspace(plan.minutes / TIMES, plan.minutes, TIMES)
    panels: dict[tuple[str, str], dict[str, Course]] = {}
    for robots in plan.densities:
        for model in models(plan):
            tallies = _tallies(groups, model, robots, (ends_min * 60).tolist())
            theirs = PAPER.get((robots, model.neurons or ""))
            for place, name in enumerate(("SR1", "SR2")):
                rates = [100 * (tally.sr1, tally.sr2)[place] for tally in tallies]
                course = Course(ends_min.tolist(), rates, None if theirs is None else theirs[place])
                panels.setdefault((name, f"{robots} robots"), {})[model.label] = course
    ordered = {key: panels[key] for key in sorted(panels)}
    return plot_elapsed(ordered, other=OTHER, title=title)


def draw_walls(plan: TablePlan, groups: Groups, title: str) -> Figure:
    """Draw contacts with the periphery by angle and LPTC state."""
    panels = {}
    for robots in plan.densities:
        for model in models(plan):
            events = np.concatenate([done.events for done in groups[model.key, robots].results])
            panels[f"{robots} robots", model.label] = Bars(*by_incidence(events))
    return plot_incidence(panels, what="wall contacts", title=title)


def draw_trade(plan: TablePlan, groups: Groups, title: str) -> Figure:
    """Draw AT against CR per robot-hour, every model and the controls but the one that always turns."""
    panels: dict[str, dict[str, Sequence[Point]]] = {}
    shown = [*models(plan), *(m for m in controls() if m.key != CONTROLS["always"])]
    for robots in plan.densities:
        panels[f"{robots} robots"] = {m.label: [trade_point(groups[m.key, robots].score)] for m in shown}
    return plot_trade(panels, x="CR per robot-hour", y="AT per robot-hour", lines=False, title=title)


def trade_point(score: Score, label: str = "") -> Point:
    """Return AT against CR per robot-hour, with exact Poisson intervals."""
    hours = score.robot_minutes / 60
    return Point(score.cr / hours, score.at / hours, _per(score.cr, hours), _per(score.at, hours), label)


def _per(count: int, hours: float) -> Interval:
    low, high = garwood(count)
    return low / hours, high / hours


def _tallies(groups: Groups, model: Model, robots: int, ends_s: Sequence[float]) -> list[Tally]:
    events = np.concatenate([done.events for done in groups[model.key, robots].results])
    return over_time(events, ends_s)
