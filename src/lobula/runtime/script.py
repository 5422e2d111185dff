"""What the modules run by ``python -m`` share with the command: one line for a failure, its exit code, a count."""

from __future__ import annotations

import sys
from collections.abc import Callable

from ..errors import FrameSourceError, LobulaError, OutputError
from .interrupts import Interrupted, raised_at_once
from .saying import say


def exit_code(error: LobulaError) -> int:
    """Return 3 for an output that cannot be written and a source that broke on the way, 2 for anything else."""
    on_the_way = isinstance(error, OutputError) or (isinstance(error, FrameSourceError) and error.on_the_way)
    return 3 if on_the_way else 2


def run_script(work: Callable[[], None], if_interrupted: str = "") -> int:
    """Do ``work`` and return the exit code: 0, 2 or 3 as ``exit_code``, 130 or 143 after a signal.

    ``if_interrupted`` says what becomes of what was done by then.
    """
    try:
        with raised_at_once():
            work()
    except LobulaError as error:
        say(f"lobula: {error}")
        return exit_code(error)
    except Interrupted as stop:
        say(f"lobula: interrupted ({stop}){'; ' if if_interrupted else ''}{if_interrupted}")
        return stop.exit_code
    return 0


def counter(total: int, things: str) -> Callable[[], None]:
    """Return what to call for each of ``total`` things done: it counts on a terminal and is silent in a pipe."""
    done = 0

    def step() -> None:
        nonlocal done
        done += 1
        if sys.stderr is not None and sys.stderr.isatty():
            print(f"\r{done} of {total} {things}", end="\n" if done == total else "", file=sys.stderr, flush=True)

    return step
