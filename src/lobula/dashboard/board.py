"""What all viewers see. The detector's side writes it and is never held up; each viewer reads it at its own pace."""

from __future__ import annotations

import asyncio
import secrets
import threading
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any, NamedTuple, Protocol

from .live_settings import LiveSettings
from .rows import Rows
from .scene import Scene

MOST_EVENTS = 300
"""Records of a live run's events kept for viewers who come later; the oldest go first."""

MOST_RECORDED = 4000
"""Records of a recording's events that are shown; the last to go are the alarms."""


class Scenes(Protocol):
    """Where the scenes of a recording come from, row by row."""

    def key(self, row: int, map_name: str | None) -> tuple[Any, ...]:
        """What the scene hangs on: another key, another scene."""

    def at(self, row: int, map_name: str | None) -> Scene:
        """Return the scene of ``row``; called by one thread at a time."""


class Events(NamedTuple):
    """What is told of events: how often that has changed, the records that are listed, all collisions there were."""

    version: int
    records: list[Mapping[str, Any]]
    collisions: int


class Viewer:
    """One open page: what it has been sent, what it asks for. Touched by the server's thread only."""

    def __init__(self) -> None:
        self.wake = asyncio.Event()
        self.wake.set()
        self.map: str | None = None
        self.row: int | None = None
        self.greeted = False
        self.rows_version, self.row_number = -1, 0
        self.events_version = self.settings_version = self.scene_number = -1
        self.scene_key: tuple[Any, ...] | None = None


class Board:
    """The newest of everything, each part replaced as a whole, so that a reader never sees half of it.

    Parameters
    ----------
    about : what stays the same for as long as the program runs, for the page
    rows : the readings
    settings : the live settings, or None where nothing can be changed
    scenes : for a recording: gives the scene of any row; a live board is shown its scenes instead
    """

    def __init__(
        self,
        about: Mapping[str, Any],
        rows: Rows,
        *,
        settings: LiveSettings | None = None,
        scenes: Scenes | None = None,
    ) -> None:
        self.about = {**about, "run": secrets.token_hex(8)}
        self.rows = rows
        self.settings = settings
        self.scenes = scenes
        self.scene: Scene | None = None
        self.status: Mapping[str, Any] = {}
        self.events = Events(0, [], 0)
        self.wanted_maps: frozenset[str] = frozenset()
        self.viewers: set[Viewer] = set()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._lock = threading.Lock()
        self._waking = False
        if settings is not None:
            settings.listen(self.wake)

    @property
    def watched(self) -> bool:
        """True while at least one page is open."""
        return bool(self.viewers)

    def show(self, scene: Scene) -> None:
        """Replace the scene of a live board."""
        self.scene = scene
        self.wake()

    def tell(self, **status: Any) -> None:
        """Change parts of the status."""
        with self._lock:
            self.status = {**self.status, **status}
        self.wake()

    def add_event(self, record: Mapping[str, Any]) -> None:
        """Add one record of an event.

        Of tries to open a source again only the newest is kept: a night without the camera is not to push out alarms.
        """
        version, records, collisions = self.events
        again = bool(records) and _is_try(record) and _is_try(records[-1])
        kept = records[:-1] if again else records[1 - MOST_EVENTS :]
        self.events = Events(version + 1, [*kept, dict(record)], collisions + _is_alarm(record))
        self.wake()

    def replace_events(self, records: Sequence[Mapping[str, Any]]) -> None:
        """Take the records of a recording in place of those that were there."""
        alarms_first = sorted(range(len(records)), key=lambda i: (records[i]["type"] != "collision", -i))
        kept = [records[i] for i in sorted(alarms_first[:MOST_RECORDED])]
        self.events = Events(self.events.version + 1, kept, sum(map(_is_alarm, records)))
        self.wake()

    def wake(self) -> None:
        """Have every viewer look again; from any thread, at next to no cost."""
        loop = self._loop
        if loop is None or self._waking:
            return
        self._waking = True
        with suppress(RuntimeError):  # the server has just stopped
            loop.call_soon_threadsafe(self._wake_all)

    def attach(self, loop: asyncio.AbstractEventLoop) -> None:
        """Serve viewers from ``loop`` from now on."""
        self._loop = loop
        self._waking = False

    def join(self, viewer: Viewer) -> None:
        """Take in a viewer; server's thread."""
        self.viewers.add(viewer)
        self._counted()

    def leave(self, viewer: Viewer) -> None:
        """Let a viewer go; server's thread."""
        self.viewers.discard(viewer)
        self._counted()

    def choose_map(self, viewer: Viewer, name: str | None) -> None:
        """Show ``viewer`` the map of that name from now on; server's thread."""
        viewer.map = name
        self._counted()
        viewer.wake.set()

    def _counted(self) -> None:
        self.wanted_maps = frozenset(viewer.map for viewer in self.viewers if viewer.map is not None)
        self.tell(viewers=len(self.viewers))

    def _wake_all(self) -> None:
        self._waking = False
        for viewer in self.viewers:
            viewer.wake.set()


def _is_alarm(record: Mapping[str, Any]) -> bool:
    return (record["type"], record["phase"]) == ("collision", "start")


def _is_try(record: Mapping[str, Any]) -> bool:
    return (record["type"], record["phase"]) == ("source", "retry")
