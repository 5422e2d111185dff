"""What a module run by ``python -m`` says of its end: one line and the command's exit codes."""

from __future__ import annotations

import signal
import sys

import pytest

from lobula.errors import FrameSourceError, OutputError, ParameterError
from lobula.runtime.script import counter, run_script


def failing(error):
    def work():
        raise error

    return work


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (ParameterError("no"), 2),
        (FrameSourceError("no"), 2),
        (FrameSourceError("no", on_the_way=True), 3),
        (OutputError("no"), 3),
    ],
)
def test_a_failure_is_one_line(error, code, capsys):
    assert run_script(failing(error)) == code
    assert capsys.readouterr() == ("", "lobula: no\n")


def test_what_works_says_nothing(capsys):
    done = []
    assert run_script(lambda: done.append(1)) == 0
    assert done == [1]
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_ends_it_and_it_says_what_becomes_of_the_rest(number, code, capsys):
    assert run_script(lambda: signal.raise_signal(number), "begin again") == code
    assert capsys.readouterr().err == f"lobula: interrupted ({number.name}); begin again\n"


def test_a_fault_of_its_own_is_a_traceback():
    with pytest.raises(ZeroDivisionError):
        run_script(failing(ZeroDivisionError()))


def test_it_counts_on_a_terminal_only(capsys, monkeypatch):
    step = counter(2, "runs")
    step()
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    step()
    assert capsys.readouterr().err == "\r2 of 2 runs\n"
