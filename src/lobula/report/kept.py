"""A clip of every alarm: the seconds before it, from a ring in memory, and those after it."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

from ..errors import OutputError, ParameterError
from ..landing import writing
from ..runtime.outputs import disk_failed
from ..runtime.sinks import OutputLapseError, Picture
from ..types import Reading
from .clip import Clip, Finisher, free_name
from .h264 import H264Encoder, require_h264
from .recording import EvenPictures
from .ring import MOST_BYTES, Ring, Slot
from .trace import facts

WIDTH_PX = 640
"""Clips are no wider; the network sees less still."""

LONGEST_S = 600.0
"""Longest time before or after an alarm, and between two pictures of a clip."""


class KeptClips:
    """Writes ``collision-DATE-TIMEZ-ID.mp4`` into ``folder`` for each alarm, and its part of the trace as csv.

    A clip begins ``before_s`` before its alarm, or up to a second earlier, and ends ``after_s`` after it is over, or at
    a pause of more than ``LONGEST_S``; alarms that begin before that share it. A clip that cannot be written is given
    up, and the next one is tried again: what goes wrong with several in a row is told once.

    Raises
    ------
    ParameterError : a time that is none
    OutputError : PyAV was built without libx264
    """

    def __init__(self, folder: str | Path, before_s: float = 10.0, after_s: float = 3.0) -> None:
        self.folder = Path(folder)
        for name, span_s in (("before", before_s), ("after", after_s)):
            if not 0 <= span_s <= LONGEST_S:
                raise ParameterError(
                    f"seconds kept {name} an alarm (--keep-{name}): {span_s:g}: must be 0 to {LONGEST_S:g}"
                )
        require_h264(self.folder / "clips")
        self._before_s, self._after_s = before_s, after_s
        self._ring = Ring(before_s)
        self._sized = EvenPictures(WIDTH_PX)
        self._header: Mapping[str, Any] = {}
        self._encoder: H264Encoder | None = None
        self._wanted: str | None = None  # name of the clip that is to begin
        self._clip: Clip | None = None
        self._until_s = -math.inf  # when the clip ends
        self._newest_s = math.inf
        self._finisher = Finisher()
        self._lost = 0
        self._told_lost = self._told_short = False
        self._problems: list[str] = []

    def open(self, header: Mapping[str, Any]) -> None:
        """Make the folder and see that a file can be made in it: an alarm may come days later.

        Raises
        ------
        OutputError : it cannot, and not because the disk is full, which may be over by then
        """
        self._header = header
        with writing(self.folder):
            self.folder.mkdir(parents=True, exist_ok=True)
        try:
            with writing(self.folder):
                TemporaryFile(dir=self.folder).close()
        except OutputError as error:
            if not disk_failed(error):
                raise

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Encode one picture into the ring and, during a clip, into that.

        Raises
        ------
        OutputError : the encoder failed
        OutputLapseError : a clip is lost, the first one in a row
        """
        if picture is None:
            return
        image = self._sized(picture())
        if self._encoder is None:
            fps = float(self._header.get("fps") or 30.0)
            height, width = image.shape[:2]
            self._encoder = H264Encoder(self.folder / "clips", width, height, fps, crf=23, speed="superfast")
        if reading.time_s - self._newest_s > LONGEST_S:  # an MP4 cannot hold every gap
            self._hand_over()
        self._newest_s = reading.time_s
        slot = Slot(index, reading, self._encoder.encode(image, reading.time_s))
        self._ring.add(slot)
        if reading.time_s > self._until_s:
            self._end()
        elif self._wanted is not None:
            self._begin()
        elif self._clip is not None:
            try:
                self._clip.add(slot)
            except OutputError as error:
                self._abandon(error)
        self._tell()

    def event(self, record: Mapping[str, Any]) -> None:
        """Ask for a clip at the start of an alarm; at its end, set that of the clip.

        It begins with the next frame: those who are told of the alarm after this sink do not wait for a disk.
        """
        alarm = record["type"] == "collision"
        if alarm and record["phase"] == "start":
            if self._clip is None and self._wanted is None:
                self._wanted = f"collision-{time.strftime('%Y%m%d-%H%M%SZ', time.gmtime())}-{record['id']:04d}"
            self._until_s = math.inf
        elif alarm:
            self._until_s = float(record["time_s"]) + self._after_s
        elif record["type"] == "state" and (record["state"], record["phase"]) == ("stale", "start"):
            self._end()  # what follows is not of this clip, whenever it may come
        self._tell()

    def close(self, summary: Mapping[str, Any]) -> None:
        """Finish the clip under way and wait for those that are being finished.

        Raises
        ------
        OutputLapseError : clips are lost
        """
        self._end()
        self._finisher.close()
        if self._encoder is not None:
            self._encoder.close()
        self._take_note()
        if self._lost > 1:
            self._problems.append(f"{self.folder}: {self._lost} clips of alarms are lost in all")
        self._tell()

    def _begin(self) -> None:
        """Begin the wanted clip, if one is wanted, with what the ring holds."""
        name, self._wanted = self._wanted, None
        if name is None or self._encoder is None:
            return
        try:
            self._clip = Clip(free_name(self.folder, name), self._encoder.template, facts(self._header))
            for slot in self._ring:
                self._clip.add(slot)
        except OutputError as error:
            self._abandon(error)
        if self._ring.cut_short and not self._told_short:
            self._told_short = True
            self._problems.append(
                f"{self.folder}: clips begin less than {self._before_s:g} s before an alarm: so much changes in the "
                f"picture that more would take over {MOST_BYTES >> 20} MB of memory"
            )

    def _end(self) -> None:
        """Hand the clip under way over to be finished, with what was still wanted."""
        self._begin()
        self._hand_over()

    def _hand_over(self) -> None:
        """Have the clip under way finished."""
        clip, self._clip = self._clip, None
        if clip is not None:
            self._finisher.take(clip)

    def _abandon(self, error: OutputError) -> None:
        """Give up the clip under way."""
        clip, self._clip = self._clip, None
        if clip is not None:
            clip.abandon()
        self._lose(error)

    def _lose(self, error: OutputError) -> None:
        self._lost += 1
        if not self._told_lost:
            self._told_lost = True
            self._problems.append(f"a clip of an alarm is lost: {error}")

    def _take_note(self) -> None:
        """Take note of what became of the clips that were handed over."""
        for error in self._finisher.outcomes():
            if error is None:
                self._told_lost = False
            else:
                self._lose(error)

    def _tell(self) -> None:
        self._take_note()
        problems, self._problems = self._problems, []
        if problems:
            raise OutputLapseError("; ".join(problems))
