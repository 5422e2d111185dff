"""The report of a run: a folder with one page that needs nothing else, and the trace beside it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import OutputError
from ..frames.jpeg import Jpeg
from ..landing import whole_file, writing
from ..runtime.sinks import Picture
from ..types import Reading
from .page_html import Event, Report, page_html
from .trace import TraceWriter
from .trace_file import read_trace

MAX_THUMBNAILS = 100
"""Events that get a picture, the first ones: keeps the page of a bad night small enough to open."""

THUMBNAIL_PX = 320


class ReportPage:
    """Writes ``folder/index.html`` at the end of a run and ``folder/trace.csv`` during it.

    Parameters
    ----------
    folder : made at once if it is not there, so that other outputs can go into it
    video : an annotated video; the page shows it if it lies in the same folder and is finished when the page is
        written, so give its sink to the runtime before this one

    Raises
    ------
    OutputError : the folder cannot be made
    """

    def __init__(self, folder: str | Path, video: str | Path | None = None) -> None:
        self.folder = Path(folder)
        self.path = self.folder / "index.html"
        with writing(self.folder):
            self.folder.mkdir(parents=True, exist_ok=True)
        beside = video is not None and Path(video).parent.resolve() == self.folder.resolve()
        self._video = Path(video) if video is not None and beside else None
        self._trace = TraceWriter(self.folder / "trace.csv")
        self._header: Mapping[str, Any] = {}
        self._events: list[Event] = []
        self._started = False
        self._waiting: list[Event] = []  # events whose frame has not come yet
        self._newest: tuple[int, Picture | None] = (-1, None)
        self._jpeg = Jpeg(THUMBNAIL_PX)

    def open(self, header: Mapping[str, Any]) -> None:
        """Start the trace."""
        self._header = header
        self._trace.open(header)
        self._started = True

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Write the reading to the trace; keep the picture if an event starts here."""
        self._trace.frame(index, reading, picture)
        self._newest = (index, picture)
        waiting, self._waiting = self._waiting, []
        for event in waiting:
            self._illustrate(event)

    def event(self, record: Mapping[str, Any]) -> None:
        """Start an event, or end the one that it names; what became of the source shows as the state ``stale``."""
        if record["type"] not in ("collision", "state"):
            return
        name = "collision" if record["type"] == "collision" else str(record["state"])
        if record["phase"] == "start":
            event = Event(name, record.get("id"), int(record["frame"]), float(record["time_s"]), dict(record))
            self._events.append(event)
            self._illustrate(event)
            return
        for event in reversed(self._events):
            if (event.name, event.number, event.end_s) == (name, record.get("id"), None):
                event.end_s = float(record["time_s"])
                event.facts.update({key: record[key] for key in ("peak_frame",) if key in record})
                return

    def close(self, summary: Mapping[str, Any]) -> None:
        """Close the trace and write the page from it."""
        if not self._started:
            return
        failure: OutputError | None = None
        try:
            self._trace.close(summary)
        except OutputError as error:  # the page can still be made from the rows that are there
            failure = error
        video = self._video.name if self._video and self._video.is_file() else None
        trace = read_trace(self._trace.path)
        page = page_html(Report(self._header, summary, self._events, trace, self._trace.path.name, video))
        with whole_file(self.path) as temporary:
            temporary.write_text(page, encoding="utf-8")
        if failure:
            raise failure

    def _illustrate(self, event: Event) -> None:
        """Give an event the picture of its frame: now if that is the newest one, later if it is still to come."""
        index, picture = self._newest
        if event.frame > index:
            self._waiting.append(event)
        elif event.frame == index and picture and sum(e.jpeg is not None for e in self._events) < MAX_THUMBNAILS:
            event.jpeg = self._jpeg(picture())
