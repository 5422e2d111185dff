"""What people see while work goes on: lines on standard error, a bar below them on a terminal, nothing in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any, NamedTuple, cast

from ..runtime.courier import Courier
from ..runtime.saying import say as say
from ..runtime.saying import write_line
from ..runtime.unbuffered import unbuffered

Say = Callable[[str], None]
"""Writes one line for people."""


Describe = Callable[[str, int], None]
"""Sets the words before a bar, and how many steps are done."""


class Screen(NamedTuple):
    """``say`` writes a line; ``advance`` moves the bar by one, ``describe`` sets its words; both None without a bar."""

    say: Say
    advance: Callable[[], None] | None
    describe: Describe | None = None


@contextmanager
def screen(total: int | None, what: str) -> Iterator[Screen]:
    """Give a bar over ``total`` steps (None: nobody knows how many) where standard error is a terminal.

    rich is loaded only then: it costs more than the first frame.
    """
    if sys.stderr is None or not sys.stderr.isatty():
        yield Screen(say, None)
        return
    bar = _Bar(total, what)
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
    courier = Courier("standard error")
    bar = _Bar(total, what, live=True)
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
        yield lambda text: courier.send(partial(write_line, stream, text)) if stream else None
    finally:
        courier.close()


class _Bar:
    """A bar of rich with lines above it, which a terminal that is gone does not trouble.

    One that is ``live`` is drawn when it is told something, without a thread of rich's own: that would wait in a
    stopped terminal, with a lock that the end of the bar needs.
    """

    def __init__(self, total: int | None, what: str, live: bool = False) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        file = cast(Any, unbuffered(sys.stderr)) if live else None
        console = Console(file=file, stderr=True, highlight=False, force_terminal=True)
        # what goes to a file or a program is none of the bar's business
        shared = not live and sys.stdout is not None and sys.stdout.isatty()
        self._progress = Progress(
            *columns, console=console, transient=True, auto_refresh=not live, redirect_stdout=shared,
            redirect_stderr=not live,
        )  # fmt: skip
        self._task = self._progress.add_task(what, total=total)
        self._live = live

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
            self._progress.update(self._task, description=escape(text), completed=done, refresh=self._live)
