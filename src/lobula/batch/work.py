"""The work on one clip, the same in every process and on every machine: look whether it was done, else do it."""

from __future__ import annotations

import hashlib
import os
import time
import traceback
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from .._version import __version__
from ..engine.network import Network
from ..errors import LobulaError, MissingExtraError, OutputError, ParameterError
from ..landing import land, writing
from ..report.trace import TraceWriter
from ..runtime.header import run_header
from ..runtime.interrupts import Interrupted
from ..runtime.loop import run as run_loop
from ..runtime.ndjson import NdjsonSink
from ..runtime.opening import open as open_frames
from ..runtime.outputs import Outputs
from ..runtime.sinks import Sink
from ..source_hash import source_hash
from .alarms import Alarms
from .claim import claimed
from .clips import Clip
from .content import Contents, files_of, stamp
from .manifest import Manifest
from .places import contents_path, work_folder
from .request import CODE_PARTS, EVENTS, VIDEO, Request
from .row import Row, now

_LONGEST_STEM = 120
"""Bytes of a clip's name that its outputs carry: file systems take 255 in all."""


@dataclass(frozen=True)
class Answer:
    """What became of a clip: its row and whether it was done just now; no row while somebody else is at it."""

    row: Row | None
    fresh: bool = False


class Desk:
    """Does one clip after the other for ``request``; what costs time to make is made once.

    Raises
    ------
    ParameterError : the code here is not the code that the request was made by
    OutputError : the output folder is not there, as on a machine that does not share it
    """

    def __init__(self, request: Request) -> None:
        code = source_hash(*CODE_PARTS)
        if code != request.code:
            raise ParameterError(f"a worker has other code of lobula ({code}, not {request.code}): must be the same")
        if not work_folder(request.out).is_dir():
            raise OutputError(f"{request.out}: is not there for a worker: must be a folder that all of them share")
        self._request = request
        self._manifest = Manifest(request.out)
        self._contents = Contents(contents_path(request.out))
        self._network = Network(request.params, engine=request.engine)

    def do(self, clip: Clip) -> Answer:
        """Return what became of ``clip``; a clip that fails is an answer too.

        Raises
        ------
        OutputError : something cannot be written; nothing of this clip is kept
        Interrupted : a signal came; likewise
        """
        begun_s = time.perf_counter()
        try:
            if clip.problem:
                raise ParameterError(clip.problem)
            content = self._contents.of(clip.path)
        except OutputError:
            raise
        except LobulaError as error:
            return self._failed(clip, error, begun_s)
        request = self._request
        key = (content, request.settings, request.code)
        with claimed(work_folder(request.out), hashlib.sha256("".join(key).encode()).hexdigest()[:24]) as scratch:
            if scratch is None:
                return Answer(None)
            row = self._manifest.find(key, request.outputs)
            if row is not None:
                return Answer(replace(row, file=clip.name))
            try:
                before = stamp(clip.path, files_of(clip.path))
                row = self._run(clip, content, scratch)
                if stamp(clip.path, files_of(clip.path)) != before:
                    raise ParameterError("was changed while it was read: must be left alone; the next run takes it up")
                row = self._landed(row, scratch, clip)
            except (OutputError, MissingExtraError):
                raise
            except Exception as error:  # of this clip: the others go on
                return self._failed(clip, error, begun_s, content)
            row = replace(row, seconds=_since(begun_s), date=now())
            self._manifest.add(row)
            return Answer(row, fresh=True)

    def _run(self, clip: Clip, content: str, scratch: Path) -> Row:
        """Look at every frame; the outputs lie in ``scratch``, each under its ending."""
        request, alarms = self._request, Alarms()
        sinks: list[Sink] = [alarms]
        if request.trace:
            sinks.append(TraceWriter(scratch / f"trace{request.trace}"))
        if request.annotate:
            from ..report.video import AnnotatedVideo

            sinks.append(AnnotatedVideo(scratch / f"annotated{VIDEO}"))
        with ExitStack() as opened:
            events = scratch / f"run{EVENTS}"
            with writing(events):
                sinks.append(NdjsonSink(opened.enter_context(events.open("w", encoding="utf-8")), str(events)))
            frames = opened.enter_context(open_frames(clip.path, **request.open_with))
            header = run_header(frames, request.params, preset=request.preset, engine=request.engine)
            self._network.reset()
            outputs = Outputs(sinks, lambda text: None)
            outcome = run_loop(frames, self._network, outputs, header | {"source": clip.name})
        if outputs.failures:
            raise OutputError(outputs.failures[0].split("; ")[0])
        if outcome.summary["status"] == "interrupted":
            raise Interrupted(outcome.exit_code - 128)
        found = outcome.summary
        return Row(
            file=clip.name, status="ok" if found["status"] == "ok" else "failed", frames=found["frames"],
            damaged=found["damaged"], duration_s=found["duration_s"], collisions=found["collisions"],
            alarms_s=tuple(alarms.starts_s), content=content, settings=request.settings, code=request.code,
            version=__version__, problem=_reason(outcome.message or "", clip),
            notes=tuple(_reason(note, clip) for note in found.get("notes", ())),
        )  # fmt: skip

    def _landed(self, row: Row, scratch: Path, clip: Clip) -> Row:
        """Give the outputs their names and return the row that tells them."""
        if not row.frames:
            return row
        trace = self._request.trace or ""
        made = {"events": (f"run{EVENTS}", EVENTS), "trace": (f"trace{trace}", trace),
                "annotated": (f"annotated{VIDEO}", VIDEO)}  # fmt: skip
        names: dict[str, Any] = {}
        for what, (temporary, ending) in made.items():
            if (scratch / temporary).is_file():
                names[what] = f"{row.settings}/{_stem(clip.path)}-{row.content[:12]}{ending}"
                land(scratch / temporary, self._request.out / names[what])
        return replace(row, **names)

    def _failed(self, clip: Clip, error: Exception, begun_s: float, content: str = "") -> Answer:
        """Return the answer of a clip that cannot be looked at; it is in the manifest too."""
        problem = _reason(str(error), clip) if isinstance(error, LobulaError) else _fault(error)
        row = Row(
            file=clip.name, status="failed", seconds=_since(begun_s), content=content, settings=self._request.settings,
            code=self._request.code, version=__version__, date=now(), problem=problem,
        )  # fmt: skip
        self._manifest.add(row)
        return Answer(row, fresh=True)


def _reason(message: str, clip: Clip) -> str:
    """A message about the clip without its path, which differs from machine to machine; its name stands beside."""
    return message.removeprefix(f"{clip.path}: ")


def _fault(error: Exception) -> str:
    where = traceback.extract_tb(error.__traceback__)[-1]
    return f"a fault of lobula's own, please report it: {error!r} in {Path(where.filename).name}, line {where.lineno}"


def _stem(path: Path) -> str:
    """The name of a clip as its outputs carry it: printable, and not too long."""
    text = os.fsencode(path.stem)[:_LONGEST_STEM].decode("utf-8", "ignore")
    return "".join(c if c.isprintable() else "_" for c in text)


def _since(begun_s: float) -> float:
    return round(time.perf_counter() - begun_s, 3)
