"""What ``lobula tune`` found, as text for people."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from .counted import counted
from .table import table

if TYPE_CHECKING:
    from ..tuning.journal import Trial
    from ..tuning.plan import Found, Scored

_FILM_COLUMNS = ("", "hits", "false", "minutes", "false/min", "mean lead s")
_ARENA_COLUMNS = ("", "SR1", "SR2", "CR", "CP", "AA", "AT", "AP", "spurious")


def as_text(found: Found) -> str:
    """Return the scores of the preset and of the best trial, what differs between them, and how fast it went."""
    from ..tuning.results import held_out_of, of_trial

    preset, best = f"preset {found.plan.preset}", f"best, trial {found.best.number}"
    lines: list[tuple[str, Scored | None]] = [
        (f"{preset}, searched on", found.preset),
        (f"{best}, searched on", of_trial(found.best)),
        (f"{preset}, held out", found.preset_held_out),
        (
            f"{best}, held out" if found.held_out else "chosen without the fold, held out",
            held_out_of(found, found.best),
        ),
    ]
    columns = _ARENA_COLUMNS if "SR1" in found.preset.about else _FILM_COLUMNS
    known = [(name, *_cells(scored.values, scored.about)) for name, scored in lines if scored is not None]
    parts = [table(columns, known, right=" ".join(columns).strip()), _settings(found)]
    return "\n\n".join([*parts, "\n".join(_remarks(found))])


def score_text(objectives: Sequence[float], about: Mapping[str, Any]) -> str:
    """Return a score in one line."""
    if "SR1" in about:
        rates = ", ".join(f"{name} {_rate(about[name])}" for name in ("SR1", "SR2"))
        return f"{rates} (CR {about['CR']}, CP {about['CP']}, AA {about['AA']}, AT {about['AT']}, AP {about['AP']})"
    return (
        f"hits {about['hits']} of {about['collisions']}, {counted(about['false_alarms'], 'false alarm')} in "
        f"{about['minutes']:.2f} min, mean lead {objectives[2]:.2f} s"
    )


def held_out_text(found: Found, trial: Trial) -> str:
    """Return the score of ``trial`` on what was held out in one line, or that there is none."""
    from ..tuning.results import held_out_of

    scored = held_out_of(found, trial)
    if scored is not None:
        of = "settings chosen without the clips they are scored on" if found.cross_validated else "what was held out"
        return f"Score of {of}: {score_text(scored.values, scored.about)}."
    if found.cross_validated:
        return "No score of its own on what was held out; that of the best trial stands in its file."
    return "NOT HELD OUT: nobody knows what these settings do on anything else."


def _cells(values: Sequence[float], about: Mapping[str, Any]) -> tuple[object, ...]:
    if "SR1" in about:
        return (_rate(about["SR1"]), _rate(about["SR2"]), *(about[name] for name in _ARENA_COLUMNS[3:]))
    _, per_minute, lead_s = values
    hits = f"{about['hits']}/{about['collisions']}"
    return hits, about["false_alarms"], f"{about['minutes']:.2f}", f"{per_minute:.2f}", f"{lead_s:.2f}"


def _rate(rate: float | None) -> str:
    return "-" if rate is None else f"{rate:.3f}"


def _settings(found: Found) -> str:
    rows = [(a.path, _number(a.start), _number(found.best.values[a.path]), a.range_text) for a in found.plan.axes]
    return table(("setting", "begun with", "best", "searched"), rows, right="best")


def _number(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value).lower()


def _remarks(found: Found) -> list[str]:
    from ..tuning.results import worse_held_out

    speed, lines = found.speed, []
    given_up = sum(bool(trial.problem) for some in found.trials.values() for trial in some)
    if found.plan.settings(found.best) == found.plan.base:
        lines.append("nothing better was found than the settings it began with")
    if given_up:
        lines.append(f"{counted(given_up, 'trial')} could not be measured: see trials.csv")
    worse = worse_held_out(found)
    if worse:
        lines.append(f"held out, what is called best does worse than the preset in: {'; '.join(worse)}")
    if found.preset_held_out is None:
        lines.append("NOT HELD OUT: the score is of the very clips that were searched on; it says nothing about others")
    if speed.trials_per_s is not None and speed.times_real_time is not None:
        lines.append(
            f"{counted(speed.trials, 'trial')} in this call, {speed.trials_per_s:.2f} a second with "
            f"{counted(found.plan.budget.workers, 'worker')}; "
            f"one core looks at {speed.times_real_time:.0f} times real time"
        )
    return lines
