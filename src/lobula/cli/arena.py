"""``lobula arena``: several robots in a room, each driven by what its own network sees."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from ..errors import LobulaError, OutputError
from . import options as o
from .call import new_app

if TYPE_CHECKING:
    from ..arena.running import Run
    from .progress import Screen

app = new_app()


SAVED_AS = (".npz",)
"""What --save can write."""


class Ended(NamedTuple):
    """A run that has ended, by itself, by a signal or by a failure."""

    run: Run
    code: int = 0
    failure: LobulaError | None = None


@app.command()
def arena(
    robots: Annotated[int | None, typer.Option(metavar="N", help="how many; 4 if left out")] = None,
    minutes: Annotated[float | None, typer.Option(metavar="MIN", help="of simulated time; 60 if left out")] = None,
    seed: Annotated[int | None, typer.Option(metavar="N", help="of all chance; 0 if left out")] = None,
    world: Annotated[Path | None, typer.Option(metavar="FILE.toml", help="another arena than the paper's")] = None,
    preset: o.Preset = None,
    neurons: o.Neurons = None,
    config: o.Config = None,
    settings: o.Settings = None,
    sensitivity: o.Sensitivity = None,
    engine: o.Engine = "auto",
    save: Annotated[Path | None, typer.Option(metavar="FILE.npz", help="the replay: every frame of the run")] = None,
    events: Annotated[Path | None, typer.Option(metavar="FILE.csv", help="each contact and avoidance, a row")] = None,
    checkpoint: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="where the run stands; if it is there already, the run goes on from it"),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="one record on standard output")] = False,
) -> int:
    """Let robots drive in an arena, and count their contacts and avoidances.

    Ctrl-C ends the run early: what was done until then is reported and written. With --checkpoint the same command
    takes it up again, to the same end.
    """
    from ..arena.network_controller import NetworkController
    from ..arena.snapshot import load_snapshot
    from ..arena.world_file import load_world
    from ..runtime.interrupts import Interrupted
    from .arena_text import as_text, record, refusal
    from .destinations import check_ending, check_files
    from .progress import say, screen
    from .settings import choose

    try:
        if save is not None:
            check_ending("--save", save, SAVED_AS)
        files = {"--save": save, "--events": events, "--checkpoint": checkpoint}
        check_files(files, {"world file": world, "settings file": config})
        chosen = choose(preset, neurons, config, settings or (), sensitivity)
        kept = load_snapshot(checkpoint) if checkpoint is not None and checkpoint.exists() else None
        request: dict[str, Any] = {
            "world": None if world is None else load_world(world),
            "controller": NetworkController(chosen.params, engine=engine),
            "robots": robots,
            "minutes": minutes,
            "seed": seed,
            "record": save is not None,
            "checkpoint": checkpoint,
            "resume": kept,
            "engine": engine,
        }
        length = (kept or {}).get("minutes", 60.0) if minutes is None else minutes
        with screen(round(60 * length), "simulated seconds") as here:
            ended = _run(request, here)
    except (LobulaError, Interrupted) as error:
        if json:
            print(refusal(error), flush=True)
        raise
    failure = _write(ended.run, save, events) or ended.failure
    print(record(ended.run, chosen, failure) if json else as_text(ended.run), flush=True)
    if failure is not None:
        raise failure
    if ended.code:
        say(f"lobula: interrupted after {ended.run.minutes:.2f} of {length:g} simulated minutes")
    return ended.code


def _run(request: dict[str, Any], here: Screen) -> Ended:
    from ..arena.controller import ControllerError
    from ..arena.running import RunInterrupted, run

    try:
        return Ended(run(**request, progress=_along(here)))
    except RunInterrupted as stop:
        return Ended(stop.run, 128 + stop.number)
    except ControllerError as error:
        if error.run is None:
            raise
        return Ended(error.run, failure=error)  # what ran before is worth keeping


def _along(here: Screen) -> Callable[[float, float], None] | None:
    """Move the bar to where the run is: one that is taken up again starts in the middle."""
    if here.advance is None:
        return None
    advance, shown = here.advance, 0

    def progress(done_minutes: float, minutes: float) -> None:
        nonlocal shown
        while shown < round(60 * done_minutes):
            advance()
            shown += 1

    return progress


def _write(done: Run, save: Path | None, events: Path | None) -> LobulaError | None:
    """Write what was asked for; return what went wrong, to be raised when the run has been reported."""
    from ..experiments.closed_loop.event_rows import event_lines
    from ..report.landing import whole_file

    try:
        if save is not None and done.record is not None:
            done.record.save(save)
        if events is not None:
            with whole_file(events) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
                file.writelines(event_lines(done.events))
    except OutputError as error:
        return error
    return None
