"""``lobula run``: the main job."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import LobulaError, OutputError, ParameterError
from . import options as o
from .call import new_app
from .hooks import HookRate, HookTargets, hook_files, make_hooks, with_hooks
from .progress import Screen, live_screen, screen
from .robot import is_robot, open_robot, port_of, refuse_others

if TYPE_CHECKING:
    from ..engine.network import Network
    from ..frames import FrameSource
    from ..hooks import Hook
    from ..model.network import NetworkParams
    from ..runtime.robot import RobotStream
    from ..runtime.sinks import Sink
    from ..runtime.yaw import YawRecord

app = new_app()

OF_A_ROBOT = frozenset({
    "source", "json", "trace", "report", "hook", "hook_rate", "start", "end", "stride", "max_frames", "reconnect",
    "timeout",
})  # fmt: skip
"""What can be asked for when the decisions are a robot's."""


@app.command()
def run(
    context: typer.Context,
    source: Annotated[
        str,
        typer.Argument(
            metavar="SOURCE",
            help="video, image folder, pattern, ROS bag, camera number, rtsp:// or http:// address, - for a pipe; or "
            "serial:PORT, a robot that decides by itself",
        ),
    ],
    json: Annotated[bool, typer.Option("--json", help="NDJSON on standard output: header, events, summary")] = False,
    trace: Annotated[
        Path | None, typer.Option(metavar="FILE", help="every frame's reading: .csv, .jsonl, .npz or .parquet")
    ] = None,
    annotate: Annotated[Path | None, typer.Option(metavar="FILE.mp4", help="video with traces and decisions")] = None,
    report: Annotated[Path | None, typer.Option(metavar="DIR", help="a folder with a report page")] = None,
    record: Annotated[Path | None, typer.Option(metavar="FILE.mp4", help="video of the pictures as they are")] = None,
    keep: Annotated[Path | None, typer.Option(metavar="DIR", help="a clip of each alarm, with its trace")] = None,
    keep_before: Annotated[
        float | None, typer.Option(metavar="S", help="a clip's seconds before its alarm; 10 if left out")
    ] = None,
    keep_after: Annotated[
        float | None, typer.Option(metavar="S", help="a clip's seconds after its alarm; 3 if left out")
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
    topic: o.Topic = None,
    live: o.Live = False,
    reconnect: o.Reconnect = None,
    timeout: o.Timeout = None,
) -> int:
    """Watch SOURCE and say when something is going to hit the camera.

    People read standard error. With --json, programs read standard output: a header, one record for each event that
    starts or ends, one summary, whatever happens.
    """
    from ..engine.network import Network
    from ..frames.selection import Selection
    from ..model.scaling import scaled
    from ..runtime.opening import open as open_frames
    from ..runtime.yaw import read_yaw
    from .live import live_options, require_live
    from .settings import choose

    if is_robot(source):
        with _summary_if_refused(json):
            refuse_others(context, source, OF_A_ROBOT)
            hooks = make_hooks(hook or (), hook_rate)
            port = port_of(source)
            _check_outputs(port.path, trace, None, None, report, hooks)
            selection = Selection(start_s=start, end_s=end, stride=stride, max_frames=max_frames)
            files = _file_sinks(trace, None, None, report)
            robot = open_robot(port, selection, reconnect, timeout)
        with robot, live_screen(robot.frame_count, robot.name) as here:
            return _watch_robot(robot, files, hooks, hook_rate, json, here)

    with _summary_if_refused(json):
        chosen = choose(preset, neurons, config, settings or (), sensitivity)
        view = o.view(size, fit, roi, mask, flip, rotate)
        params = scaled(chosen.params, view["size"][0]) if scale_kernels else chosen.params
        network = Network(params, engine=engine)
        turns = None if yaw is None else read_yaw(yaw)
        hooks = make_hooks(hook or (), hook_rate)
        read = {"mask": mask, "yaw file": yaw, "settings file": config}
        _check_outputs(source, trace, annotate, record, report, hooks, read)
        files = _file_sinks(trace, annotate, record, report)
        files += _kept_clips(keep, keep_before, keep_after)
        frames = open_frames(
            source, **view, start_s=start, end_s=end, stride=stride,
            max_frames=max_frames, rate_hz=rate, pixel_format=pixel_format,
            input_size=None if input_size is None else o.parse_size(input_size, "--input-size"),
            topic=topic, live=live or None,
            **live_options(reconnect, timeout),
        )  # fmt: skip
        try:
            require_live(frames, reconnect=reconnect, timeout=timeout)
            if turns is not None and frames.live:
                raise ParameterError(f"--yaw {yaw}: {frames.name} is live: must be a recording, whose times are known")
        except ParameterError:
            frames.close()
            raise
    shown = live_screen if frames.live else screen
    with frames, shown(frames.frame_count, Path(frames.name).name) as here:
        return _watch(frames, params, chosen.preset, network, turns, files, hooks, hook_rate, json, here)


@contextmanager
def _summary_if_refused(json: bool) -> Iterator[None]:
    """Give a reader of records the summary of a run that never began, if what is done here fails."""
    from ..runtime.interrupts import Interrupted
    from ..runtime.ndjson import NdjsonSink, ReaderGoneError
    from ..runtime.tally import unbegun_summary

    try:
        yield
    except (LobulaError, Interrupted) as error:
        if json:
            status = "interrupted" if isinstance(error, Interrupted) else "refused"
            with suppress(ReaderGoneError):
                NdjsonSink(sys.stdout).close(unbegun_summary(status, str(error)))
        if isinstance(error, OutputError):  # a folder that cannot be made: nothing was under way that could fail
            raise ParameterError(str(error)) from error
        raise


def _check_outputs(
    source: str,
    trace: Path | None,
    annotate: Path | None,
    record: Path | None,
    report: Path | None,
    hooks: list[Hook],
    read: Mapping[str, Path | None] | None = None,
) -> None:
    from .destinations import check_files, check_folder

    outputs = {"--trace": trace, "--annotate": annotate, "--record": record} | hook_files(hooks)
    if report is not None:
        check_folder("--report", report)
        outputs |= {"--report": report / "index.html", "the trace of --report": report / "trace.csv"}
    check_files(outputs, {"source": source} | dict(read or {}), made=report)


def _watch(
    frames: FrameSource,
    params: NetworkParams,
    preset: str,
    network: Network,
    turns: YawRecord | None,
    files: list[Sink],
    hooks: list[Hook],
    hook_rate: float | None,
    json: bool,
    here: Screen,
) -> int:
    from ..runtime.header import run_header
    from ..runtime.loop import run as run_loop
    from ..runtime.outputs import Outputs
    from .live import listeners
    from .reader import reader_of

    # last: its summary knows what became of the files and the hooks
    reader = reader_of(frames, json, here.say)
    sinks = [*files, *with_hooks(reader, hooks, hook_rate)]
    header = run_header(frames, params, preset=preset, engine=network.engine)
    told = frames.notes
    for note in told:
        here.say(f"lobula: {note}")
    outputs = Outputs(sinks, lambda text: here.say(f"lobula: {text}"))
    rate = None if turns is None else turns.at
    outcome = run_loop(
        frames,
        network,
        outputs,
        header,
        yaw_rate_deg_s=rate,
        on_frame=here.advance,
        listeners=listeners(frames, here),
    )
    for note in frames.notes[len(told) :]:
        here.say(f"lobula: {note}")
    if outcome.message:
        here.say(f"lobula: {outcome.message}")
    return outcome.exit_code


def _watch_robot(
    robot: RobotStream, files: list[Sink], hooks: list[Hook], hook_rate: float | None, json: bool, here: Screen
) -> int:
    from ..runtime.header import robot_header
    from ..runtime.outputs import Outputs
    from ..runtime.robot_watch import follow_robot
    from .live import listeners
    from .reader import reader_of

    reader = reader_of(robot, json, here.say)
    outputs = Outputs([*files, *with_hooks(reader, hooks, hook_rate)], lambda text: here.say(f"lobula: {text}"))
    told = listeners(robot, here)
    outcome = follow_robot(robot, outputs, robot_header(robot), on_frame=here.advance, listeners=told)
    for note in (*robot.notes, outcome.message):
        if note:
            here.say(f"lobula: {note}")
    return outcome.exit_code


def _file_sinks(trace: Path | None, annotate: Path | None, record: Path | None, report: Path | None) -> list[Sink]:
    """Make the sinks that were asked for; each imports its library here, when it is wanted."""
    sinks: list[Sink] = []
    if trace is not None:
        from ..report.trace import TraceWriter

        sinks.append(TraceWriter(trace))
    if annotate is not None:
        from ..report.video import AnnotatedVideo

        sinks.append(AnnotatedVideo(annotate))
    if record is not None:
        from ..report.recording import Recording

        sinks.append(Recording(record))
    if report is not None:
        from ..report.page import ReportPage

        beside = annotate is not None and annotate.parent.resolve() == report.resolve()
        sinks.append(ReportPage(report, annotate if beside else None))
    return sinks


def _kept_clips(folder: Path | None, before_s: float | None, after_s: float | None) -> list[Sink]:
    from .destinations import check_folder

    spans = {name: value for name, value in (("before", before_s), ("after", after_s)) if value is not None}
    if folder is None:
        for name, value in spans.items():
            raise ParameterError(f"--keep-{name} {value:g}: must have a --keep DIR to go with")
        return []
    from ..report.kept import KeptClips

    check_folder("--keep", folder)
    return [KeptClips(folder, **{f"{name}_s": value for name, value in spans.items()})]
