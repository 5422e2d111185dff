"""``exec:COMMAND``: runs a program for each event, with the record on its standard input."""

from __future__ import annotations

import os
import shlex
import shutil
import signal
import subprocess
import threading
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from ..errors import ParameterError
from .hook import Hook, RefusedError
from .message import Message, line

PROGRAM_S = 10.0
"""How long a program may take for one event before it is killed, s."""

_STANDARD_ERROR = 2


def make(target: str) -> Hook:
    """Return the hook of ``exec:COMMAND``; its words are split as by a shell, but no shell runs.

    Raises
    ------
    ParameterError : no program is named, a quote is left open, or there is no such program
    """
    try:
        words = shlex.split(target.partition(":")[2])
    except ValueError as error:
        raise ParameterError(f"hook exec: {error}: must be exec:COMMAND, quoted as for a shell") from error
    if not words:
        raise ParameterError("hook exec: no program is named: must be exec:COMMAND")
    if shutil.which(words[0]) is None:
        raise ParameterError(f"hook exec:{words[0]}: no program: must be executable, on the PATH or a path of its own")
    return Program(words)


class Program(Hook):
    """Runs ``words`` once for each event, one after the other, in a session of its own.

    What the program prints goes to lobula's standard error: standard output is for records. An exit code other than 0
    is a failure of that event; so is ``limit_s``, after which the program and what it started are killed.
    """

    kinds = frozenset({"event"})

    def __init__(self, words: Sequence[str], limit_s: float = PROGRAM_S) -> None:
        super().__init__(f"exec:{Path(words[0]).name}")  # its arguments may hold a password
        self._words = list(words)
        self._limit_s = limit_s
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._aborted = False

    def send(self, message: Message) -> None:
        """Run the program on one record and wait for its end.

        Raises
        ------
        RefusedError : it failed, hung or cannot be started
        """
        try:
            process = self._start()
        except OSError as error:
            raise RefusedError(f"cannot be started: {error.strerror}") from error
        try:
            process.communicate(line(message.record), timeout=self._limit_s)
        except subprocess.TimeoutExpired as error:
            _kill(process)
            process.wait()
            raise RefusedError(f"killed after {self._limit_s:g} s") from error
        finally:
            with self._lock:
                self._process = None
        if process.returncode < 0:
            raise RefusedError(f"ended by {signal.Signals(-process.returncode).name}")
        if process.returncode > 0:
            raise RefusedError(f"exit code {process.returncode}")

    def abort(self) -> None:
        """Kill the program that is running, and start no other."""
        with self._lock:
            self._aborted = True
            if self._process is not None and self._process.returncode is None:
                _kill(self._process)  # its end is not waited for: the run has its own

    def _start(self) -> subprocess.Popen[bytes]:
        with self._lock:
            if self._aborted:
                raise RefusedError("the run is over")
            # a session of its own: Ctrl-C is for lobula, and all it starts can be ended together
            self._process = subprocess.Popen(
                self._words, stdin=subprocess.PIPE, stdout=_STANDARD_ERROR, start_new_session=True
            )
            return self._process


def _kill(process: subprocess.Popen[bytes]) -> None:
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
