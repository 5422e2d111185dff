"""The page of a robot in a real browser: traces with the robot's thresholds, no picture, losses, wheels, a restart."""

from __future__ import annotations

import threading
from contextlib import closing

import pytest

pytest.importorskip("uvicorn", reason="the extra dashboard is not installed")

from lobula.dashboard.about import about_run
from lobula.dashboard.board import Board
from lobula.dashboard.robot_sink import RobotSink
from lobula.dashboard.rows import Rows
from lobula.dashboard.server import Site
from lobula.frames.selection import Selection
from lobula.runtime.header import robot_header
from lobula.runtime.outputs import Outputs
from lobula.runtime.robot import RobotStream
from lobula.runtime.robot_watch import follow_robot
from lobula.telemetry import parse_port

from ..dashboard.chromium import Chromium, find_chromium

PROGRAM = find_chromium()
pytestmark = pytest.mark.skipif(
    PROGRAM is None, reason="no chromium on this machine: the page is not seen in a browser"
)


def text(selector: str) -> str:
    return f"document.querySelector({selector!r}).innerText"


def test_what_a_viewer_sees(robot):
    robot.greet(thresholds=(0.6, 0.7, 0.2, -0.2))
    stream = RobotStream(parse_port(robot.port), Selection(), timeout_s=20)
    header = robot_header(stream)
    board = Board(about_run("robot", header, None), Rows(keep=1024))
    outputs = Outputs([RobotSink(board, stream)], lambda words: None)
    loop = threading.Thread(target=follow_robot, args=(stream, outputs, header))
    with closing(stream), Site(board, lambda params: "") as site, Chromium(PROGRAM) as browser:
        loop.start()
        page = browser.page(width=1280, height=800)
        page.open(site.url)
        robot.tell(1000, 1062)
        robot.tell(1065, 1070, sequence=1070)
        page.until(f"{text('#state')} === 'COLLISION'")
        page.until(f"{text('#figures')}.includes('stop\\nwheels')")
        page.until(f"{text('#figures')}.includes('2\\nlost')")
        assert page.js(text("#mode")) == "a robot, live"
        assert page.js(text("#name")) == robot.port
        assert page.js(text("#nothing")) == "A robot sends what it decides, and no pictures."
        assert page.js("document.querySelector('#layers').hidden")
        assert page.js("document.querySelector('#settings').hidden")
        assert page.js(text(".trace.lgmd2 .value")) == "0.87"
        assert page.js("document.querySelector('.trace.lgmd1').classList.contains('over')")
        page.until(f"{text('#list')}.includes('Collision 1')")
        robot.tell(0, 5)
        page.until(f"{text('#list')}.toLowerCase().includes('robot switched on anew')")
        page.until(f"{text('#state')} === 'stale'")  # nothing more is said
        stream.close()
        loop.join(10)
        assert page.complaints() == []
    assert not loop.is_alive()
