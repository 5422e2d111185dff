"""The four ways in which ``lobula serve`` shows a source: a camera, a robot, a recording and a saved trace."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import closing, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import ParameterError
from .hooks import with_hooks

if TYPE_CHECKING:
    from ..dashboard.board import Board
    from ..dashboard.live_settings import LiveSettings
    from ..dashboard.server import Site
    from ..frames import FrameSource
    from ..hooks import Hook
    from ..model.network import NetworkParams
    from ..runtime.robot import RobotStream
    from ..runtime.yaw import YawRecord
    from .progress import Say

KEPT_ROWS = 4096
"""Readings of a live run that a page opened later still gets: two minutes at 30 Hz."""


def watch(
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
    from ..runtime.outputs import Outputs
    from .live import listeners
    from .progress import live_words
    from .reader import reader_of

    board: Board
    with live_words() as tell:
        reader = reader_of(frames, json, tell)
        changed = partial(_tell_change, reader.event if json else None, tell)
        network = TunableNetwork(settings, engine=engine, wanted=lambda: board.wanted_maps, on_change=changed)
        header = run_header(frames, settings.params, preset=settings.preset, engine=network.engine)
        board = Board(about_run("live", header, settings), Rows(keep=KEPT_ROWS), settings=settings)
        with make(board) as site:
            _announce(site, "live", frames.name, json)
            for note in frames.notes:
                tell(f"lobula: {note}")
            sinks = [LiveSink(board, frames, network), *with_hooks(reader, hooks, hook_rate, also=board.add_event)]
            outputs = Outputs(sinks, lambda text: tell(f"lobula: {text}"))
            rate = None if turns is None else turns.at
            outcome = run_loop(frames, network, outputs, header, yaw_rate_deg_s=rate, listeners=listeners(frames))
            if outcome.message:
                tell(f"lobula: {outcome.message}")
            return outcome.exit_code


def watch_robot(
    robot: RobotStream, hooks: list[Hook], hook_rate: float | None, make: Callable[[Board], Site], json: bool
) -> int:
    """Show what a robot decides, with nothing to change."""
    from ..dashboard.about import about_run
    from ..dashboard.board import Board
    from ..dashboard.robot_sink import RobotSink
    from ..dashboard.rows import Rows
    from ..runtime.header import robot_header
    from ..runtime.outputs import Outputs
    from ..runtime.robot_watch import follow_robot
    from .live import listeners
    from .progress import live_words
    from .reader import reader_of

    header = robot_header(robot)
    board = Board(about_run("robot", header, None), Rows(keep=KEPT_ROWS))
    with make(board) as site, live_words() as tell:
        _announce(site, "robot", robot.name, json)
        reader = reader_of(robot, json, tell)
        sinks = [RobotSink(board, robot), *with_hooks(reader, hooks, hook_rate, also=board.add_event)]
        outputs = Outputs(sinks, lambda text: tell(f"lobula: {text}"))
        outcome = follow_robot(robot, outputs, header, listeners=listeners(robot))
        for note in (*robot.notes, outcome.message):
            if note:
                tell(f"lobula: {note}")
        return outcome.exit_code


def replay(
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
                tell = partial(_tell_change, _print_record if json else None, say)
                Replay(analysis, settings, board, tell, lambda text: say(f"lobula: {text}")).work()
    return 0


def show_trace(path: Path, make: Callable[[Board], Site], json: bool) -> int:
    """Show a saved trace until the program is stopped."""
    import threading

    from ..dashboard.about import board_of_trace
    from ..report.trace_file import read_about, read_trace

    trace = read_trace(path)
    if len(trace) == 0:
        raise ParameterError(f"trace {path}: has no rows: nothing to show")
    with make(board_of_trace(trace, read_about(path), str(path))) as site:
        _announce(site, "trace", str(path), json)
        threading.Event().wait()
    return 0


def _announce(site: Site, mode: str, name: str, json: bool) -> None:
    """Say where the page is; the token goes to people only, and only here."""
    from .progress import say

    if json:
        _print_record({"type": "serving", "mode": mode, "source": name, "url": site.url})
    say(f"lobula: {name} is shown at {site.link}")
    say("lobula: Ctrl-C ends it")


def _tell_change(
    to_program: Callable[[Mapping[str, Any]], None] | None, tell: Say, before: NetworkParams, after: NetworkParams
) -> None:
    """Say which settings changed; called by the thread of the detector, which a reader that has gone does not end."""
    from ..dashboard.live_settings import changes
    from ..params import settings_hash

    changed = changes(before, after)
    if to_program is not None:
        now: dict[str, Any] = {path: value for path, (_, value) in changed.items()}
        with suppress(OSError):
            to_program({"type": "settings", "changed": now, "settings_hash": settings_hash(after)})
        return
    for path, (was, value) in changed.items():
        tell(f"settings: {path} = {value} (was {was})")


def _print_record(record: Mapping[str, Any]) -> None:
    import json

    print(json.dumps(record, separators=(",", ":"), allow_nan=False), flush=True)
