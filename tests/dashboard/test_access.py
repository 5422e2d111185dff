"""Who gets in: names, addresses, tokens."""

from __future__ import annotations

import socket

import pytest

from lobula.dashboard.access import access_to, host_name, is_loopback
from lobula.errors import ParameterError


@pytest.mark.parametrize(
    ("host", "name"),
    [("LocalHost:80", "localhost"), ("127.0.0.1", "127.0.0.1"), ("[::1]:8040", "::1"), ("::1", "::1"), ("", "")],
)
def test_the_name_in_a_host(host, name):
    assert host_name(host) == name


@pytest.mark.parametrize(
    ("host", "local"),
    [("127.0.0.1", True), ("127.9.9.9", True), ("::1", True), ("localhost", True), ("0.0.0.0", False), ("::", False),
     ("192.168.1.7", False), ("localhost.evil.example", False)],
)  # fmt: skip
def test_what_only_this_machine_reaches(host, local):
    assert is_loopback(host) is local


@pytest.mark.parametrize(
    ("named", "allowed"),
    [("127.0.0.1:8040", True), ("localhost", True), ("[::1]:8040", True), ("localhost:9999", True),
     ("evil.example", False), ("127.0.0.1.evil.example", False), ("192.168.1.7", False), ("localhost.", False),
     ("", False)],
)  # fmt: skip
def test_names_on_loopback(named, allowed):
    assert access_to("127.0.0.1", 8040, None).names_this(named) is allowed


@pytest.mark.parametrize(
    ("named", "allowed"),
    [("192.168.1.7:8040", True), ("[fe80::1]:8040", True), ("robot.example:1", True), ("evil.example", False),
     (socket.gethostname(), True), (socket.gethostname().upper() + ".local:8040", True)],
)  # fmt: skip
def test_names_away_from_loopback(named, allowed):
    assert access_to("0.0.0.0", 8040, None, ["Robot.example"]).names_this(named) is allowed


def test_a_token_is_needed_away_from_loopback_only():
    assert access_to("127.0.0.1", 8040, None).opened_by()
    made = access_to("0.0.0.0", 8040, None)
    assert made.token is not None
    assert len(made.token) >= 24
    assert made.token != access_to("0.0.0.0", 8040, None).token
    assert not made.opened_by()


def test_a_token_is_needed_on_loopback_too_where_a_proxy_has_another_name():
    made = access_to("127.0.0.1", 8040, None, ["cam.example.org"])
    assert made.token is not None
    assert len(made.token) >= 24
    assert not made.opened_by()
    assert not made.names_this("192.168.1.7")  # nobody but the proxy comes here
    assert access_to("127.0.0.1", 8040, "correct horse", ["cam.example.org"]).token == "correct horse"


def test_the_token_and_its_cookie_open():
    access = access_to("127.0.0.1", 8040, "correct horse")
    assert access.opened_by(token="correct horse")
    assert access.opened_by(session=access.session)
    assert not access.opened_by(token="correct hors")
    assert not access.opened_by(token=access.session, session="correct horse")
    assert not access.opened_by(token="", session="")
    assert not access.opened_by(token="corr\u00e9ct horse")
    assert "correct" not in access.session
    assert access.session == access_to("0.0.0.0", 8040, "correct horse").session  # a restart keeps viewers in


@pytest.mark.parametrize("token", ["", "short", "correct\nhorse battery", "naïve naïve naïve"])
def test_a_poor_token_is_refused(token):
    with pytest.raises(ParameterError, match="must be at least 12, ASCII"):
        access_to("127.0.0.1", 8040, token)
