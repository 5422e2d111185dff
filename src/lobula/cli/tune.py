"""``lobula tune``: settings searched on evidence, with a held-out score beside the score searched by."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import ParameterError
from . import options as o
from .call import new_app

if TYPE_CHECKING:
    from ..tuning.task import Task

app = new_app()

BATTERY, ARENA = "battery", "arena"
CLIPS_ONLY = ("clips", "size", "fit", "no_held_out")
ARENA_ONLY = ("seeds", "held_out_seeds", "sim_minutes", "robots")

Advance = Callable[[], None] | None


@app.command()
def tune(
    on: Annotated[str, typer.Option(metavar="battery|LABELS.csv|arena", help="what settings are searched on")],
    out: Annotated[Path, typer.Option(metavar="DIR", help="folder of the search; a search that is there goes on")],
    trials: Annotated[
        int | None, typer.Option(metavar="N", help="until each search has so many; 100 if no --minutes")
    ] = None,
    minutes: Annotated[float | None, typer.Option(metavar="MIN", help="at most so long")] = None,
    workers: Annotated[int | None, typer.Option(metavar="N", help="processes; one a core if left out")] = None,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="PATH[=LOW..HIGH|=xFACTOR]",
            help="what is searched: a setting, or a pattern such as 'lptc.*'; may be repeated",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(metavar="N", help="of the search's own chance")] = 0,
    clips: Annotated[
        Path | None, typer.Option(metavar="DIR", help="clips: their folder, found as `lobula evaluate` finds it")
    ] = None,
    size: Annotated[str | None, typer.Option(metavar="WxH", help="clips: working size; 99x72")] = None,
    fit: Annotated[
        str | None, typer.Option(metavar="crop|squeeze|pad", help="clips: how another shape is brought to it; crop")
    ] = None,
    no_held_out: Annotated[
        bool, typer.Option("--no-held-out", help="clips: search without a held-out score; every result is marked")
    ] = False,
    seeds: Annotated[str | None, typer.Option(metavar="A..B", help="arena: searched on; 201..202")] = None,
    held_out_seeds: Annotated[str | None, typer.Option(metavar="A..B", help="arena: held out; 251..254")] = None,
    sim_minutes: Annotated[float | None, typer.Option(metavar="MIN", help="arena: simulated, of each run; 2")] = None,
    robots: Annotated[str | None, typer.Option(metavar="N[,N]", help="arena: numbers of robots; 4,7")] = None,
    preset: o.Preset = None,
    neurons: o.Neurons = None,
    config: o.Config = None,
    settings: o.Settings = None,
    json: o.Json = False,
) -> None:
    """Search settings over the ranges written beside them, and score what was found on what was held out.

    Ctrl-C, a kill or a power cut lose at most the trials under way; the same command goes on.
    """
    from ..model.presets import DEFAULT
    from ..report.axes import new_figure
    from ..runtime.interrupts import Interrupted
    from ..tuning.journal import load_optuna, opened
    from ..tuning.plan import Budget, Plan
    from ..tuning.results import document, write_results
    from ..tuning.scratch import scratch
    from ..tuning.search import tune as search
    from ..tuning.space import axes
    from ..workers import cores
    from .destinations import make_folder
    from .print_json import print_json
    from .progress import say, screen
    from .settings import choose
    from .tune_presets import BEST, write_presets
    from .tune_text import as_text

    given = {"clips": clips, "size": size, "fit": fit, "no_held_out": no_held_out, "seeds": seeds,
             "held_out_seeds": held_out_seeds, "sim_minutes": sim_minutes, "robots": robots}  # fmt: skip
    _require_options_of(on, given)
    chosen = choose(preset, neurons, config, settings or ())
    name = DEFAULT if chosen.preset == "default" else chosen.preset  # what default is may change
    wanted = axes(chosen.params, vary or ())
    budget = Budget(trials=trials, minutes=minutes, workers=cores() if workers is None else workers, seed=seed)
    load_optuna()
    new_figure(1, 1)  # says now, not after the search, that matplotlib is missing
    make_folder("--out", out)
    with opened(out) as journal, scratch(out) as films:
        task = _task(on, given, films)
        if left_out := task.about.get("left_out"):
            say(f"lobula: left out, for they do not count or are marked as test: {', '.join(left_out)}")
        plan = Plan(task=task, base=chosen.params, preset=name, axes=wanted, budget=budget)
        total = None if trials is None and minutes is not None else budget.most * len(task.splits)
        try:
            with screen(total, "trials") as here:
                found = search(plan, journal, advance=here.advance)
        except Interrupted:
            say(f"lobula: what was tried lies in {out}; the same command goes on from there")
            raise
    write_presets(found, out)
    write_results(found, out)
    if json:
        print_json({"folder": str(out), **document(found)})
    else:
        print(as_text(found))
        say(f"{out / BEST}: for --config of every verb; {out / 'front.png'}: all that is worth a look")


def _require_options_of(on: str, given: dict[str, Any]) -> None:
    """Check that each option that was given means something for ``on``.

    Raises
    ------
    ParameterError : one does not, or ``on`` is nothing that can be searched on
    """
    kind = on if on in (BATTERY, ARENA) else "clips"
    if kind == "clips" and not on.lower().endswith(".csv"):
        raise ParameterError(f"--on {on}: must be {BATTERY}, {ARENA}, or a file LABELS.csv")
    if kind == "clips" and not Path(on).is_file():
        raise ParameterError(f"--on {on}: no such file: must be labels of clips")
    wanted = {BATTERY: (), ARENA: ARENA_ONLY, "clips": CLIPS_ONLY}[kind]
    for name, value in given.items():
        if value not in (None, False) and name not in wanted:
            needed = "--on arena" if name in ARENA_ONLY else "--on LABELS.csv"
            raise ParameterError(f"--{name.replace('_', '-')}: means something with {needed} only, not --on {on}")


def _task(on: str, given: dict[str, Any], films: Path) -> Task:
    """Return what is measured on, its films made in the folder ``films``."""
    from ..tuning.arena_task import HELD_OUT_SEEDS, MINUTES, ROBOTS, SEEDS, arena_task
    from ..tuning.battery_task import battery_cases, battery_task
    from ..tuning.clips_task import clips_task
    from .evaluate import clips_folder
    from .progress import screen

    if on == ARENA:
        return arena_task(
            _seeds("--seeds", given["seeds"]) or SEEDS,
            _seeds("--held-out-seeds", given["held_out_seeds"]) or HELD_OUT_SEEDS,
            MINUTES if given["sim_minutes"] is None else given["sim_minutes"],
            _numbers("--robots", given["robots"]) or ROBOTS,
        )
    if on == BATTERY:
        with screen(sum(1 for _ in battery_cases()), "movies made") as here:
            return battery_task(films, advance=here.advance)
    from ..evaluate.labels import read_labels
    from ..tuning.clips_task import searched

    folder, labels = clips_folder(given["clips"]), Path(on)
    with screen(len(searched(read_labels(labels))), "clips decoded") as here:
        return clips_task(
            labels, folder, films, hold_out=not given["no_held_out"], advance=here.advance,
            size=o.parse_size(given["size"] or "99x72", "--size"), fit=given["fit"] or "crop",
        )  # fmt: skip


def _seeds(option: str, text: str | None) -> range | None:
    """Return ``A..B`` as a range that ends with B; ``A`` alone as one seed."""
    if text is None:
        return None
    match = re.fullmatch(r"\s*(\d+)\s*(?:\.\.\s*(\d+)\s*)?", text)
    found = range(int(match[1]), int(match[2] or match[1]) + 1) if match else range(0)
    if not found:
        raise ParameterError(f"{option} {text}: must be A..B, whole numbers of 0 or more, such as 201..204")
    return found


def _numbers(option: str, text: str | None) -> tuple[int, ...] | None:
    """Return ``4,7`` as numbers."""
    if text is None:
        return None
    if not re.fullmatch(r"\s*\d+\s*(,\s*\d+\s*)*", text):
        raise ParameterError(f"{option} {text}: must be whole numbers parted by commas, such as 4,7")
    return tuple(dict.fromkeys(int(part) for part in text.split(",")))
