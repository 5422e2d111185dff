"""Calls a verb and turns every expected failure into one line and an exit code."""

from __future__ import annotations

import errno
import os
import re
import sys
import warnings
from collections.abc import Sequence
from importlib import import_module
from typing import Any, TextIO, cast

import typer

from ..errors import LobulaError
from ..runtime.interrupts import Interrupted, raised_at_once
from ..runtime.script import exit_code
from .progress import say

_ParserError = cast(type[Exception], typer.BadParameter.__mro__[2])
"""What the parser raises for a wrong command line: ``ClickException``, which typer names in no public place."""


def new_app(about: str | None = None) -> typer.Typer:
    """Return the typer application of one verb: plain help, no completion, errors left to ``call``.

    ``about`` describes a verb that has verbs of its own.
    """
    return typer.Typer(
        help=about,
        add_completion=False,
        rich_markup_mode=None,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )


def call(verb: str, arguments: Sequence[str]) -> int:
    """Run ``verb`` and return its exit code; a traceback means a fault of lobula's own."""
    warnings.showwarning = _show_warning
    try:
        app: typer.Typer = import_module(f".{verb}", __package__).app
        command: Any = typer.main.get_command(app)
        with raised_at_once():
            result = command.main(list(arguments), prog_name=f"lobula {verb}", standalone_mode=False)
        return _flushed(result if isinstance(result, int) else 0)
    except (BrokenPipeError, SystemExit) as error:
        # a reader that has gone is no fault; typer turns it into an exit of its own
        if not isinstance(error, BrokenPipeError) and not isinstance(error.__context__, BrokenPipeError):
            raise
        _silence(sys.stdout)
        return 0
    except LobulaError as error:
        return _complain(str(error), exit_code(error))
    except PermissionError as error:
        if error.filename is None:
            raise
        return _complain(f"{os.fsdecode(error.filename)}: no permission to look at it, must be readable", 2)
    except OSError as error:
        if error.errno not in (errno.ENOSPC, errno.EIO):
            raise
        _silence(sys.stdout)  # what could not be printed: files are written under their own names, with their own words
        return _complain(f"cannot write standard output: {error.strerror}", 3)
    except Interrupted as stop:
        return _complain(f"interrupted ({stop})", stop.exit_code)
    except _ParserError as error:
        message = cast(Any, error).format_message().rstrip(".")
        message = re.sub(r"(extra arguments?\S* \(\S+) .+\)$", r"\1 ...)", message)  # a shell's pattern: many names
        if "unexpected extra argument" in message and verb in ("run", "explain"):
            message += '; one SOURCE is read: quote a pattern, as in "shots/*.png"'
        if message.startswith("No such command") and not message.endswith("?"):
            message += f"; must be one of {', '.join(command.commands)}"
        return _complain(f"{verb}: {message}; see `lobula {verb} --help`", 2)


def _show_warning(
    message: Warning | str, category: type[Warning], filename: str, lineno: int, file: Any = None, line: Any = None
) -> None:
    """Say a warning in one line, as everything else."""
    say(f"lobula: {message}")


def _complain(message: str, code: int) -> int:
    say(f"lobula: {message}")
    return _flushed(code)


def _flushed(code: int) -> int:
    """Flush what was printed and return the exit code: a reader that has gone is no fault, a full disk is."""
    if sys.stdout is None:
        return code
    try:
        sys.stdout.flush()
    except OSError as error:
        _silence(sys.stdout)
        if code == 0 and not isinstance(error, BrokenPipeError):
            return _complain(f"cannot write standard output: {error.strerror}", 3)
    return code


def _silence(stream: TextIO | None) -> None:
    """Point the stream's descriptor nowhere, or Python complains about it once more at exit."""
    if stream is not None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
