"""What a service manager reads from its socket; a Unix socket of the test stands in for systemd's."""

from __future__ import annotations

import socket
import sys

import pytest

from lobula.runtime import service as services
from lobula.runtime.service import Service, find_service


class Now:
    now = 100.0

    def monotonic(self):
        return self.now


@pytest.fixture
def manager(tmp_path):
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as listener:
        listener.bind(str(tmp_path / "notify"))
        listener.settimeout(0.2)
        yield listener


def heard(listener):
    told = []
    while True:
        try:
            told.append(listener.recv(4096).decode())
        except TimeoutError:
            return told


def test_ready_with_the_first_frame_alive_once_a_second_and_stopping(manager, monkeypatch):
    now = Now()
    monkeypatch.setattr(services, "time", now)
    service = Service(manager.getsockname())
    service.beat(lambda: "waiting", ready=False)
    service.beat(lambda: "first", ready=True)
    for _ in range(9):
        now.now += 0.1
        service.beat(lambda: "too soon", ready=True)
    now.now += 0.2
    service.beat(lambda: "later", ready=False)
    service.stop()
    assert heard(manager) == [
        "WATCHDOG=1\nSTATUS=waiting", "READY=1", "WATCHDOG=1\nSTATUS=later", "STOPPING=1\nSTATUS=closing files",
    ]  # fmt: skip


def test_words_are_made_only_when_they_are_told(manager):
    def fault():
        raise AssertionError

    service = Service(manager.getsockname())
    service.beat(lambda: "first", ready=True)
    service.beat(fault, ready=True)
    service.stop()


def test_a_manager_that_is_gone_is_no_fault(tmp_path):
    service = Service(str(tmp_path / "nobody"))
    service.beat(lambda: "words", ready=True)
    service.stop()


@pytest.mark.parametrize("environment", [{}, {"NOTIFY_SOCKET": ""}, {"NOTIFY_SOCKET": "vsock:2:1"}])
def test_nobody_to_tell(environment):
    assert find_service(environment) is None


@pytest.mark.skipif(sys.platform != "linux", reason="Linux alone has such names")
def test_a_name_outside_the_file_system():
    name = "lobula test of services"
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as listener:
        listener.bind(f"\0{name}")
        listener.settimeout(0.2)
        service = find_service({"NOTIFY_SOCKET": f"@{name}"})
        assert service is not None
        service.stop()
        assert heard(listener) == ["STOPPING=1\nSTATUS=closing files"]
