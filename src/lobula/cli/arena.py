"""``lobula arena``: several robots in a room, each driven by what its own network sees."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from .._version import __version__
from ..errors import LobulaError, ParameterError
from . import options as o
from .call import new_app
from .counted import counted

if TYPE_CHECKING:
    from ..arena.course import Run
    from ..runtime.interrupts import Interrupted
    from .arena_saves import Shown
    from .progress import Screen

app = new_app()


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
    storage: Annotated[
        str | None, typer.Option(metavar="float|compact", help="compact: the robot's arithmetic, 16-bit planes")
    ] = None,
    save: Annotated[
        list[Path] | None,
        typer.Option(metavar="FILE.npz|mp4|png", help="the replay, a film or a picture of the run; may be repeated"),
    ] = None,
    replay: Annotated[Path | None, typer.Option(metavar="FILE.npz", help="draw a saved run; nothing runs")] = None,
    robot: Annotated[int | None, typer.Option(metavar="N", help="film: whose own view; 0 if left out")] = None,
    start: Annotated[float | None, typer.Option(metavar="S", help="film or picture: from this time of the run")] = None,
    end: Annotated[float | None, typer.Option(metavar="S", help="film or picture: to this time")] = None,
    speed: Annotated[
        float | None, typer.Option(metavar="X", help="film: times as fast; else as makes it 3 minutes at most")
    ] = None,
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
    from ..arena.world import World
    from ..arena.world_file import load_world, parse_world
    from ..runtime.interrupts import Interrupted
    from .arena_saves import Shown, check_saves, film_words
    from .arena_text import as_text, record, refusal
    from .destinations import check_files
    from .progress import say, screen
    from .settings import choose

    try:
        saves = save or []
        outputs: list[Path | None] = [*saves] or [None]
        for path in outputs:
            check_files(
                {"--save": path, "--events": events, "--checkpoint": checkpoint},
                {"world file": world, "settings file": config, "replay": replay},
            )
        chosen = choose(preset, neurons, config, settings or (), sensitivity)
        shown = Shown(robot, start, end, speed)
        if replay is not None:
            _refuse({"--robots": robots, "--minutes": minutes, "--seed": seed, "--world": world, "--preset": preset,
                     "--neurons": neurons, "--config": config, "--set": settings and " ".join(settings),
                     "--sensitivity": sensitivity, "--storage": storage, "--checkpoint": checkpoint,
                     "--events": events})  # fmt: skip
            return _replay(replay, saves, shown, json)
        _require_count(robots)
        there = None if world is None else load_world(world)
        kept = load_snapshot(checkpoint) if checkpoint is not None and checkpoint.exists() else None
        request: dict[str, Any] = {
            "world": there,
            "controller": NetworkController(chosen.params, engine=engine, storage=storage or "float"),
            "robots": robots,
            "minutes": minutes,
            "seed": seed,
            "record": bool(saves),
            "checkpoint": checkpoint,
            "resume": kept,
            "engine": engine,
        }
        length = (kept or {}).get("minutes", 60.0) if minutes is None else minutes
        plan = there or (parse_world(kept["world"], "checkpoint") if kept and "world" in kept else World())
        rate_hz = plan.camera.rate_hz
        check_saves(saves, shown, robots or plan.robots.count, round(60 * length * rate_hz), rate_hz)
        with screen(round(60 * length), "simulated seconds") as here:
            ended = _run(request, here)
    except (LobulaError, Interrupted) as error:
        if json:
            print(refusal(error), flush=True)
        raise
    if saves and ended.code:
        words = film_words(ended.run.record, saves, shown)
        say(
            f"lobula: interrupted after {ended.run.minutes:.2f} simulated minutes; "
            f"saving, Ctrl-C again ends that too{words}"
        )
    said, failure = _write(ended.run, saves, shown, events)
    failure = failure or ended.failure
    print(record(ended.run, chosen, failure, said) if json else as_text(ended.run), flush=True)
    if failure is not None:
        raise failure
    if ended.code:
        say(f"lobula: interrupted after {ended.run.minutes:.2f} of {length:g} simulated minutes")
    return ended.code


def _require_count(robots: int | None) -> None:
    from ..arena.world import RobotParams

    about = RobotParams.__dataclass_fields__["count"].metadata
    if robots is not None and not about["low"] <= robots <= about["high"]:
        raise ParameterError(f"--robots {robots}: must be from {about['low']} to {about['high']}")


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


def _write(
    done: Run, saves: list[Path], shown: Shown, events: Path | None
) -> tuple[dict[str, Any], LobulaError | Interrupted | None]:
    """Write what was asked for; return what there is to say of it, and what ended it, for after the report."""
    from ..experiments.closed_loop.event_rows import event_lines
    from ..landing import whole_file
    from ..runtime.interrupts import Interrupted
    from .arena_saves import write_saves

    said: dict[str, Any] = {}
    try:
        if events is not None:
            with whole_file(events) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
                file.writelines(event_lines(done.events))
        if saves and done.record is not None:
            said = write_saves(done.record, saves, shown)
    except (LobulaError, Interrupted) as error:
        return said, error
    return said, None


def _refuse(given: dict[str, Any]) -> None:
    for option, value in given.items():
        if value is not None:
            raise ParameterError(f"{option} {value}: a --replay holds its own run: must be left out")


def _replay(path: Path, saves: list[Path], shown: Shown, json: bool) -> int:
    """Draw a saved run."""
    from ..arena.record import load_record
    from ..experiments.arena_tale import driver_of
    from ..params import settings_hash
    from .arena_saves import REPLAY, check_saves, write_saves
    from .print_json import print_json
    from .progress import say

    if not saves or any(save.suffix.lower() == REPLAY for save in saves):
        raise ParameterError(f"--replay {path}: draws a run: must go with --save FILE.mp4 or --save FILE.png")
    try:
        record = load_record(path)
    except ParameterError as error:
        raise ParameterError(f"--replay {error}: must be a run saved by `lobula arena --save FILE.npz`") from error
    frames, count = record.poses.shape[:2]
    check_saves(saves, shown, count, frames, record.world.camera.rate_hz)
    said = write_saves(record, saves, shown)
    if json:
        print_json({
            "version": __version__, "replay": str(path), "controller": record.controller, "driver": driver_of(record),
            "world_hash": settings_hash(record.world), "seed": record.seed, "robots": count,
            "minutes": round(frames / record.world.camera.rate_hz / 60, 6), **said,
        })  # fmt: skip
    else:
        say(f"{', '.join(said['saved'])}: {counted(count, 'robot')}, seed {record.seed}, {driver_of(record)}")
    return 0
