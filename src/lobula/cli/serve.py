"""``lobula serve``: the live page."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import ParameterError
from . import options as o
from .call import new_app
from .hooks import HookRate, HookTargets, hook_files, make_hooks, with_hooks
from .robot import is_robot, open_robot, port_of, refuse_others

if TYPE_CHECKING:
    from ..dashboard.board import Board
    from ..dashboard.live_settings import LiveSettings
    from ..dashboard.server import Site
    from ..frames import FrameSource
    from ..hooks import Hook
    from ..model.network import NetworkParams
    from ..runtime.robot import RobotStream
    from ..runtime.sinks import Sink
    from ..runtime.yaw import YawRecord

app = new_app()

OF_A_ROBOT = frozenset({
    "source", "json", "host", "port", "token", "allow_host", "hook", "hook_rate", "start", "end", "stride",
    "max_frames", "reconnect", "timeout",
})  # fmt: skip
"""What can be asked for when the decisions are a robot's."""

PORT = 8040
KEPT_ROWS = 4096
"""Readings of a live run that a page opened later still gets: two minutes at 30 Hz."""


@app.command()
def serve(
    context: typer.Context,
    source: Annotated[
        str,
        typer.Argument(
            metavar="SOURCE",
            help="camera number, address or - for a pipe: live; video, image folder, pattern or saved trace: replayed; "
            "serial:PORT: a robot, live",
        ),
    ],
    json: Annotated[bool, typer.Option("--json", help="NDJSON on standard output: the address, then events")] = False,
    host: Annotated[str, typer.Option(metavar="ADDRESS", help="where it is served; this machine alone if left out")] = (
        "127.0.0.1"
    ),
    port: Annotated[int, typer.Option(metavar="N", help="0 takes any that is free", min=0, max=65535)] = PORT,
    token: Annotated[
        str | None,
        typer.Option(metavar="TEXT", envvar="LOBULA_TOKEN", help="what a visitor must know; made where it is needed"),
    ] = None,
    allow_host: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="another name the page is reached by, as behind a proxy; may be repeated"),
    ] = None,
    hook: HookTargets = None,
    hook_rate: HookRate = None,
    preset: o.Preset = None,
    neurons: o.Neurons = None,
    config: o.Config = None,
    settings: o.Settings = None,
    sensitivity: o.Sensitivity = None,
    engine: o.Engine = "auto",
    scale_kernels: o.ScaleKernels = False,
    size: o.Size = "99x72",
    fit: o.Fit = "crop",
    roi: o.Roi = None,
    mask: o.Mask = None,
    flip: o.Flip = None,
    rotate: o.Rotate = 0,
    yaw: o.Yaw = None,
    start: o.Start = None,
    end: o.End = None,
    stride: o.Stride = 1,
    max_frames: o.MaxFrames = None,
    rate: o.Rate = None,
    pixel_format: o.PixelFormat = None,
    input_size: o.InputSize = None,
    reconnect: o.Reconnect = None,
    timeout: o.Timeout = None,
) -> int:
    """Show SOURCE in a browser: picture, traces, events, thresholds that can be changed while it runs.

    A recording or a saved trace is replayed, with scrubbing. Ctrl-C ends it. Away from 127.0.0.1 a token is needed; the
    link with it is shown once, here.
    """
    from ..dashboard.live_settings import LiveSettings
    from ..dashboard.server import Site
    from ..frames.selection import Selection
    from ..model.scaling import scaled
    from ..report.trace_file import TRACE_SUFFIXES
    from ..runtime.opening import open as open_frames
    from ..runtime.yaw import read_yaw
    from .destinations import check_files
    from .live import live_options, require_live
    from .settings import choose

    def site(board: Board) -> Site:
        return Site(
            board, partial(_toml, preset=chosen.preset), host=host, port=port, token=token,
            also_known_as=allow_host or (),
        )  # fmt: skip

    if is_robot(source):
        refuse_others(context, source, OF_A_ROBOT)
    chosen = choose(preset, neurons, config, settings or (), sensitivity)
    hooks = make_hooks(hook or (), hook_rate)
    if is_robot(source):
        line = port_of(source)
        check_files(hook_files(hooks), {"source": line.path})
        selection = Selection(start_s=start, end_s=end, stride=stride, max_frames=max_frames)
        with open_robot(line, selection, reconnect, timeout) as robot:
            return _watch_robot(robot, hooks, hook_rate, site, json)
    if Path(source).suffix.lower() in TRACE_SUFFIXES:
        _refuse_hooks(hooks, source)
        return _show_trace(Path(source), site, json)
    view = o.view(size, fit, roi, mask, flip, rotate)
    params = scaled(chosen.params, view["size"][0]) if scale_kernels else chosen.params
    turns = None if yaw is None else read_yaw(yaw)

    def opened(start_s: float | None, most: int | None) -> FrameSource:
        return open_frames(
            source, **view, start_s=start_s, end_s=end, stride=stride, max_frames=most, rate_hz=rate,
            pixel_format=pixel_format,
            input_size=None if input_size is None else o.parse_size(input_size, "--input-size"),
            **live_options(reconnect, timeout),
        )  # fmt: skip

    read = {"source": source, "mask": mask, "yaw file": yaw, "settings file": config}
    check_files(hook_files(hooks), read)
    live = LiveSettings(params, chosen.preset)
    with opened(start, max_frames) as frames:
        require_live(frames, reconnect=reconnect, timeout=timeout)
        if turns is not None and frames.live:
            raise ParameterError(f"--yaw {yaw}: {frames.name} is live: must be a recording, whose times are known")
        if frames.live or source == "-":
            return _watch(frames, live, engine, turns, hooks, hook_rate, site, json)
        _refuse_hooks(hooks, frames.name)
        return _replay(frames, lambda start_s: opened(start_s, None), live, engine, turns, site, json)


