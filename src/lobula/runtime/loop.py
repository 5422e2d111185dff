"""The live loop: every frame of a file, the newest of a camera; events told; one summary, whatever happens."""

from __future__ import annotations

import math
import statistics
import time
from collections import deque
from collections.abc import Callable, Iterator
from typing import NamedTuple, Protocol

from ..errors import LobulaError
from ..frames.live import FrameStream
from ..frames.source import FrameSource
from ..types import Frame, Reading
from .events import EventLog, Record
from .interrupts import Interrupted, Interrupts
from .outputs import Outputs
from .staleness import STALE_S, Staleness

POLL_S = 0.1
_TIMED = 4096  # durations kept for the median: a camera may run for weeks

DONE, REFUSED, FAILED = 0, 2, 3


class Stepper(Protocol):
    """What the loop asks of a network."""

    def step(self, image: Frame, /, *, yaw_rate_deg_s: float | None = None) -> Reading:
        """Advance by one frame."""

    def reset(self) -> None:
        """Return to before the first frame."""


class Outcome(NamedTuple):
    """How a run ended: its summary record, the exit code that says the same, and one line for people, or None."""

    summary: Record
    exit_code: int
    message: str | None


def run(
    source: FrameSource,
    network: Stepper,
    outputs: Outputs,
    header: Record,
    *,
    yaw_rate_deg_s: Callable[[float], float] | None = None,
    on_frame: Callable[[], None] | None = None,
) -> Outcome:
    """Run ``network`` over ``source`` to its end and return the outcome.

    Parameters
    ----------
    header : as ``run_header`` gives it; handed to every output
    yaw_rate_deg_s : gives the rate at which the camera itself turned at a frame's time, s
    on_frame : called after each frame, for a progress bar

    A source or an output that fails, Ctrl-C and SIGTERM end the run with a summary that says so; only a fault of
    lobula's own is raised, after the outputs were closed.
    """
    tally = _Tally(source, outputs)
    with Interrupts() as interrupts:
        try:
            outputs.open(header)
            watch = _Watch(source, network, yaw_rate_deg_s)
            for frame in interrupts.between(_arrivals(source)):
                if frame is None:
                    outputs.events(watch.silence(tally))
                    continue
                reading, records = watch.frame(frame, tally)
                outputs.frame(frame.index, reading, source.picture)
                outputs.events(records)
                if on_frame is not None:
                    on_frame()
                if outputs.deserted:
                    break
        except Interrupted as stop:
            tally.end("interrupted", stop.exit_code, f"interrupted ({stop})")
        except LobulaError as error:
            on_the_way = tally.frames > 0 or getattr(error, "on_the_way", False)
            tally.end(*(("source_failed", FAILED) if on_the_way else ("refused", REFUSED)), str(error))
        except BaseException as error:
            tally.end("crashed", 1, repr(error))
            raise
        finally:
            outputs.events(tally.log.finish())
            outputs.close(tally.summary)
            source.close()
    return Outcome(tally.summary(), tally.exit_code, tally.message)


def _arrivals(source: FrameSource) -> Iterator[Frame | None]:
    """Yield the frames; for a live source also None, whenever it has been silent for ``POLL_S``."""
    if not isinstance(source, FrameStream):
        yield from source
        return
    while not source.ended:
        yield source.poll(POLL_S)


class _Watch:
    """Steps the network and tells stillness of the scene from a source that gives nothing new."""

    def __init__(self, source: FrameSource, network: Stepper, yaw_rate_deg_s: Callable[[float], float] | None) -> None:
        self._network = network
        self._yaw_rate_deg_s = yaw_rate_deg_s
        self._frozen = Staleness() if source.live else None
        self._stale = False
        self._arrived = time.monotonic()

    def frame(self, frame: Frame, tally: _Tally) -> tuple[Reading, list[Record]]:
        """Return the reading of ``frame`` and the records of the events it starts or ends."""
        self._arrived = time.monotonic()
        stale = self._frozen is not None and self._frozen.is_stale(frame.image, frame.time_s)
        if self._stale and not stale:
            self._network.reset()  # what moved meanwhile would read as one huge jump
        self._stale = stale
        rate_deg_s = None if self._yaw_rate_deg_s is None else self._yaw_rate_deg_s(frame.time_s)
        begun = time.perf_counter()
        reading = self._network.step(frame, yaw_rate_deg_s=rate_deg_s)
        tally.count(frame, time.perf_counter() - begun)
        if stale:
            reading = reading._replace(state="stale")
        return reading, tally.log.step(frame.index, reading)

    def silence(self, tally: _Tally) -> list[Record]:
        """Return the records that follow from no frame having come since the last one."""
        silent_s = time.monotonic() - self._arrived
        now_s = tally.last_s + silent_s
        records = tally.log.elapse(now_s)
        if silent_s > STALE_S:
            self._stale = True
            records += tally.log.enter("stale", tally.index, now_s)
        return records


class _Tally:
    """Counts what the summary tells."""

    def __init__(self, source: FrameSource, outputs: Outputs) -> None:
        self.log = EventLog()
        self.frames = self.index = 0
        self.last_s = 0.0
        self.exit_code = DONE
        self.message: str | None = None
        self._status = "ok"
        self._source = source
        self._outputs = outputs
        self._first_s = math.nan
        self._durations_s: deque[float] = deque(maxlen=_TIMED)
        self._worst_s = 0.0

    def count(self, frame: Frame, duration_s: float) -> None:
        """Take note of a frame and of how long the network took for it."""
        if not self.frames:
            self._first_s = frame.time_s
        self.frames += 1
        self.index, self.last_s = frame.index, frame.time_s
        self._durations_s.append(duration_s)
        self._worst_s = max(self._worst_s, duration_s)

    def end(self, status: str, exit_code: int, message: str) -> None:
        """Take note of an end that is not the end of the source."""
        self._status, self.exit_code, self.message = status, exit_code, message

    def summary(self) -> Record:
        """Return the summary record as things stand."""
        if self._status == "ok" and self._outputs.failures:
            self.end("output_failed", FAILED, "")
        # n frames have n - 1 gaps between them; the last frame lasts as long as the others did on average
        gaps = self.frames - 1
        duration_s = (self.last_s - self._first_s) * self.frames / gaps if gaps > 0 else 0.0
        middle_s = statistics.median(self._durations_s) if self._durations_s else 0.0
        record: Record = {
            "type": "summary",
            "status": self._status,
            "frames": self.frames,
            "dropped": self._source.dropped,
            "damaged": self._source.damaged,
            "collisions": len(self.log.collisions),
            "duration_s": round(duration_s, 6),
            "ms_per_frame": round(1000 * middle_s, 4),
            "ms_worst": round(1000 * self._worst_s, 4),
        }
        problems = [text for text in (self.message, *self._outputs.failures) if text]
        said = {"problems": problems, "notes": list(self._source.notes)}
        return record | {name: texts for name, texts in said.items() if texts}


def unbegun_summary(status: str, message: str) -> Record:
    """Return the summary of a run that never began, so that a reader of records always meets exactly one."""
    return {
        "type": "summary",
        "status": status,
        "frames": 0,
        "dropped": 0,
        "damaged": 0,
        "collisions": 0,
        "duration_s": 0.0,
        "ms_per_frame": 0.0,
        "ms_worst": 0.0,
        "problems": [message],
    }
