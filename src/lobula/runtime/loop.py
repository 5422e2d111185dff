"""The live loop: every frame of a file, the newest of a camera; events told; one summary, whatever happens."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from ..errors import LobulaError
from ..frames.live import FrameStream
from ..frames.source import FrameSource
from ..types import Frame
from .events import Record
from .interrupts import Interrupted, Interrupts
from .outputs import Outputs
from .service import Listener
from .sinks import Picture
from .sources import F, Polled, Source
from .tally import FAILED, REFUSED, Tally
from .watch import SourceWatch, Stepper, Watch

POLL_S = 0.1


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
    listeners: Sequence[Listener] = (),
) -> Outcome:
    """Run ``network`` over ``source`` to its end and return the outcome.

    Parameters
    ----------
    header : as ``run_header`` gives it; handed to every output
    yaw_rate_deg_s : gives the rate at which the camera itself turned at a frame's time, s
    on_frame : called after each frame, for a progress bar
    listeners : are told how the run fares, also while the source is silent

    A source or an output that fails, Ctrl-C and SIGTERM end the run with a summary that says so; only a fault of
    lobula's own is raised, after the outputs were closed. Events go out before the frame they name is drawn.
    """
    return follow(
        source, _arrivals(source), lambda tally: Watch(source, network, tally, yaw_rate_deg_s), source.picture,
        outputs, header, on_frame, listeners,
    )  # fmt: skip


def follow(
    source: Source,
    arrivals: Iterator[F | None],
    watched: Callable[[Tally], SourceWatch[F]],
    picture: Picture | None,
    outputs: Outputs,
    header: Record,
    on_frame: Callable[[], None] | None,
    listeners: Sequence[Listener],
) -> Outcome:
    """Do what ``run`` does, whatever is followed.

    Parameters
    ----------
    arrivals : the frames of ``source``, and None whenever it has been silent for a while
    watched : makes what turns them into readings
    picture : gives the whole picture of the last frame; None where there are none
    """
    tally = Tally(source, outputs)
    with Interrupts() as interrupts:
        try:
            outputs.open(header)
            watch = watched(tally)
            for frame in interrupts.between(arrivals):
                for listener in listeners:
                    listener.beat(tally.words, ready=frame is not None)
                if frame is None:
                    outputs.events(watch.silence())
                    outputs.silence(tally.index, watch.now_s)
                else:
                    reading, records = watch.frame(frame)
                    outputs.events(records)
                    outputs.frame(frame.index, reading, picture)
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
            for listener in listeners:
                listener.stop()
            outputs.events(tally.log.finish())
            outputs.close(tally.summary)
            source.close()
    return Outcome(tally.summary(), tally.exit_code, tally.message)


def _arrivals(source: FrameSource) -> Iterator[Frame | None]:
    """Yield the frames; for a live source also None, whenever it has been silent for ``POLL_S``."""
    if not isinstance(source, FrameStream):
        yield from source
        return
    yield from polled(source)


def polled(source: Polled[F]) -> Iterator[F | None]:
    """Yield the frames of a live source, and None whenever it has been silent for ``POLL_S``."""
    while not source.ended:
        yield source.poll(POLL_S)