def _watch(
    frames: FrameSource, settings: LiveSettings, engine: str, turns: YawRecord | None, hooks: list[Hook],
    hook_rate: float | None, make: Callable[[Board], Site], json: bool,
) -> int:  # fmt: skip
    """Run the live loop with the page as one of its outputs."""
    from ..dashboard.about import about_run
    from ..dashboard.board import Board
    from ..dashboard.live_sink import LiveSink
    from ..dashboard.rows import Rows
    from ..dashboard.tunable_network import TunableNetwork
    from ..runtime.header import run_header
    from ..runtime.loop import run as run_loop
    from ..runtime.ndjson import NdjsonSink
    from ..runtime.outputs import Outputs
    from .live import listeners
    from .narrator import Narrator
    from .progress import say

    board: Board
    network = TunableNetwork(
        settings, engine=engine, wanted=lambda: board.wanted_maps, on_change=partial(_tell_change, json)
    )
    header = run_header(frames, settings.params, preset=settings.preset, engine=network.engine)
    board = Board(about_run("live", header, settings), Rows(keep=KEPT_ROWS), settings=settings)
    with make(board) as site:
        _announce(site, "live", frames.name, json)
        for note in frames.notes:
            say(f"lobula: {note}")
        reader: Sink = NdjsonSink(sys.stdout) if json else Narrator(say)
        sinks = [LiveSink(board, frames, network), *with_hooks(reader, hooks, hook_rate, also=board.add_event)]
        outputs = Outputs(sinks, lambda text: say(f"lobula: {text}"))
        rate = None if turns is None else turns.at
        outcome = run_loop(frames, network, outputs, header, yaw_rate_deg_s=rate, listeners=listeners(frames))
        if outcome.message:
            say(f"lobula: {outcome.message}")
        return outcome.exit_code


