"""``lobula serve``: the live page."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import ParameterError
from . import options as o
from .call import new_app
from .hooks import HookRate, HookTargets, hook_files, make_hooks
from .robot import is_robot, open_robot, port_of, refuse_others
from .serving import replay, show_trace, watch, watch_robot

if TYPE_CHECKING:
    from ..dashboard.board import Board
    from ..dashboard.server import Site
    from ..frames import FrameSource
    from ..hooks import Hook
    from ..model.network import NetworkParams

app = new_app()

OF_A_ROBOT = frozenset({
    "source", "json", "host", "port", "token", "allow_host", "hook", "hook_rate", "start", "end", "stride",
    "max_frames", "reconnect", "timeout",
})  # fmt: skip
"""What can be asked for when the decisions are a robot's."""

PORT = 8040


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
        typer.Option(
            metavar="NAME",
            help="another name the page is reached by, as behind a proxy: needs a token; may be repeated",
        ),
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

    A recording or a saved trace is replayed, with scrubbing. Ctrl-C ends it. Away from
    127.0.0.1, and with --allow-host, a token is needed; the link with it is shown once, here.
    """
    from ..dashboard.live_settings import LiveSettings
    from ..dashboard.server import Site
    from ..frames.array import holds_images
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
            return watch_robot(robot, hooks, hook_rate, site, json)
    if Path(source).suffix.lower() in TRACE_SUFFIXES and not holds_images(Path(source)):
        _refuse_hooks(hooks, source)
        return show_trace(Path(source), site, json)
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
            return watch(frames, live, engine, turns, hooks, hook_rate, site, json)
        _refuse_hooks(hooks, frames.name)
        return replay(frames, lambda start_s: opened(start_s, None), live, engine, turns, site, json)


def _refuse_hooks(hooks: list[Hook], name: str) -> None:
    if hooks:
        raise ParameterError(
            f"--hook {hooks[0].name}: {name} is replayed: must be a camera, an address or a pipe; "
            "lobula run has hooks for recordings"
        )


def _toml(params: NetworkParams, preset: str) -> str:
    from ..runtime.header import setting_rows
    from .settings_file import settings_toml

    return settings_toml(setting_rows(params), preset)
