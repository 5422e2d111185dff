"""The systemd unit asks for what the command and its service do, and docs/live.md gives a reason for each setting."""

from __future__ import annotations

import re
import shlex

from lobula.frames import reconnect, timeline
from lobula.report import h264, kept, ring
from lobula.runtime import staleness
from lobula.runtime.interrupts import Interrupted
from lobula.runtime.service import BEAT_S

from .pages import ROOT
from .test_cli_page import options

UNIT = ROOT / "examples" / "lobula.service"
PAGE = (ROOT / "docs" / "live.md").read_text(encoding="utf-8")


def settings():
    lines = UNIT.read_text(encoding="utf-8").splitlines()
    return [tuple(line.split("=", 1)) for line in lines if "=" in line and not line.startswith("#")]


def test_every_setting_has_a_reason():
    obvious = {"Description", "Documentation", "Wants", "WantedBy", "OOMPolicy", "DevicePolicy", "ExecStart"}
    for name, _ in settings():
        assert name in obvious or f"`{name}=" in PAGE, name


def test_every_setting_of_the_table_is_in_the_unit():
    table = PAGE.split("| setting | why |")[1].split("\n\n")[0]
    given = {f"{name}={value}" for name, value in settings()}
    for cell in re.findall(r"`([A-Z]\w+=[^`]+)`", table.replace("After=` it", "After` it")):
        assert any(each.startswith(cell) for each in given), cell


def test_the_command_of_the_unit_exists():
    program, verb, source, *rest = shlex.split(dict(settings())["ExecStart"])
    assert (program.rpartition("/")[2], verb, source) == ("lobula", "run", "0")
    assert {word for word in rest if word.startswith("--")} <= options("run")


def test_the_watchdog_waits_for_many_beats_and_a_stop_is_no_failure():
    unit = dict(settings())
    assert int(unit["WatchdogSec"]) >= 10 * BEAT_S
    assert int(unit["SuccessExitStatus"]) == Interrupted(15).exit_code


def test_the_numbers_of_the_pages_are_those_of_the_code():
    assert (reconnect.FIRST_WAIT_S, reconnect.LONGEST_WAIT_S) == (0.25, 10.0)
    assert (timeline.BACK_S, timeline.AHEAD_S, timeline.WINDOW_S) == (1.0, 5.0, 30.0)
    assert (staleness.STALE_S, ring.MOST_BYTES) == (1.0, 64 * 2**20)
    assert h264.FRAGMENTED["frag_duration"] == "500000"
    assert kept.LONGEST_S == 600
