"""What people see while work goes on: lines on standard error, a bar below them on a terminal, nothing in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any, NamedTuple, cast

from ..runtime.courier import Courier
from ..runtime.unbuffered import Writable, unbuffered

Say = Callable[[str], None]
"""Writes one line for people."""


Describe = Callable[[str, int], None]
"""Sets the words before a bar, and how many steps are done."""


class Screen(NamedTuple):
    """``say`` writes a line; ``advance`` moves the bar by one, ``describe`` sets its words; both None without a bar."""

    say: Say
    advance: Callable[[], None] | None
    describe: Describe | None = None


def say(text: str) -> None:
    """Write one line on standard error, at once; where nobody can be told any more, nobody is."""
    if sys.stderr is None:  # as it is in a program that was started without one
        return
    # a terminal's own stream keeps lines clear of a bar; elsewhere what cannot be written must not wait in a buffer
    _write(sys.stderr if sys.stderr.isatty() else unbuffered(sys.stderr), text)


def _write(stream: Writable, text: str) -> None:
    with suppress(OSError):
        stream.write(f"{text}\n")
        stream.flush()


@contextmanager
def screen(total: int | None, what: str) -> Iterator[Screen]:
    """Give a bar over ``total`` steps (None: nobody knows how many) where standard error is a terminal.

    rich is loaded only then: it costs more than the first frame.
    """
    if sys.stderr is None or not sys.stderr.isatty():
        yield Screen(say, None)
        return
    # what goes to a file or a program is none of the bar's business
    bar = _Bar(total, what, redirect_stdout=sys.stdout is not None and sys.stdout.isatty())
    bar.start()
    try:
        yield Screen(bar.say, bar.advance, bar.describe)
    finally:
        bar.stop()


@contextmanager
def live_screen(total: int | None, what: str) -> Iterator[Screen]:
    """Give a screen that holds nobody up, a terminal that was stopped neither. Its bar moves with ``describe`` only."""
    if sys.stderr is None or not sys.stderr.isatty():
        with live_words() as tell:
            yield Screen(tell, None)
        return
    # rich's own thread would wait in a stopped terminal, with a lock that the end of the bar needs
    courier = Courier("standard error")
    bar = _Bar(total, what, file=unbuffered(sys.stderr), redirect_stdout=False, redirect_stderr=False, refreshed=False)
    courier.send(bar.start)
    try:
        yield Screen(
            lambda text: courier.send(partial(bar.say, text)),
            None,
            lambda text, done: courier.send(partial(bar.describe, text, done)),
        )
    finally:
        courier.send(bar.stop)
        courier.close()


@contextmanager
def live_words() -> Iterator[Say]:
    """Give a ``say`` that holds nobody up: where a pipe is not read, lines wait, and are lost in the end."""
    courier = Courier("standard error")
    stream = None if sys.stderr is None else unbuffered(sys.stderr)
    try:
        yield lambda text: courier.send(partial(_write, stream, text)) if stream else None
    finally:
        courier.close()


class _Bar:
    """A bar of rich with lines above it, which a terminal that is gone does not trouble."""

    def __init__(
        self, total: int | None, what: str, *, file: Writable | None = None, redirect_stdout: bool,
        redirect_stderr: bool = True, refreshed: bool = True,
    ) -> None:  # fmt: skip
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        console = Console(file=cast(Any, file), stderr=True, highlight=False, force_terminal=True)
        self._progress = Progress(
            *columns, console=console, transient=True, auto_refresh=refreshed, redirect_stdout=redirect_stdout,
            redirect_stderr=redirect_stderr,
        )  # fmt: skip
        self._task = self._progress.add_task(what, total=total)
        self._refreshed = refreshed

    def start(self) -> None:
        with suppress(OSError):
            self._progress.start()

    def stop(self) -> None:
        with suppress(OSError):
            self._progress.stop()

    def say(self, text: str) -> None:
        with suppress(OSError):
            self._progress.console.print(text, markup=False)

    def advance(self) -> None:
        self._progress.advance(self._task)

    def describe(self, text: str, done: int) -> None:
        from rich.markup import escape

        with suppress(OSError):
            self._progress.update(self._task, description=escape(text), completed=done, refresh=not self._refreshed)
