"""More connections than there are places: strangers are turned away, the detector keeps its file descriptors."""

from __future__ import annotations

import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import pytest
from websockets.exceptions import WebSocketException

from lobula.dashboard import prompt_http
from lobula.dashboard.board import Board
from lobula.dashboard.rows import Rows
from lobula.dashboard.server import Site

from .stage import Watcher, ask, toml

DETECTOR = """
import os, resource, sys, threading
resource.setrlimit(resource.RLIMIT_NOFILE, (200, 200))
from lobula.dashboard.board import Board
from lobula.dashboard.rows import Rows
from lobula.dashboard.server import Site

stop, refused = threading.Event(), 0
threading.Thread(target=lambda: (sys.stdin.read(), stop.set()), daemon=True).start()
with Site(Board({}, Rows()), lambda params: "") as site:
    print(site.port, flush=True)
    while not stop.wait(0.0005):  # a hook that opens files, as a detector has them
        try:
            os.close(os.open(os.devnull, os.O_RDONLY))
        except OSError:
            refused += 1
print(refused)
"""


@contextmanager
def idlers(port: int, count: int) -> Iterator[list[socket.socket]]:
    """Connections that say nothing, whether they are wanted or not."""
    with ExitStack() as stack:
        yield [stack.enter_context(socket.create_connection(("127.0.0.1", port), 20)) for _ in range(count)]


def is_open(connection: socket.socket) -> bool:
    connection.setblocking(False)
    try:
        return connection.recv(1) != b""
    except BlockingIOError:
        return True
    except OSError:
        return False


def eventually(true: Callable[[], Any]) -> Any:
    deadline_s = time.monotonic() + 30
    while not (found := true()):
        assert time.monotonic() < deadline_s, "waited in vain"
        time.sleep(0.02)
    return found


def gets_in(site: Site) -> bool:
    try:
        return ask(site, "/").status == 200
    except OSError:
        return False


def sees(site: Site) -> bool:
    try:
        with Watcher(site) as watcher:
            return "hello" in watcher.take().head
    except (OSError, EOFError, WebSocketException):
        return False


@pytest.fixture
def few_places(monkeypatch):
    monkeypatch.setattr(prompt_http, "MOST_CONNECTIONS", 6)
    monkeypatch.setattr(prompt_http, "REQUEST_S", 3600.0)  # nobody has to go while a slow machine counts


def test_as_many_as_there_are_places_stay_and_the_others_are_closed(few_places):
    with Site(Board({}, Rows()), toml) as site:
        with idlers(site.port, 50) as crowd:
            eventually(lambda: sum(map(is_open, crowd)) == 6)
            assert not gets_in(site)
            assert not sees(site)
        eventually(lambda: gets_in(site))
        assert sees(site)


def test_who_only_sits_there_has_to_go_and_viewers_get_in_again(few_places, monkeypatch):
    monkeypatch.setattr(prompt_http, "REQUEST_S", 1.0)
    with Site(Board({}, Rows()), toml) as site, idlers(site.port, 20):
        eventually(lambda: sees(site))


def test_viewers_have_places_too(few_places):
    with Site(Board({}, Rows()), toml) as site:
        with ExitStack() as stack:
            viewers = [stack.enter_context(Watcher(site)) for _ in range(6)]
            assert not gets_in(site)
            assert not sees(site)
            for viewer in viewers:
                assert "hello" in viewer.take().head  # nobody who is in is thrown out
        eventually(lambda: gets_in(site))


def test_strangers_leave_the_detector_its_file_descriptors():
    pytest.importorskip("resource", reason="this system has no limit to lower")
    program = [sys.executable, "-c", DETECTOR]
    with subprocess.Popen(program, stdin=-1, stdout=-1, stderr=-1, text=True) as detector:
        port = int(detector.stdout.readline())
        with idlers(port, 300) as crowd:
            eventually(lambda: sum(map(is_open, crowd)) <= prompt_http.MOST_CONNECTIONS)
            out, err = detector.communicate(timeout=30)
    assert (out, err) == ("0\n", "")
