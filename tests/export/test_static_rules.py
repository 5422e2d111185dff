"""What goes onto a robot keeps plain rules of embedded C: no recursion, heap, variable arrays, silent conversions."""

import re
import shutil
import subprocess
from graphlib import CycleError, TopologicalSorter

import pytest

from lobula.export import c_folder
from lobula.model.presets import preset

RULES = (
    "-Wconversion", "-Wsign-conversion", "-Wdouble-promotion", "-Wvla", "-Wshadow", "-Wundef", "-Wcast-qual",
    "-Wpointer-arith", "-Wstrict-prototypes", "-Wmissing-prototypes", "-Wswitch-enum", "-Wredundant-decls",
)  # fmt: skip
FORBIDDEN = re.compile(r"\b(goto|setjmp|longjmp|alloca|malloc|calloc|realloc|free|abort|exit)\b *\(?")
EDGE = re.compile(r'edge: { sourcename: "([^"]+)" targetname: "([^"]+)"')
NODE = re.compile(r'node: { title: "([^"]+)" label: "[^"]*\\n')
TABLE = "__indirect_call"
"""What gcc calls whatever is reached through a table of functions."""


@pytest.fixture(params=["paper", "lobula"])
def folder(request, tmp_path):
    for name, text in c_folder(preset(request.param), request.param, 99, 72, "lobula export c").items():
        if name != "main.c":  # the user's own
            (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def compile_in(folder, *flags):
    files = sorted(path.name for path in folder.glob("*.c"))
    return subprocess.run(
        ["cc", "-std=c99", *flags, "-c", *files], cwd=folder, capture_output=True, text=True, check=False
    )


def test_no_warning_of_the_strict_kind(folder, compiler):
    done = compile_in(folder, "-O2", "-Werror", *RULES)
    assert (done.returncode, done.stderr) == (0, "")


def test_no_heap_no_jumps_no_end_of_the_program(folder):
    for path in folder.glob("*.[ch]"):
        code = re.sub(r"/\*.*?\*/|//[^\n]*", " ", path.read_text(), flags=re.DOTALL)
        assert not FORBIDDEN.search(code), path.name


def calls_in(folder):
    """Function -> those it may call. Through a table whatever nobody calls by its name may be called."""
    done = compile_in(folder, "-O1", "-fno-inline", "-fcallgraph-info")
    if "-fcallgraph-info" in done.stderr:
        pytest.skip("the compiler draws no call graph")
    assert done.returncode == 0, done.stderr
    text = "".join(path.read_text() for path in folder.glob("*.ci"))
    calls = {name: set() for name in NODE.findall(text)}
    for caller, called in EDGE.findall(text):
        calls.setdefault(caller, set()).add(called)
    named = set().union(*calls.values())
    calls[TABLE] = {name for name in calls if name not in named and not name.startswith("lobula_")} - {TABLE}
    return calls


def test_nothing_calls_itself_by_whatever_way(folder, compiler):
    calls = calls_in(folder)
    assert len(calls) > 50
    assert TABLE in calls["network_frame"]
    assert any(name.startswith("sweep") for name in calls[TABLE])
    assert list(TopologicalSorter(calls).static_order())


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler: cc")
def test_a_recursion_would_be_found(tmp_path):
    (tmp_path / "a.c").write_text(
        "static int even(int n); static int odd(int n) { return n ? even(n - 1) : 0; }\n"
        "static int even(int n) { return n ? odd(n - 1) : 1; }\nint lobula_go(int n) { return even(n); }\n"
    )
    with pytest.raises(CycleError):
        list(TopologicalSorter(calls_in(tmp_path)).static_order())
