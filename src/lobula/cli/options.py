"""Options that several verbs share, and the texts such as ``99x72`` that they take."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any

import typer

from ..errors import ParameterError

Source = Annotated[
    str,
    typer.Argument(
        metavar="SOURCE",
        help="video, image folder, pattern, ROS bag, camera number, rtsp:// or http:// address, or - for a pipe",
    ),
]

Json = Annotated[bool, typer.Option("--json", help="records for programs, on standard output")]

Preset = Annotated[str | None, typer.Option(metavar="NAME", help="default, paper, published or lobula")]
Neurons = Annotated[str | None, typer.Option(metavar="all|lgmds|lgmd2", help="who decides")]
Config = Annotated[Path | None, typer.Option(metavar="FILE.toml", help="settings file, see `lobula config init`")]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="PATH=VALUE", help="one setting, such as lamina.dog.sigma_px=2; may be repeated"),
]
Sensitivity = Annotated[float | None, typer.Option(metavar="0..1", help="how readily it alarms; 0.5 is the preset")]
Engine = Annotated[str, typer.Option(metavar="auto|core|reference", help="C core, or the NumPy definition")]
ScaleKernels = Annotated[bool, typer.Option("--scale-kernels", help="grow the kernels with the working size")]

Size = Annotated[str, typer.Option(metavar="WxH", help="working size, width x height")]
Fit = Annotated[str, typer.Option(metavar="crop|squeeze|pad", help="how another shape is brought to it")]
Roi = Annotated[str | None, typer.Option(metavar="X,Y,W,H", help="region of interest, px of the upright picture")]
Mask = Annotated[Path | None, typer.Option(metavar="FILE.png", help="white where the picture counts")]
Flip = Annotated[str | None, typer.Option(metavar="h|v|hv", help="mirror the picture")]
Rotate = Annotated[int, typer.Option(metavar="DEG", help="0, 90, 180 or 270 degrees clockwise")]

Yaw = Annotated[
    Path | None,
    typer.Option(metavar="FILE.csv", help="how the camera itself turns, time_s,yaw_deg_s: no decision meanwhile"),
]

Start = Annotated[float | None, typer.Option(metavar="S", help="first time looked at, s")]
End = Annotated[float | None, typer.Option(metavar="S", help="end of the time looked at, s")]
Stride = Annotated[int, typer.Option(metavar="N", help="every N-th frame")]
MaxFrames = Annotated[int | None, typer.Option(metavar="N", help="at most N frames")]

Rate = Annotated[
    float | None,
    typer.Option(
        metavar="HZ", help="pictures per second of a folder, a raw pipe or a bare stream; a request to a camera"
    ),
]
PixelFormat = Annotated[
    str | None, typer.Option(metavar="NAME", help="raw pipe: gray8, yuv420p, nv12, yuyv422, ...; a request to a camera")
]
InputSize = Annotated[str | None, typer.Option(metavar="WxH", help="raw pipe: size of its pictures; or as above")]
Topic = Annotated[str | None, typer.Option(metavar="/NAME", help="ROS bag: which of its pictures")]

Live = Annotated[bool, typer.Option("--live", help="a pipe's newest picture instead of every one")]
Reconnect = Annotated[
    str | None,
    typer.Option(metavar="forever|never|S", help="how long to try a live source that went away; forever if left out"),
]
Timeout = Annotated[
    float | None, typer.Option(metavar="S", help="silence after which a live source counts as gone; 10 if left out")
]


def view(size: str, fit: str, roi: str | None, mask: Path | None, flip: str | None, rotate: int) -> dict[str, Any]:
    """Return these options as the keywords of ``lobula.open``.

    Raises
    ------
    ParameterError : a size or a region in another form
    """
    return {
        "size": parse_size(size, "--size"),
        "fit": fit,
        "roi": None if roi is None else parse_roi(roi),
        "mask": mask,
        "flip": flip,
        "rotate": rotate,
    }


def parse_size(text: str, option: str) -> tuple[int, int]:
    """Return ``99x72`` as (99, 72).

    Raises
    ------
    ParameterError : another form
    """
    match = re.fullmatch(r"\s*(\d+)\s*[xX]\s*(\d+)\s*", text)
    if match is None:
        raise ParameterError(f"{option} {text!r}: must be WIDTHxHEIGHT, such as 99x72")
    return int(match[1]), int(match[2])


def parse_roi(text: str) -> tuple[int, int, int, int]:
    """Return ``10,20,300,200`` as four numbers.

    Raises
    ------
    ParameterError : another form
    """
    parts = text.split(",")
    if len(parts) != 4 or not all(re.fullmatch(r"\s*\d+\s*", part) for part in parts):
        raise ParameterError(f"--roi {text!r}: must be X,Y,WIDTH,HEIGHT in whole pixels, such as 0,0,320,200")
    x, y, width, height = (int(part) for part in parts)
    return x, y, width, height
