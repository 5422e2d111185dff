"""What a batch is asked to do with every clip, and the hash by which that is known again."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ..engine.network import chosen_engine
from ..errors import FrameSourceError, ParameterError
from ..frames.geometry import View
from ..frames.inputs import InputOptions
from ..frames.selection import Selection
from ..landing import whole_file, writing
from ..model.network import NetworkParams
from ..params import settings_hash, to_dict
from ..source_hash import source_hash
from .content import sha256
from .places import make_places, settings_path

CODE_PARTS = ("engine", "frames", "model", "runtime")
"""Folders of the package on which the numbers depend."""

EVENTS, VIDEO = ".events.ndjson", ".mp4"
TRACES = (".csv", ".npz", ".parquet")
"""Endings of the outputs."""

_VIEW = ("size", "fit", "roi", "mask", "flip", "rotate")
_SELECTION = ("start_s", "end_s", "stride", "max_frames")


@dataclass(frozen=True, kw_only=True)
class Request:
    """All that is the same for every clip of a batch. Checked when it is made by ``make_request``.

    out : the folder that is written into, absolute
    engine : ``core`` or ``reference``
    open_with : keywords of ``lobula.open``
    trace : ending of the trace, or None
    settings : hash of the network's settings, the engine and ``open_with``; a mask counts by its content
    code : hash of the code
    """

    out: Path
    params: NetworkParams
    preset: str
    engine: str
    open_with: Mapping[str, Any]
    trace: str | None
    annotate: bool
    settings: str
    code: str

    @property
    def outputs(self) -> tuple[str, ...]:
        """The endings of the files that are wanted of each clip."""
        return (EVENTS, *([self.trace] if self.trace else []), *([VIDEO] if self.annotate else []))


def make_request(
    out: Path,
    params: NetworkParams,
    *,
    preset: str,
    engine: str = "auto",
    trace: str | None = ".csv",
    annotate: bool = False,
    **open_with: Any,
) -> Request:
    """Return a checked request.

    Raises
    ------
    ParameterError : an option that no clip could be opened with, an unknown ending or engine
    FrameSourceError : the mask cannot be read
    MissingExtraError : .parquet without pyarrow
    OutputError : a video is wanted and there is no encoder
    """
    _check_outputs(trace, annotate)
    made_by = chosen_engine(engine)
    settings = _hash(_document(params, made_by, open_with))
    if open_with.get("mask") is not None:
        open_with["mask"] = Path(open_with["mask"]).absolute()
    return Request(
        out=out.absolute(), params=params, preset=preset, engine=made_by, open_with=open_with, trace=trace,
        annotate=annotate, settings=settings, code=source_hash(*CODE_PARTS),
    )  # fmt: skip


def write_settings(request: Request) -> None:
    """Write all settings of ``request`` into its folder, where the outputs go.

    Raises
    ------
    OutputError : it cannot be written
    """
    path = settings_path(request.out, request.settings)
    whole = {
        "settings": request.settings,
        "settings_hash": settings_hash(request.params),
        "preset": request.preset,
        **_document(request.params, request.engine, request.open_with),
    }
    with writing(path):
        make_places(request.out)
        path.parent.mkdir(exist_ok=True)
    with whole_file(path) as temporary:
        temporary.write_text(json.dumps(whole, indent=2) + "\n", encoding="utf-8")


def _document(params: NetworkParams, engine: str, open_with: Mapping[str, Any]) -> dict[str, Any]:
    """Everything that the numbers depend on but the clip and the code; what was left out as it is then."""
    unknown = open_with.keys() - {*_VIEW, *_SELECTION, "rate_hz"}
    if unknown:
        raise ParameterError(
            f"{', '.join(sorted(unknown))}: not an option for every clip: must be one of "
            f"{', '.join((*_VIEW, *_SELECTION, 'rate_hz'))}"
        )
    view = View(**{name: value for name, value in open_with.items() if name in _VIEW})
    selection = Selection(**{name: value for name, value in open_with.items() if name in _SELECTION})
    rate_hz = InputOptions(rate_hz=open_with.get("rate_hz")).rate_hz
    opened = {**asdict(view), **asdict(selection), "rate_hz": rate_hz}
    if view.mask is not None:
        opened["mask"] = _mask_content(Path(str(view.mask)))
    return {"engine": engine, "open": opened, "network": to_dict(params)}


def _mask_content(mask: Path) -> str:
    try:
        return sha256(mask)
    except OSError as error:
        reason = "no such file" if isinstance(error, FileNotFoundError) else error.strerror
        raise FrameSourceError(f"mask {mask}: {reason}") from error


def _hash(document: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()[:12]


def _check_outputs(trace: str | None, annotate: bool) -> None:
    """See before the work, not at the first clip, that the outputs can be made."""
    if trace is not None and trace not in TRACES:
        raise ParameterError(f"trace {trace!r}: must be one of {', '.join(TRACES)}, or none")
    if trace is not None:
        from ..report.trace import TraceWriter

        TraceWriter(f"trace{trace}")
    if annotate:
        from ..report.video import AnnotatedVideo

        AnnotatedVideo(f"annotated{VIDEO}")
