"""``lobula reproduce``: the paper's figures and its table made again, claim by claim."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import ParameterError
from . import options as o
from .call import new_app
from .reproduce_table import TABLE

if TYPE_CHECKING:
    from ..experiments.paper.figure import Plan

app = new_app()

ALL = "all"


@app.command()
def reproduce(
    what: Annotated[str, typer.Argument(metavar="WHAT", help="fig4, fig5, fig6, table1 or all")],
    out: Annotated[Path, typer.Option(metavar="DIR", help="folder for the figures, tables and pages")],
    seeds: Annotated[int | None, typer.Option(metavar="N", help="repeats of everything; 10 if left out")] = None,
    quick: Annotated[bool, typer.Option("--quick", help="a look: 2 repeats if --seeds does not say otherwise")] = False,
    preset: Annotated[
        str | None, typer.Option(metavar="NAME", help="paper or published; if left out both, for table1 paper")
    ] = None,
    minutes: Annotated[
        float | None, typer.Option(metavar="MIN", help="table1: simulated time of each run; 60, with --quick 2")
    ] = None,
    first_seed: Annotated[
        int | None, typer.Option(metavar="N", help="table1: 7001, the protocol's; with --quick 1")
    ] = None,
    workers: Annotated[int | None, typer.Option(metavar="N", help="table1: processes; one a core if left out")] = None,
    json: o.Json = False,
) -> None:
    """Run an experiment of the paper: its figure, every trial as CSV, and a page that says which claims hold."""
    from ..experiments.paper.reproduction import FIGURES, gather, reproduce
    from ..report.axes import new_figure
    from .destinations import make_folder
    from .print_json import print_json
    from .progress import say, screen
    from .reproduce_table import make_table, table_plan

    names = [*FIGURES, TABLE]
    if what not in (*names, ALL):
        from ..params import nearest

        raise ParameterError(f"reproduce {what}{nearest(what, [*names, ALL])}")
    if what in FIGURES:
        _refuse(what, {"--minutes": minutes, "--first-seed": first_seed, "--workers": workers})
    plan, chosen = _plan(seeds, quick, preset), [FIGURES[name] for name in FIGURES if what in (name, ALL)]
    table = table_plan(seeds, quick, preset, minutes, first_seed, workers) if what in (TABLE, ALL) else None
    new_figure(1, 1)  # says now, not after minutes, that matplotlib is missing
    make_folder("--out", out)
    found = []
    if chosen:
        with screen(sum(1 for figure in chosen for _ in figure.shots(plan)), "films") as here:
            found += [reproduce(figure, plan, out, here.advance) for figure in chosen]
    if table is not None:
        found.append(make_table(table, out, quick, workers))
        gather(out)
    if json:
        print_json({"folder": str(out), "figures": found})
    else:
        print("\n\n".join(map(_text, found)))
        say(f"\n{out / 'paper.md'}: every claim, and why it does not hold where it does not")


def _refuse(what: str, given: dict[str, Any]) -> None:
    for option, value in given.items():
        if value is not None:
            raise ParameterError(f"{option} {value}: goes with {TABLE} or {ALL}, not with {what}")


def _plan(count: int | None, quick: bool, preset: str | None) -> Plan:
    from ..experiments.paper.figure import PRESETS, QUICK_SEEDS, QUICK_SIDE_SEEDS, SEEDS, SIDE_SEEDS, Plan
    from ..experiments.paper.reproduction import seeds
    from ..model.presets import BASES
    from ..model.presets import preset as named_preset

    if preset is not None and preset not in BASES:
        raise ParameterError(f"--preset {preset}: must be one of {', '.join(PRESETS)}")
    return Plan(
        presets={name: named_preset(name) for name in (PRESETS if preset is None else (preset,))},
        seeds=seeds(count if count is not None else QUICK_SEEDS if quick else SEEDS),
        side_seeds=QUICK_SIDE_SEEDS if quick else SIDE_SEEDS,
    )


def _text(found: dict[str, Any]) -> str:
    from .table import table

    presets = list(found["presets"])
    rows = [
        (claim["number"], *(_cell(claim["verdicts"][name]) for name in presets), claim["paper"])
        for claim in found["claims"]
    ]
    return f"{found['figure']}: {found['title']}\n" + table(("claim", *presets, "the paper says"), rows)


def _cell(verdict: dict[str, Any]) -> str:
    return f"{verdict['status']}, {verdict['held']}/{verdict['trials']}"
