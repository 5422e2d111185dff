"""What kind of source the user named, and the reader for it."""

from __future__ import annotations

import glob
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..errors import FrameSourceError, ParameterError
from .array import ArrayReader, open_npz
from .interruptible import interruptible
from .source import Reader

Kind = Literal["file", "folder", "pattern", "pipe", "camera", "address", "array", "bag", "file of arrays"]

_TAKES: dict[Kind, tuple[str, ...]] = {
    "file": ("rate_hz",),
    "folder": ("rate_hz",),
    "pattern": ("rate_hz",),
    "pipe": ("rate_hz", "pixel_format", "input_size", "live"),
    "camera": ("rate_hz", "pixel_format", "input_size"),
    "address": (),
    "array": ("rate_hz", "times_s"),
    "bag": ("topic",),
    "file of arrays": ("rate_hz",),
}

BAG_ENDINGS = (".bag", ".db3", ".mcap")
"""Files that are ROS bags, or the storage of one."""

_A: dict[Kind, str] = {kind: f"{'an' if kind in ('address', 'array') else 'a'} {kind}" for kind in _TAKES}


@dataclass(frozen=True, kw_only=True)
class InputOptions:
    """How to read a source; ``lobula.frames.open`` says what each is. Checked when it is made."""

    rate_hz: float | None = None
    times_s: Sequence[float] | NDArray[Any] | None = None
    pixel_format: str | None = None
    topic: str | None = None
    live: bool | None = None
    input_size: tuple[int, int] | None = None
    threads: int = 1
    timeout_s: float = 10.0
    reconnect_s: float = 0.0

    def __post_init__(self) -> None:
        if self.rate_hz is not None and not _positive(self.rate_hz):
            raise ParameterError(f"rate_hz = {self.rate_hz!r}: must be a number of pictures per second above 0")
        if not _positive(self.timeout_s):
            raise ParameterError(f"timeout_s = {self.timeout_s!r}: must be a number of seconds above 0")
        if not (_positive(self.reconnect_s) or self.reconnect_s in (0, math.inf)) or self.reconnect_s is False:
            raise ParameterError(
                f"reconnect_s = {self.reconnect_s!r}: must be a number of seconds of 0 or more; infinity tries for ever"
            )
        if isinstance(self.threads, bool) or not isinstance(self.threads, int) or self.threads < 0:
            raise ParameterError(f"threads = {self.threads!r}: must be a whole number; 0 lets FFmpeg choose")
        size = self.input_size
        whole = isinstance(size, tuple | list) and len(size) == 2 and all(isinstance(v, int) and v > 0 for v in size)
        if size is not None and not whole:
            raise ParameterError(f"input_size = {size!r}: must be (width, height) in pixels")
        if self.rate_hz is not None and self.times_s is not None:
            raise ParameterError("rate_hz and times_s: only one of them may be given")

    def require_belonging(self, kind: Kind, source: object) -> None:
        """Refuse what a source of this kind would not heed.

        Raises
        ------
        ParameterError : such an option is given
        """
        for name in ("rate_hz", "times_s", "pixel_format", "input_size", "topic", "live"):
            if getattr(self, name) is not None and name not in _TAKES[kind]:
                fit = ", ".join(_A[k] for k, names in _TAKES.items() if name in names)
                raise ParameterError(f"{name}: {source} is {_A[kind]}: may be given only for {fit}")


def open_reader(source: Any, options: InputOptions) -> tuple[Reader, bool]:
    """Return a reader of ``source`` and whether it is live.

    Raises
    ------
    ParameterError : no kind of source, or an option that does not belong to its kind
    FrameSourceError : it cannot be opened
    """
    kind, where = kind_of_source(source)
    options.require_belonging(kind, "the source" if kind == "array" else source)
    if kind == "array":
        return _array(source, options), False
    if kind == "address":
        from .camera import open_address

        return interruptible(lambda: open_address(where, options), lambda opened: opened[0].close())
    if kind == "camera":
        from .camera import open_camera

        return interruptible(lambda: open_camera(int(where), options), lambda reader: reader.close()), True
    if kind == "pipe":
        from .pipe import open_pipe

        live = bool(options.live)
        how = options.pixel_format, options.input_size, options.rate_hz, options.threads
        return open_pipe(*how, live=live), live
    return _recorded(kind, where, options), False


def kind_of_source(source: Any) -> tuple[Kind, str]:
    """Return the kind of ``source`` and its path, pattern, number or address as text.

    Raises
    ------
    ParameterError : it is nothing that frames can come from
    FrameSourceError : there is no such file
    """
    if isinstance(source, np.ndarray | list | tuple) or hasattr(source, "images"):
        return "array", ""
    if isinstance(source, int) and not isinstance(source, bool) and source >= 0:
        return "camera", str(source)
    if not isinstance(source, str | PathLike) or not fspath(source):
        kinds = "a file, folder, pattern, '-', camera number, address or array"
        raise ParameterError(f"source {source!r}: must be {kinds}")
    text = str(fspath(source))
    if text == "-":
        return "pipe", text
    if text.startswith("serial:"):
        raise ParameterError(f"source {text}: a robot sends readings, no pictures: only lobula run and serve show them")
    if camera := re.fullmatch(r"(?:/dev/video)?(\d+)", text):
        return "camera", camera[1]
    if "://" in text and not text.startswith("file://"):
        return "address", text
    text = text.removeprefix("file://")
    if Path(text).is_dir():
        return "bag" if _is_bag(Path(text)) else "folder", text
    if Path(text).exists():
        if Path(text).suffix == ".npz":
            return "file of arrays", text
        return "bag" if Path(text).suffix in BAG_ENDINGS else "file", text
    if glob.has_magic(text):
        return "pattern", text
    raise FrameSourceError(f"{text}: no such file or folder")


def _recorded(kind: Kind, where: str, options: InputOptions) -> Reader:
    """Open a source that is not live; PyAV is imported here, when it is needed."""
    if kind == "file of arrays":
        return open_npz(where, options.rate_hz)
    if kind == "bag":
        from .bag import open_bag

        return open_bag(where, options.topic)
    if kind == "file":
        from .video import open_file

        return open_file(where, options.threads, options.rate_hz)
    from .folder import open_folder, open_pattern

    return open_folder(Path(where), options.rate_hz) if kind == "folder" else open_pattern(where, options.rate_hz)


def _is_bag(folder: Path) -> bool:
    """Whether a folder is a ROS 2 bag: what its metadata begins with says so."""
    try:
        with (folder / "metadata.yaml").open("rb") as file:
            return b"rosbag2_bagfile_information" in file.read(4096)
    except OSError:
        return False


def _array(source: Any, options: InputOptions) -> Reader:
    if hasattr(source, "images"):
        times_s = options.times_s if options.times_s is not None else getattr(source, "times_s", None)
        return ArrayReader(source.images, None if options.rate_hz else times_s, options.rate_hz)
    return ArrayReader(source, options.times_s, options.rate_hz)


def _positive(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value) and value > 0
