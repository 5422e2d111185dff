"""Guessing tokens: slow whichever way it is done, and no way to keep others from their places."""

from __future__ import annotations

import asyncio
import threading
import time
from contextlib import suppress
from types import SimpleNamespace

import pytest
from websockets.exceptions import InvalidStatus

from lobula.dashboard import door
from lobula.dashboard.board import Board
from lobula.dashboard.rows import Rows
from lobula.dashboard.server import Site

from .stage import Watcher, ask, toml

TOKEN = "correct horse battery"
WRONG = {"Authorization": "Bearer wrong wrong wrong"}
RIGHT = {"Authorization": f"Bearer {TOKEN}"}


@pytest.fixture(scope="module")
def locked():
    with Site(Board({}, Rows()), toml, token=TOKEN) as site:
        yield site


def by_stream(site):
    with pytest.raises(InvalidStatus, match="403"), Watcher(site, additional_headers=WRONG):
        pass
    return 401


WAYS = {
    "header": lambda site: ask(site, "/", headers=WRONG).status,
    "header for a file": lambda site: ask(site, "/app.js", headers=WRONG).status,
    "header for settings": lambda site: ask(site, "/settings", "POST", {"restore": True}, WRONG).status,
    "link": lambda site: ask(site, "/?token=wrong").status,
    "form": lambda site: ask(site, "/login", "POST", "token=wrong").status,
    "stream": by_stream,
}


@pytest.mark.parametrize("way", WAYS)
def test_a_wrong_token_takes_a_moment(locked, way):
    begun_s = time.monotonic()
    assert WAYS[way](locked) == 401
    assert time.monotonic() - begun_s >= 0.5


def test_a_right_one_does_not_and_none_does_not(locked, monkeypatch):
    monkeypatch.setattr(door, "AFTER_WRONG_TOKEN_S", 3600.0)
    assert ask(locked, "/", headers=RIGHT).status == 200
    assert ask(locked, f"/?token={TOKEN.replace(' ', '%20')}").status == 200
    assert ask(locked, "/login", "POST", f"token={TOKEN.replace(' ', '+')}").status == 303
    assert ask(locked, "/").status == ask(locked, "/app.js").status == 401


def test_guesses_hold_few_places_and_tell_nothing_while_they_do(locked, monkeypatch):
    """Once as many wait as may, right and wrong tokens are answered alike; who has the cookie notices nothing."""
    over = threading.Event()

    async def until_over(duration_s):
        while not over.is_set():
            await asyncio.sleep(0.01)

    monkeypatch.setattr(door, "MOST_GUESSES", 2)
    monkeypatch.setattr(door, "asyncio", SimpleNamespace(sleep=until_over))
    cookie = {"Cookie": ask(locked, f"/?token={TOKEN.replace(' ', '%20')}").headers["set-cookie"].split(";")[0]}
    guesses = [threading.Thread(target=ask, args=(locked, "/"), kwargs={"headers": WRONG}) for _ in range(2)]
    for guess in guesses:
        guess.start()
    deadline_s = time.monotonic() + 20
    while ask(locked, "/app.js", headers=RIGHT).status != 429:
        assert time.monotonic() < deadline_s
    for headers in (RIGHT, WRONG):
        answer = ask(locked, "/app.js", headers=headers)
        assert (answer.status, answer.text) == (429, "too many wrong tokens come in: try again in a moment\n")
        assert ask(locked, "/login", "POST", f"token={headers['Authorization'][7:].replace(' ', '+')}").status == 429
        with pytest.raises(InvalidStatus, match="403"), Watcher(locked, additional_headers=headers):
            pass
    assert ask(locked, "/app.js", headers=cookie).status == 200
    assert ask(locked, "/").status == 401  # the page that asks for the token
    over.set()
    for guess in guesses:
        guess.join(20)
    assert not any(guess.is_alive() for guess in guesses)
    assert ask(locked, "/app.js", headers=RIGHT).status == 200


def test_who_does_not_wait_for_the_answer_is_nobodys_fault(locked, caplog):
    for _ in range(3):
        with suppress(Exception), Watcher(locked, additional_headers=WRONG, open_timeout=0.1):
            pass
    time.sleep(1.0)
    assert ask(locked, "/app.js", headers=RIGHT).status == 200
    assert caplog.records == []
