"""What was found, as one document, as a table of all trials and as a picture."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..intervals import Interval
from ..landing import whole_file
from ..params import settings_hash
from ..report.front_plot import Mark, Series, plot_front
from ..report.plots import save_figure
from .journal import Trial
from .plan import Found, Scored

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DOCUMENT, TABLE = "tuning.json", "trials.csv"
PICTURES = ("front.png", "front.svg")

VIEWS = {
    "missed": (("false_per_minute", "missed"), ("false_per_minute", "lead_s")),
    "failed_sr1": (("failed_sr2", "failed_sr1"),),
}
"""By the first objective: what is drawn to the right and upwards, a row for each pair."""

WORDS = {
    "missed": "share of the collisions missed",
    "false_per_minute": "false alarms a minute",
    "lead_s": "mean lead time, s; 0 for a miss",
    "failed_sr1": "1 - SR1",
    "failed_sr2": "1 - SR2",
}


def write_results(found: Found, folder: Path) -> None:
    """Write the document, the table and the pictures into ``folder``.

    Raises
    ------
    OutputError : one of them cannot be written
    MissingExtraError : matplotlib is not installed
    """
    with whole_file(folder / DOCUMENT) as temporary:
        temporary.write_text(json.dumps(document(found), indent=1, allow_nan=False) + "\n", encoding="utf-8")
    with whole_file(folder / TABLE) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows(rows(found))
    drawing = draw(found)
    for name in PICTURES:
        save_figure(drawing, folder / name)


def document(found: Found) -> dict[str, Any]:
    """Return what was searched, on what, how, and what came of it, as plain dictionaries, lists and numbers."""
    plan, speed = found.plan, found.speed
    return {
        "version": found.identity["version"],
        "code": found.identity["code"],
        "measured_on": dict(plan.task.about),
        "parts": found.identity["parts"],
        "begun_with": {"preset": plan.preset, "settings_hash": settings_hash(plan.base)},
        "searched": [{"path": a.path, "range": a.range_text, "begun_with": a.start} for a in plan.axes],
        "objectives": [objective._asdict() for objective in plan.task.objectives],
        "seed": plan.budget.seed,
        "trials": {
            name: {"measured": sum(not t.problem for t in some), "given_up": sum(bool(t.problem) for t in some)}
            for name, some in found.trials.items()
        },
        "best": _entry(found, found.best),
        "preset": {
            "searched_on": _score(found, found.preset),
            "held_out": None if found.preset_held_out is None else _score(found, found.preset_held_out),
        },
        "cross_validation": None if found.cross_validated is None else _cross_validation(found),
        "front": [_entry(found, trial) for trial in found.front],
        "speed": {
            "trials": speed.trials,
            "trials_per_s": _rounded(speed.trials_per_s),
            "times_real_time_per_core": _rounded(speed.times_real_time),
            "workers": plan.budget.workers,
        },
    }


def held_out_of(found: Found, trial: Trial) -> Scored | None:
    """Return the score of ``trial`` on what was held out.

    Where that is cross-validation, it stands for the best: settings chosen in the same way.
    """
    return found.held_out.get(trial.number) or (found.cross_validated if trial == found.best else None)


def worse_held_out(found: Found) -> list[str]:
    """Return in which objectives the best did worse on what was held out than the settings it began with, in words."""
    now, before = held_out_of(found, found.best), found.preset_held_out
    if now is None or before is None:
        return []
    return [
        f"{objective.meaning}, {ours:.3g} against {its:.3g}"
        for objective, ours, its in zip(found.plan.task.objectives, now.values, before.values, strict=True)
        if (ours > its if objective.direction == "minimize" else ours < its)
    ]


def rows(found: Found) -> Iterable[Sequence[Any]]:
    """Yield the lines of the table: a heading, then every trial of every search."""
    names = [objective.name for objective in found.plan.task.objectives]
    paths = [axis.path for axis in found.plan.axes]
    yield ("search", "trial", *names, "merit", "front", "problem", *paths)
    of_front = {trial.number for trial in found.front}
    first = next(iter(found.trials))
    for search, some in found.trials.items():
        for trial in some:
            numbers = [f"{value:.6g}" for value in trial.objectives or ()] or [""] * len(names)
            merit = "" if trial.problem else f"{trial.merit:.6g}"
            mark = int(search == first and trial.number in of_front)
            yield (search, trial.number, *numbers, merit, mark, trial.problem, *(trial.values[p] for p in paths))


def draw(found: Found) -> Figure:
    """Draw the trials and their front, on what was searched on and on what was held out.

    Raises
    ------
    MissingExtraError : matplotlib is not installed
    """
    first = next(iter(found.trials.values()))
    preset, best = f"preset {found.plan.preset}", f"best: trial {found.best.number}"
    of_front, others = "the front, with their numbers", "trials"
    panels = {
        "searched on": [
            Series("trials", others, [_mark(found, of_trial(t)) for t in first if t.objectives]),
            Series("front", of_front, [_mark(found, of_trial(t), str(t.number)) for t in found.front]),
            Series("preset", preset, [_mark(found, found.preset, ends=True)]),
            Series("best", best, [_mark(found, of_trial(found.best), ends=True)]),
        ]
    }
    scored = held_out_of(found, found.best)
    if scored is not None and found.preset_held_out is not None:
        panels["held out" if found.held_out else "held out, cross-validated"] = [
            Series("front", of_front, [_mark(found, one, str(number)) for number, one in found.held_out.items()]),
            Series("preset", preset, [_mark(found, found.preset_held_out, ends=True)]),
            Series("best", best, [_mark(found, scored, ends=True)]),
        ]
    title = f"lobula tune on {found.plan.task.about['on']}, {len(first)} trials, seed {found.plan.budget.seed}"
    return plot_front(panels, VIEWS[found.plan.task.objectives[0].name], WORDS, title)


def of_trial(trial: Trial) -> Scored:
    """Return the score of ``trial`` on what was searched on."""
    return Scored(trial.objectives or (), trial.about or {})


def _mark(found: Found, scored: Scored, label: str = "", *, ends: bool = False) -> Mark:
    return Mark(_named(found, scored.values), _intervals(scored.about) if ends else {}, label)


def _intervals(about: Mapping[str, Any]) -> dict[str, Interval]:
    """Return the intervals of the objectives that are shares or rates of counts."""
    if "hits" in about:
        low, high = about["hit_interval"]
        return {"missed": (1 - high, 1 - low), "false_per_minute": tuple(about["per_minute_interval"])}
    return {f"failed_{rate}": (1 - about[f"{rate.upper()}_high"], 1 - about[f"{rate.upper()}_low"])
            for rate in ("sr1", "sr2")}  # fmt: skip


def _entry(found: Found, trial: Trial) -> dict[str, Any]:
    scored = held_out_of(found, trial)
    return {
        "trial": trial.number,
        "settings_hash": settings_hash(found.plan.settings(trial)),
        "settings": dict(trial.values),
        "merit": _rounded(trial.merit),
        "searched_on": _score(found, of_trial(trial)),
        "held_out": None if scored is None else _score(found, scored),
    }


def _cross_validation(found: Found) -> list[dict[str, Any]]:
    first = next(iter(found.trials))
    return [
        {"search": name, "trial": trial.number, "settings": dict(trial.values)}
        for name, trial in found.chosen.items()
        if name != first
    ]


def _score(found: Found, scored: Scored) -> dict[str, Any]:
    objectives = {name: _rounded(value) for name, value in _named(found, scored.values).items()}
    return {**objectives, **scored.about}


def _named(found: Found, values: Sequence[float]) -> dict[str, float]:
    return {o.name: value for o, value in zip(found.plan.task.objectives, values, strict=True)}


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 6)
