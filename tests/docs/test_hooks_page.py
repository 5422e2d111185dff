"""docs/hooks.md: its targets are accepted, its programs run, its records have the fields that are written."""

from __future__ import annotations

import contextlib
import importlib.util
import io
import json
import re
import shlex
import threading
from pathlib import Path

import pytest

import lobula
from lobula.cli import main
from lobula.hooks import KINDS, make_hook
from lobula.report.grey_clip import write_grey_clip

from ..hooks.listeners import free_port
from ..hooks.office import wait_until
from .pages import ROOT, blocks, sections

PAGE = ROOT / "docs" / "hooks.md"
TEXT = PAGE.read_text(encoding="utf-8")


@pytest.fixture
def clip(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An approach as ``clip.mp4``, and the page's program, in the working folder."""
    movie = lobula.stimuli.looming(scene="arena")
    write_grey_clip(tmp_path / "clip.mp4", movie.images, movie.times_s.tolist(), movie.rate_hz)
    monkeypatch.chdir(tmp_path)
    (program,) = [block for block in blocks(PAGE, "sh") if block.startswith("#!")]
    Path("alarm.sh").write_text(program)
    Path("alarm.sh").chmod(0o755)


def targets() -> list[str]:
    commands = [line for block in blocks(PAGE, "sh") for line in block.splitlines() if line.startswith("lobula ")]
    words = [shlex.split(line) for line in commands]
    given = [one[i + 1] for one in words for i, word in enumerate(one) if word == "--hook"]
    links = re.findall(r"^\| `(mavlink:[^`]+)`", sections(PAGE)["What does an autopilot get?"], re.MULTILINE)
    return given + [link.replace("HOST:PORT", "host:14550") for link in links]


@pytest.mark.parametrize("target", targets())
def test_the_targets_are_accepted(clip: None, target: str) -> None:
    for scheme, library in (
        ("mqtt", "paho"),
        ("mavlink", "pymavlink"),
        ("foxglove", "foxglove"),
        ("mcap", "mcap"),
        ("rosbag", "rosbags"),
        ("rerun", "rerun"),
    ):
        if target.startswith(scheme) and importlib.util.find_spec(library) is None:
            pytest.skip(f"needs the extra {scheme}")
    assert make_hook(target).name


def test_the_table_names_every_kind() -> None:
    table = sections(PAGE)["Which hooks are there?"]
    for scheme in KINDS:
        assert re.search(rf"`{scheme}:", table), scheme


@pytest.mark.skipif(not Path("/proc/net/tcp").exists(), reason="needs /proc/net/tcp to see when it listens")
def test_the_listener_and_the_program_hear_the_alarm(clip: None) -> None:
    (code,) = blocks(PAGE, "python")
    port = free_port()
    said = io.StringIO()
    names: dict[str, object] = {"print": lambda *words: said.write(" ".join(map(str, words)))}
    thread = threading.Thread(target=exec, args=(code.replace("9000", str(port)), names), daemon=True)
    thread.start()
    wait_until(lambda: listens(port))
    with contextlib.redirect_stderr(io.StringIO()):
        done = main(
            ["run", "clip.mp4", "--hook", f"tcp:127.0.0.1:{port}", "--hook", "exec:./alarm.sh 'all alarms.txt'"]
        )
    assert done == 0
    thread.join(30)
    frame = json.loads(Path("all alarms.txt").read_text())["frame"]
    assert re.fullmatch(rf"(stop!|an alarm of [\d.]+ s ago) {frame}", said.getvalue())


def listens(port: int) -> bool:
    """Whether someone listens there, without calling: the listener takes one call only."""
    return any(f":{port:04X} " in line and " 0A " in line for line in Path("/proc/net/tcp").read_text().splitlines())


def test_the_example_records_have_the_fields_that_are_written(clip: None) -> None:
    dead = f"tcp:127.0.0.1:{free_port()}"
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        assert main(["run", "clip.mp4", "--json", "--hook", "ndjson:out", "--hook", dead]) == 0
    records = [json.loads(line) for line in [*Path("out").read_text().splitlines(), *printed.getvalue().splitlines()]]
    written = {(r["type"], r.get("phase")): set(r) for r in records if "unix_s" in r or r["type"] == "hook"}
    examples = [json.loads(line) for block in blocks(PAGE, "json") for line in block.splitlines()]
    tally = next(example for example in examples if "type" not in example)
    assert set(tally) == set(records[-1]["hooks"][1])
    over = {"type", "hook", "phase", "failures", "dropped", "frame", "time_s"}
    for example in examples:
        if example is not tally:
            kind = (example["type"], example.get("phase"))
            assert set(example) == (over if kind == ("hook", "end") else written[kind])
