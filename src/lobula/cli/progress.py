"""What people see while a run goes on: lines on standard error, a bar below them on a terminal, nothing in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple, Protocol

from ..types import Frame


class OnFrame(Protocol):
    """Called after every frame."""

    def __call__(self, frame: Frame, /) -> None:
        """Move the bar."""


class Screen(NamedTuple):
    """``say`` writes a line; ``on_frame`` moves the bar, or is None where there is none."""

    say: Say
    on_frame: OnFrame | None


class Say(Protocol):
    """Writes one line for people."""

    def __call__(self, text: str, /) -> None:
        """Write ``text``."""


def say(text: str) -> None:
    """Write one line on standard error, at once."""
    print(text, file=sys.stderr, flush=True)


@contextmanager
def screen(frames: int | None, what: str) -> Iterator[Screen]:
    """Give a bar over ``frames`` (None: how many is not known) where standard error is a terminal.

    rich is loaded only then: it costs more than the first frame.
    """
    if not sys.stderr.isatty():
        yield Screen(say, None)
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(),
               TextColumn("{task.fields[time_s]:.1f} s"), TimeRemainingColumn())
    console = Console(stderr=True, highlight=False)
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task(what, total=frames, time_s=0.0)
        yield Screen(
            lambda text: console.print(text, markup=False),
            lambda frame: progress.update(task, advance=1, time_s=frame.time_s),
        )
