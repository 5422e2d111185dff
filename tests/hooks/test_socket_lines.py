"""Records over TCP and Unix sockets, with peers that listen, hang up, fall asleep and come back."""

from __future__ import annotations

import socket
import threading

import pytest

from lobula.hooks import make_hook, stream

from .listeners import LineServer, free_port
from .office import END, START, SUMMARY, delivered, event, opened, reading, wait_until


@pytest.fixture(params=["tcp", "unix"])
def at(request, tmp_path):
    return ("127.0.0.1", free_port()) if request.param == "tcp" else str(tmp_path / "s")


def target(at):
    return f"unix:{at}" if isinstance(at, str) else f"tcp:{at[0]}:{at[1]}"


def test_a_header_then_every_record(at):
    server = LineServer(at)
    tally = delivered(make_hook(target(at)), START, END, readings=[reading(0.0), reading(0.1), reading(0.2)])
    wait_until(lambda: server.ends)
    (records,) = server.records
    assert [r["type"] for r in records] == ["header", "reading", "reading", "collision", "collision", "summary"]
    assert records[3] == START | {"unix_s": records[3]["unix_s"]}
    assert tally == {"hook": target(at), "sent": 5, "dropped": 0, "failures": 0}
    server.close()


def test_a_peer_that_dies_and_comes_back(at, tmp_path):
    server = LineServer(at)
    office = opened(make_hook(target(at)))
    office.event(event(0))
    wait_until(lambda: server.records and len(server.records[0]) == 2)
    server.close()
    office.event(event(1))
    wait_until(lambda: office.tallies()[0]["failures"])
    (tmp_path / "s").unlink(missing_ok=True)
    server = LineServer(at)
    office.event(event(2))
    office.close(SUMMARY)
    wait_until(lambda: server.ends)
    records = server.records[-1]
    assert [r.get("frame") for r in records] == [None, 1, 2, None]
    assert records[0]["type"] == "header"  # whoever comes back is told what this is
    start, end = office.news()
    assert (start["phase"], end["phase"], end["dropped"]) == ("start", "end", 0)
    server.close()


def test_nobody_listens(at):
    says = {"unix": "No such file or directory", "tcp:": "Connection refused"}[target(at)[:4].rstrip()]
    tally = delivered(make_hook(target(at)), START)
    assert (tally["sent"], tally["dropped"], tally["problem"]) == (0, 2, says)


def test_a_peer_that_never_reads(at, monkeypatch):
    monkeypatch.setattr(stream, "TIMEOUT_S", 0.1)
    server = LineServer(at, reads=False)
    hook = make_hook(target(at))
    office = opened(hook, close_s=0.05)
    big = event(0) | {"text": "x" * 60_000}  # fills any buffer of the system soon
    for _ in range(3000):
        office.event(big)
    (post,) = office._posts
    assert len(post._mailbox) <= hook.events_kept
    wait_until(lambda: office.tallies()[0]["failures"])
    office.close(SUMMARY)
    (tally,) = office.tallies()
    assert tally["sent"] + tally["dropped"] == 3001
    assert tally["dropped"] >= 1000
    assert "timed out" in tally["problem"]
    server.close()


def test_what_a_peer_says_is_thrown_away(at):
    server = LineServer(at)
    office = opened(make_hook(target(at)))
    office.event(event(0))
    wait_until(lambda: server._open)
    server._open[0].sendall(b"hello" * 10_000)
    for number in range(1, 20):
        office.event(event(number))
    office.close(SUMMARY)
    assert office.tallies()[0]["failures"] == 0
    server.close()


def test_a_host_that_nobody_knows(monkeypatch):
    def unknown(*_, **__):
        raise socket.gaierror(-2, "Name or service not known")

    monkeypatch.setattr(socket, "getaddrinfo", unknown)
    assert delivered(make_hook("tcp:nowhere.invalid:9000"), START)["problem"] == "Name or service not known"


def test_a_name_server_that_never_answers_holds_up_nobody(monkeypatch):
    asked, go = threading.Event(), threading.Event()

    def ask(*_, **__):
        asked.set()
        go.wait(60)
        raise socket.gaierror(-3, "Temporary failure in name resolution")

    monkeypatch.setattr(socket, "getaddrinfo", ask)
    office = opened(make_hook("tcp:robot.example:9000"), close_s=0.05)
    office.event(START)
    assert asked.wait(30)
    office.close(SUMMARY)
    assert not go.is_set()
    assert office.tallies()[0] | {"hook": ""} == {
        "hook": "", "sent": 0, "dropped": 2, "failures": 0, "problem": "not delivered before the end",
    }  # fmt: skip
    go.set()


def test_an_ipv6_address():
    if not socket.has_ipv6:
        pytest.skip("this system has no IPv6")
    try:
        with socket.create_server(("::1", 0), family=socket.AF_INET6) as server:
            name = f"tcp:[::1]:{server.getsockname()[1]}"
            assert delivered(make_hook(name), START) == {"hook": name, "sent": 2, "dropped": 0, "failures": 0}
    except OSError:
        pytest.skip("this system has no IPv6 on loopback")
