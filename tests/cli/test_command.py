"""The command as a whole: help, version, unknown verbs, and how a failure is told."""

from __future__ import annotations

import errno
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import lobula
from lobula.cli import VERBS

from .conftest import SRC


@pytest.mark.parametrize("arguments", [["--help"], ["-h"], []])
def test_help_names_every_verb_and_the_exit_codes(call, arguments):
    done = call(*arguments)
    assert (done.code, done.err) == (0, "")
    for verb, about in VERBS.items():
        assert f"  {verb} " in done.out
        assert about in done.out
    assert "130 or 143 interrupted" in done.out


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_has_help_and_json(call, verb):
    done = call(verb, "--help")
    assert (done.code, done.err) == (0, "")
    names = {"config": ("show", "init", "validate"), "export": ("c",)}.get(verb, ())
    texts = [call(verb, name, "--help").out for name in names] or [done.out]
    assert all("--json" in text for text in texts)
    assert import_module(f"lobula.cli.{verb}").app is not None


def test_version(call):
    assert call("--version").out == f"lobula {lobula.__version__}\n"


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["rnu"], "lobula: unknown command rnu: did you mean run?"),
        (["xyz"], "lobula: unknown command xyz: must be one of demo, run,"),
        (["run"], "lobula: run: Missing argument 'SOURCE'; see `lobula run --help`"),
        (["run", "x", "--sise", "1"], "lobula: run: No such option"),
        (["run", "x", "--stride", "many"], "lobula: run: Invalid value for '--stride'"),
        (["config", "shw"], "lobula: config: No such command 'shw'. Did you mean 'show'?; see "),
        (["config", "xyz"], "lobula: config: No such command 'xyz'; must be one of show, init, validate; see "),
    ],
)
def test_a_wrong_command_line_is_one_line_and_2(call, arguments, line):
    done = call(*arguments)
    assert (done.code, done.out) == (2, "")
    assert done.err.startswith(line)
    assert done.err.count("\n") == 1


@pytest.mark.parametrize("code", ["import lobula", "from lobula.cli import main; main(['--help'])"])
def test_nothing_heavy_is_imported_for_it(code):
    heavy = "{'numpy', 'av', 'matplotlib', 'typer', 'rich', 'click'}"
    program = f"import sys; {code}; print('loaded', sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True,
                          env={"PYTHONPATH": str(SRC)})  # fmt: skip
    assert done.stdout.splitlines()[-1] == "loaded []"


def test_a_fault_of_our_own_keeps_its_traceback(call, monkeypatch):
    def broken(**_):
        raise ZeroDivisionError("bug")

    monkeypatch.setattr("lobula.bench.measure", broken)
    with pytest.raises(ZeroDivisionError):
        call("bench")


@pytest.mark.parametrize("arguments", [["run", "locked/clip.mp4"], ["export", "c", "--out", "locked/robot"]])
def test_a_folder_that_may_not_be_looked_into_is_one_line_and_2(call, monkeypatch, arguments):
    """Root may look into every folder, so the system's answer is put in its place."""
    stat = Path.stat

    def refused(path, **options):
        if "locked" in path.parts:
            raise PermissionError(errno.EACCES, "Permission denied", str(path))
        return stat(path, **options)

    monkeypatch.setattr(Path, "stat", refused)
    done = call(*arguments)
    assert done.code == 2
    assert done.err.count("\n") == 1
    assert f"{arguments[-1]}: no permission to look at it" in done.err
