"""Clips in several processes of this machine; one that dies takes nothing with it."""

from __future__ import annotations

import signal
from collections import deque
from collections.abc import Iterable, Iterator
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from types import TracebackType
from typing import Any, Self, cast

from ..errors import LobulaError, OutputError
from ..workers import check_workers, starting_workers
from .clips import Clip
from .request import Request
from .work import Answer
from .worker import READY, serve

_MOST_STILLBORN = 3  # workers, one after the other, that end before they are ready: the next one would too
_A_MOMENT_S = 5.0  # between the end of its line and the end of a process

Outcome = Answer | str
"""What became of a clip, or how its worker died of it, twice."""


class Crew:
    """A context with ``workers`` processes, started when there is something to do for them.

    They are killed when it ends: what they have finished is on the disk, what they are at is done another time.

    Raises
    ------
    ParameterError : workers out of range
    """

    def __init__(self, request: Request, workers: int) -> None:
        check_workers(workers)
        self.workers = workers
        self._request = request
        self._hands: list[_Hand] = []
        self._stillborn = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for hand in self._hands:
            hand.end()

    def each(self, clips: Iterable[Clip]) -> Iterator[tuple[Clip, Outcome]]:
        """Yield each clip and what became of it, as they are finished.

        A clip whose worker dies is tried once more, with another worker.

        Raises
        ------
        LobulaError : what ends the whole batch: an output that cannot be written, a worker that cannot start
        """
        waiting, tried = deque(clips), set[Clip]()
        while waiting or any(hand.clip for hand in self._hands):
            self._give(waiting)
            busy = {hand.line: hand for hand in self._hands if hand.clip}
            for line in wait(list(busy)) if busy else ():
                hand = busy[cast(Connection, line)]
                clip, answer = cast(Clip, hand.clip), hand.answer()
                if answer is not None:
                    yield clip, answer
                    continue
                self._hands.remove(hand)
                cause = hand.end()
                if clip in tried:
                    yield clip, f"its worker ended in the middle of it, twice ({cause})"
                else:
                    tried.add(clip)
                    waiting.append(clip)

    def _give(self, waiting: deque[Clip]) -> None:
        """Give every worker that has nothing to do a clip; there are as many workers as are of use."""
        idle = [hand for hand in self._hands if not hand.clip]
        started = [_Hand(self._request) for _ in range(min(self.workers - len(self._hands), len(waiting) - len(idle)))]
        self._hands += started
        for hand in started:  # all of them are on their way before the first is waited for
            self._stillborn = 0 if hand.is_ready() else self._stillborn + 1
            if self._stillborn > _MOST_STILLBORN:
                raise OutputError(f"a worker cannot start: it ended by itself ({hand.end()})")
        for hand in (*idle, *started):
            if waiting and not hand.take(waiting[0]):
                self._hands.remove(hand)  # it died meanwhile, and not of this clip
                hand.end()
            elif waiting:
                waiting.popleft()


class _Hand:
    """One worker process, the line to it, and the clip that it is at."""

    def __init__(self, request: Request) -> None:
        context = get_context("spawn")
        self.line, theirs = context.Pipe()
        self.clip: Clip | None = None
        self._process = context.Process(target=serve, args=(theirs,), daemon=True)
        with starting_workers():
            self._process.start()
        theirs.close()  # so that the line ends when the worker does
        self._send(request)

    def is_ready(self) -> bool:
        """Wait until the worker has loaded everything; False where it has ended.

        Raises
        ------
        LobulaError : it cannot work; the reason is its own
        """
        return bool(self._receive() == READY)

    def take(self, clip: Clip) -> bool:
        """Give the worker a clip; False where it is not there any more."""
        if not self._send(clip):
            return False
        self.clip = clip
        return True

    def answer(self) -> Answer | None:
        """Return what became of the clip; None where the worker has ended.

        Raises
        ------
        LobulaError : what ends the whole batch
        """
        answer = self._receive()
        if isinstance(answer, Answer):
            self.clip = None
            return answer
        return None

    def end(self) -> str:
        """End the worker, wherever it is, and return how it ended in words."""
        ended = not self._process.is_alive()
        self._process.kill()
        self._process.join()
        self.line.close()
        code = self._process.exitcode or 0
        return (signal.Signals(-code).name if code < 0 else f"exit code {code}") if ended else "killed"

    def _send(self, what: Any) -> bool:
        try:
            self.line.send(what)
        except OSError:
            return False
        return True

    def _receive(self) -> Any:
        try:
            received = self.line.recv()
        except (EOFError, OSError):  # at the end, or in the middle, of a message
            self._process.join(_A_MOMENT_S)
            return None
        if isinstance(received, LobulaError):
            raise received
        return received
