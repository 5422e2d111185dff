"""Who reads what a run has to say: a program, records on standard output; or people, words."""

from __future__ import annotations

import sys

from ..errors import ParameterError
from ..runtime.carried import Carried
from ..runtime.ndjson import NdjsonSink
from ..runtime.sinks import Sink
from ..runtime.sources import Source
from ..runtime.unbuffered import unbuffered
from .narrator import Narrator
from .progress import Say


def reader_of(source: Source, json: bool, say: Say) -> Sink:
    """Return the sink of the run's reader; one that reads slowly holds up a recording, but nothing live.

    Raises
    ------
    ParameterError : records are to be written where there is no standard output
    """
    if not json:
        return Narrator(say)
    if sys.stdout is None:
        raise ParameterError("--json: standard output is closed: must be open")
    if not source.live:
        return NdjsonSink(sys.stdout)
    return Carried(NdjsonSink(unbuffered(sys.stdout)), "standard output")