def _watch_robot(
    robot: RobotStream, hooks: list[Hook], hook_rate: float | None, make: Callable[[Board], Site], json: bool
) -> int:
    """Show what a robot decides, with nothing to change."""
    from ..dashboard.about import about_run
    from ..dashboard.board import Board
    from ..dashboard.robot_sink import RobotSink
    from ..dashboard.rows import Rows
    from ..runtime.header import robot_header
    from ..runtime.ndjson import NdjsonSink
    from ..runtime.outputs import Outputs
    from ..runtime.robot_watch import follow_robot
    from .live import listeners
    from .narrator import Narrator
    from .progress import say

    header = robot_header(robot)
    board = Board(about_run("robot", header, None), Rows(keep=KEPT_ROWS))
    with make(board) as site:
        _announce(site, "robot", robot.name, json)
        reader: Sink = NdjsonSink(sys.stdout) if json else Narrator(say)
        sinks = [RobotSink(board, robot), *with_hooks(reader, hooks, hook_rate, also=board.add_event)]
        outputs = Outputs(sinks, lambda text: say(f"lobula: {text}"))
        outcome = follow_robot(robot, outputs, header, listeners=listeners(robot))
        for note in (*robot.notes, outcome.message):
            if note:
                say(f"lobula: {note}")
        return outcome.exit_code


def _replay(
    frames: FrameSource, open_at: Callable[[float], FrameSource], settings: LiveSettings, engine: str,
    turns: YawRecord | None, make: Callable[[Board], Site], json: bool,
) -> int:  # fmt: skip
    """Analyse a recording, and again whenever a setting changes."""
    from ..dashboard.about import about_run
    from ..dashboard.analysis import Analysis
    from ..dashboard.board import Board
    from ..dashboard.recorded_scenes import RecordedScenes
    from ..dashboard.recording import Recording
    from ..dashboard.replay import Replay
    from ..dashboard.rows import Rows
    from ..engine.network import chosen_engine
    from ..runtime.header import run_header
    from .progress import say

    with closing(Recording(frames, open_at)) as recording:
        recording.block(0)  # a recording that gives no picture is refused before anything is announced
        analysis = Analysis(recording, engine=engine, yaw_rate_deg_s=None if turns is None else turns.at)
        header = run_header(frames, settings.params, preset=settings.preset, engine=chosen_engine(engine))
        with closing(RecordedScenes(analysis)) as scenes:
            board = Board(about_run("recording", header, settings), Rows(), settings=settings, scenes=scenes)
            with make(board) as site:
                _announce(site, "recording", frames.name, json)
                tell = partial(_tell_change, json)
                Replay(analysis, settings, board, tell, lambda text: say(f"lobula: {text}")).work()
    return 0


def _show_trace(path: Path, make: Callable[[Board], Site], json: bool) -> int:
    """Show a saved trace until the program is stopped."""
    import threading

    from ..dashboard.about import board_of_trace
    from ..report.trace_file import read_about, read_trace

    trace = read_trace(path)
    if len(trace) == 0:
        raise ParameterError(f"trace {path}: has no rows: nothing to show")
    with make(board_of_trace(trace, read_about(path), path.name)) as site:
        _announce(site, "trace", str(path), json)
        threading.Event().wait()
    return 0


def _refuse_hooks(hooks: list[Hook], name: str) -> None:
    if hooks:
        raise ParameterError(
            f"--hook {hooks[0].name}: {name} is replayed: must be a camera, an address or a pipe; "
            "lobula run has hooks for recordings"
        )


def _announce(site: Site, mode: str, name: str, json: bool) -> None:
    """Say where the page is; the token goes to people only, and only here."""
    from .progress import say

    if json:
        _print_record({"type": "serving", "mode": mode, "source": name, "url": site.url})
    say(f"lobula: {name} is shown at {site.link}")
    say("lobula: Ctrl-C ends it")


def _tell_change(json: bool, before: NetworkParams, after: NetworkParams) -> None:
    """Say which settings changed; called by the main thread."""
    from ..dashboard.live_settings import changes
    from ..params import settings_hash
    from .progress import say

    changed = changes(before, after)
    if json:
        now: dict[str, Any] = {path: value for path, (_, value) in changed.items()}
        _print_record({"type": "settings", "changed": now, "settings_hash": settings_hash(after)})
        return
    for path, (was, value) in changed.items():
        say(f"settings: {path} = {value} (was {was})")


def _print_record(record: dict[str, Any]) -> None:
    import json

    print(json.dumps(record, separators=(",", ":"), allow_nan=False), flush=True)


def _toml(params: NetworkParams, preset: str) -> str:
    from ..runtime.header import setting_rows
    from .settings_file import settings_toml

    return settings_toml(setting_rows(params), preset)
