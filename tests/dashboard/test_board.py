"""What the board keeps of events, for viewers who come later."""

from __future__ import annotations

import pytest

from lobula.dashboard.board import MOST_EVENTS, Board
from lobula.dashboard.rows import Rows


@pytest.fixture
def board():
    return Board({}, Rows())


def alarm(number):
    return {"type": "collision", "phase": "start", "id": number}


def source(phase, **facts):
    return {"type": "source", "phase": phase, **facts}


def test_the_newest_events_are_kept(board):
    for number in range(MOST_EVENTS + 50):
        board.add_event(alarm(number))
    version, records = board.events
    assert version == MOST_EVENTS + 50
    assert [r["id"] for r in records] == list(range(50, MOST_EVENTS + 50))


def test_a_night_without_the_camera_leaves_the_alarms_of_the_day(board):
    board.add_event(alarm(1))
    board.add_event(source("lost", reason="cable out"))
    for attempt in range(1, 5000):
        board.add_event(source("retry", attempt=attempt))
    board.add_event(source("back", attempt=5000))
    board.add_event(source("retry", attempt=1))  # of another loss
    assert board.events[1] == [
        alarm(1), source("lost", reason="cable out"), source("retry", attempt=4999), source("back", attempt=5000),
        source("retry", attempt=1),
    ]  # fmt: skip
    assert board.events[0] == 5003  # each of them was news to who looks
