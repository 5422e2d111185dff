"""Table I of the paper: runs it, or what is left of it, and writes everything into a folder.

table1.md for people, table1.json for programs, table1.csv with every job, table1-events.csv with every event, the
drawings as png and svg, runs.ndjson with a line for each time it was started; the results of the jobs in table1-jobs.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from ..._version import __version__
from ...errors import ParameterError
from ...landing import whole_file
from ...params import settings_hash
from ...report.plots import save_figure
from . import table_plots as plots
from .beyond_claims import BEYOND
from .code_hash import code_hash
from .job_rows import all_event_lines, job_lines
from .jobs import Done
from .pool import run_jobs
from .run_log import note
from .table_claims import CLAIMS, Models, TableClaim
from .table_jobs import Groups, TablePlan, control_jobs, grouped, model_jobs
from .table_page import page

NAME, TITLE = "table1", "Success rates in the arena"
COMMAND = "lobula reproduce table1"
FIRST_SEED, SEEDS, MINUTES = 7001, 10, 60.0
"""Those of the protocol, docs/protocol.md."""
QUICK_FIRST_SEED, QUICK_SEEDS, QUICK_MINUTES = 1, 2, 2.0

DRAWINGS: dict[str, tuple[str, Callable[[TablePlan, Groups, str], Any]]] = {
    "table1": ("Success rates beside the paper's, with Wilson intervals", plots.draw_rates),
    "table1-elapsed": ("Success rates of all events up to each time, all seeds together", plots.draw_elapsed),
    "table1-walls": ("Contacts with walls by the angle to their normal, and the state of the LPTCs", plots.draw_walls),
    "table1-trade": (
        "Avoidances of translating robots against contacts with robots; never-turn and random-turn do not look",
        plots.draw_trade,
    ),
}


def seeds(first: int, count: int) -> range:
    """Return ``count`` seeds from ``first`` on.

    Raises
    ------
    ParameterError : not 1 to 500 of them, or below 0
    """
    if not 1 <= count <= 500:
        raise ParameterError(f"--seeds {count}: must be 1 to 500")
    if first < 0:
        raise ParameterError(f"--first-seed {first}: must be 0 or more")
    return range(first, first + count)


def make(
    plan: TablePlan,
    folder: Path,
    *,
    quick: bool = False,
    workers: int = 1,
    advance: Callable[[], None] | None = None,
) -> dict[str, Any]:
    """Run what is left of ``plan``, write all files into ``folder`` and return the document.

    ``advance`` is called for each job. The numbers are the same for any number of ``workers``, and for a table that was
    interrupted and taken up again.

    Raises
    ------
    ParameterError : results in the folder were made with other settings or by other code
    Interrupted : a signal came; what is finished is in the folder, and the next call goes on from there
    OutputError : a file cannot be written
    """
    jobs = folder / f"{NAME}-jobs"
    note(folder, COMMAND, {**_settings(plan), "quick": quick, "phase": "start"})
    results = run_jobs(list(model_jobs(plan)), jobs, workers=workers, advance=advance)
    results += run_jobs(list(control_jobs(plan, results)), jobs, workers=workers, advance=advance)
    found = write(plan, results, folder, quick)
    note(folder, COMMAND, {**_settings(plan), "quick": quick, "phase": "end"})
    return found


def write(plan: TablePlan, results: Sequence[Done], folder: Path, quick: bool) -> dict[str, Any]:
    """Write tables, drawings and page, and return the document."""
    groups = grouped(results)
    _write(folder / f"{NAME}.csv", job_lines(results))
    _write(folder / f"{NAME}-events.csv", all_event_lines(results))
    found = document(plan, groups, quick)
    _write(folder / f"{NAME}.json", [json.dumps(found, indent=1, allow_nan=False) + "\n"])
    title = f"{len(plan.seeds)} seeds of {plan.minutes:g} simulated minutes" + (", a quick look" if quick else "")
    pictures = {}
    for name, (about, draw) in DRAWINGS.items():
        drawing = draw(plan, groups, title)
        for suffix in (".svg", ".png"):
            save_figure(drawing, folder / f"{name}{suffix}")
        pictures[f"{name}.png"] = about
    _write(folder / f"{NAME}.md", (f"{line}\n" for line in page(plan, groups, found, pictures)))
    return found


def document(plan: TablePlan, groups: Groups, quick: bool) -> dict[str, Any]:
    """Return claims, verdicts and scores as plain dictionaries, lists and numbers."""
    return {
        "version": __version__,
        "code": code_hash(),
        "figure": NAME,
        "title": TITLE,
        "command": COMMAND,
        "quick": quick,
        **_settings(plan),
        "claims": _judged(CLAIMS, {preset: Models(groups, preset) for preset in plan.presets}),
        "beyond": _judged(BEYOND, {own: Models(groups, next(iter(plan.presets)), own) for own in plan.own}),
        "scores": [
            {"model": model, "robots": robots, **group.score.as_dict()} for (model, robots), group in groups.items()
        ],
    }


def _judged(claims: Sequence[TableClaim], models: Mapping[str, Models]) -> list[dict[str, Any]]:
    return [
        {
            "number": claim.number,
            "paper": claim.paper,
            "rule": claim.rule,
            "verdicts": {name: claim.verdict(of) for name, of in models.items()},
        }
        for claim in claims
    ]


def _settings(plan: TablePlan) -> dict[str, Any]:
    return {
        "presets": {name: settings_hash(params) for name, params in plan.presets.items()},
        "own": {name: settings_hash(params) for name, params in plan.own.items()},
        "world": settings_hash(plan.world),
        "robots": list(plan.densities),
        "seeds": list(plan.seeds),
        "minutes": plan.minutes,
    }


def _write(path: Path, lines: Iterable[str]) -> None:
    with whole_file(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        file.writelines(lines)
