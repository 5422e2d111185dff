"""What people see while work goes on: lines on standard error, a bar below them on a terminal, nothing in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple

Say = Callable[[str], None]
"""Writes one line for people."""


class Screen(NamedTuple):
    """``say`` writes a line; ``advance`` moves the bar by one, ``describe`` sets its words; both None without a bar."""

    say: Say
    advance: Callable[[], None] | None
    describe: Say | None = None


def say(text: str) -> None:
    """Write one line on standard error, at once."""
    print(text, file=sys.stderr, flush=True)


@contextmanager
def screen(total: int | None, what: str) -> Iterator[Screen]:
    """Give a bar over ``total`` steps (None: nobody knows how many) where standard error is a terminal.

    rich is loaded only then: it costs more than the first frame.
    """
    if not sys.stderr.isatty():
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
            lambda text: progress.update(task, description=escape(text)),
        )
