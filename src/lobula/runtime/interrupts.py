"""Ctrl-C and SIGTERM: taken between two frames, or at once while waiting for one, never inside an output."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from types import FrameType, TracebackType
from typing import Self, TypeVar

T = TypeVar("T")

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Interrupted(BaseException):
    """The user or the system asked the run to stop; ``number`` is the signal's."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number

    @property
    def exit_code(self) -> int:
        """What a shell expects of a program stopped by this signal: 130 or 143."""
        return 128 + self.number


@contextmanager
def raised_at_once() -> Iterator[None]:
    """Raise ``Interrupted`` wherever the program is when a signal comes: for work that writes nothing piece by piece.

    Outside the main thread, where Python handles no signals, it does nothing.
    """

    def stop(number: int, frame: FrameType | None) -> None:
        raise Interrupted(number)

    with _handled_by(stop):
        yield


@contextmanager
def _handled_by(handler: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """Give the signals to ``handler`` for as long as the context lasts."""
    here = threading.current_thread() is threading.main_thread()
    before = {number: signal.signal(number, handler) for number in SIGNALS} if here else {}
    try:
        yield
    finally:
        for number, former in before.items():
            signal.signal(number, former)


class Interrupts:
    """A context in which the first signal is noted and raised at a safe moment, and a second one ends the process.

    Outside the main thread, where Python handles no signals, it does nothing.
    """

    def __init__(self) -> None:
        self._number: int | None = None
        self._waiting = False
        self._handled = ExitStack()

    def __enter__(self) -> Self:
        self._handled.enter_context(_handled_by(self._note))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._handled.close()

    def between(self, items: Iterator[T]) -> Iterator[T]:
        """Yield ``items``, raising between two of them, or while the next one is waited for.

        Raises
        ------
        Interrupted : a signal came
        """
        while True:
            self._waiting = True
            try:
                if self._number is not None:
                    raise Interrupted(self._number)
                item = next(items)
            except StopIteration:
                return
            finally:
                self._waiting = False
            yield item

    def _note(self, number: int, frame: FrameType | None) -> None:
        for each in SIGNALS:  # who asks twice does not want to wait for the outputs
            signal.signal(each, signal.SIG_DFL)
        self._number = number
        if self._waiting:
            raise Interrupted(number)
