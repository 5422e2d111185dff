"""What people see while work goes on: lines on standard error, a bar below them on a terminal, nothing in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from typing import NamedTuple

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
    if sys.stderr is not None:  # as it is in a program that was started without one
        _write(unbuffered(sys.stderr), text)


def _write(stream: Writable, text: str) -> None:
    with suppress(OSError):
        stream.write(f"{text}\n")
        stream.flush()


@contextmanager
def live_words() -> Iterator[Say]:
    """Give a ``say`` that holds nobody up: where a pipe is not read, lines wait, and are lost in the end."""
    courier = Courier("standard error")
    stream = None if sys.stderr is None else unbuffered(sys.stderr)
    try:
        yield lambda text: courier.send(partial(_write, stream, text)) if stream else None
    finally:
        courier.close()


@contextmanager
def live_screen(total: int | None, what: str) -> Iterator[Screen]:
    """Give a screen that holds nobody up, a terminal that was stopped neither. Its bar moves with ``describe`` only."""
    with screen(total, what) as here:
        if here.describe is None:
            with live_words() as tell:
                yield Screen(tell, None)
            return
        courier, tell, describe = Courier("standard error"), here.say, here.describe
        try:
            yield Screen(
                lambda text: courier.send(partial(tell, text)),
                None,
                lambda text, done: courier.send(partial(describe, text, done)),
            )
        finally:
            courier.close()


@contextmanager
def screen(total: int | None, what: str) -> Iterator[Screen]:
    """Give a bar over ``total`` steps (None: nobody knows how many) where standard error is a terminal.

    rich is loaded only then: it costs more than the first frame.
    """
    if sys.stderr is None or not sys.stderr.isatty():
        yield Screen(say, None)
        return
    from rich.console import Console
    from rich.markup import escape
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    console = Console(stderr=True, highlight=False)
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task(what, total=total)
        yield Screen(
            lambda text: console.print(text, markup=False),
            lambda: progress.advance(task),
            lambda text, done: progress.update(task, description=escape(text), completed=done),
        )
