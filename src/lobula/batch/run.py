"""A whole batch: every clip once, and a table and a summary at the end, whatever that end is."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import Protocol, Self

from .._version import __version__
from ..errors import OutputError
from ..runtime.interrupts import Interrupted
from .claim import sweep
from .clips import Clip
from .content import files_of
from .crew import Outcome
from .lines import Lines
from .manifest import Manifest
from .places import manifest_path, work_folder
from .request import Request, write_settings
from .row import Row, now, row_of
from .summary import Summary, summarise, write_table
from .work import Answer

_AGAIN_S = 0.2  # between two looks at a clip that another run has in hand


class Hands(Protocol):
    """Who does the work: processes, or a cluster. A context; ``workers`` is how many there are."""

    workers: int

    def __enter__(self) -> Self:
        """Make ready."""

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Let go of them; what they are at is left undone."""

    def each(self, clips: Iterable[Clip]) -> Iterator[tuple[Clip, Outcome]]:
        """Yield each clip and what became of it, as they are finished."""


@dataclass(frozen=True)
class Ended:
    """How a batch ended.

    rows : of every clip, in the order of the clips
    stop : the signal, or the output that failed, that ended it before all were done; None
    """

    rows: tuple[Row, ...]
    summary: Summary
    stop: Interrupted | OutputError | None


def run_batch(
    clips: Sequence[Clip], request: Request, hands: Hands, tell: Callable[[Row], None] = lambda row: None
) -> Ended:
    """Do what is not done yet of ``clips`` and return how it ended; ``tell`` is called with each row as it comes.

    A clip with the same content, settings and code as one that is in the manifest is done already, also where another
    run in the same folder did it a moment ago; what another run has in hand is waited for.

    Raises
    ------
    OutputError : the output folder cannot be written into at all
    ParameterError : no cluster at the address, or a worker with other code; what was finished by then is kept
    """
    begun_s = time.monotonic()
    write_settings(request)
    sweep(work_folder(request.out))
    log = Lines(manifest_path(request.out))
    log.new()
    found, fresh = dict[Clip, Row](), list[Row]()
    stop: Interrupted | OutputError | None = None
    try:
        with hands:
            for clip, row, is_fresh in _done(clips, request, hands):
                found[clip] = row
                fresh += [row] if is_fresh else []
                tell(row)
    except (Interrupted, OutputError) as error:
        stop = error
        late = _on_their_way([clip for clip in clips if clip not in found], log, request)
        found |= late
        fresh += late.values()
    rows = tuple(found.get(clip) or _unfinished(clip, request) for clip in clips)
    seconds = time.monotonic() - begun_s
    summary = summarise(rows, fresh, request, workers=hands.workers, seconds=seconds, stop=stop)
    try:
        sweep(work_folder(request.out))
        write_table(rows, summary, request.out)
    except OutputError as error:
        stop = stop or error
    return Ended(rows, summary, stop)


def _done(clips: Sequence[Clip], request: Request, hands: Hands) -> Iterator[tuple[Clip, Row, bool]]:
    """Yield each clip, its row and whether it was done just now; what somebody else is at is asked about again."""
    left = sorted(clips, key=_size, reverse=True)  # so that all workers end together
    while left:
        busy = []
        for clip, outcome in hands.each(left):
            answer = outcome if isinstance(outcome, Answer) else _killed(clip, outcome, request)
            if answer.row is None:
                busy.append(clip)
            else:
                yield clip, answer.row, answer.fresh
        if len(busy) == len(left):
            time.sleep(_AGAIN_S)
        left = busy


def _killed(clip: Clip, problem: str, request: Request) -> Answer:
    """The answer of a clip that nobody came back from; the manifest is told in their place."""
    row = Row(
        file=clip.name, status="failed", settings=request.settings, code=request.code, version=__version__,
        date=now(), problem=problem,
    )  # fmt: skip
    Manifest(request.out).add(row)
    return Answer(row, fresh=True)


def _on_their_way(clips: Iterable[Clip], log: Lines, request: Request) -> dict[Clip, Row]:
    """Return those of ``clips`` that were finished when the batch was stopped, but whose answer had not come."""
    rows = {row.file: row for row in map(row_of, log.new()) if row is not None}
    asked = (request.settings, request.code)
    return {clip: rows[clip.name] for clip in clips if clip.name in rows and rows[clip.name].key[1:] == asked}


def _unfinished(clip: Clip, request: Request) -> Row:
    return Row(file=clip.name, status="unfinished", settings=request.settings, code=request.code)


def _size(clip: Clip) -> int:
    """Bytes of a clip; of one that cannot be read 0, which is as long as it will take."""
    try:
        return sum(file.stat().st_size for file in files_of(clip.path))
    except OSError:
        return 0
