"""What the board keeps of events, for viewers who come later."""

from __future__ import annotations

import pytest

from lobula.dashboard.board import MOST_EVENTS, MOST_RECORDED, Board
from lobula.dashboard.rows import Rows


@pytest.fixture
def board():
    return Board({}, Rows())


def alarm(number, phase="start"):
    return {"type": "collision", "phase": phase, "id": number}


def flash(phase):
    return {"type": "state", "state": "flash", "phase": phase}


def source(phase, **facts):
    return {"type": "source", "phase": phase, **facts}


def test_the_newest_events_are_kept(board):
    for number in range(MOST_EVENTS + 50):
        board.add_event(alarm(number))
    assert board.events.version == MOST_EVENTS + 50
    assert [r["id"] for r in board.events.records] == list(range(50, MOST_EVENTS + 50))


def test_collisions_are_counted_for_as_long_as_a_live_run_lasts(board):
    for number in range(MOST_EVENTS):
        board.add_event(alarm(number))
        board.add_event(alarm(number, "end"))
        board.add_event(flash("start"))
        board.add_event(flash("end"))
    assert len(board.events.records) == MOST_EVENTS
    assert board.events.collisions == MOST_EVENTS  # a quarter of them is still listed


def test_all_collisions_of_a_recording_are_listed_and_counted(board):
    records = [record for n in range(500) for record in (alarm(n), alarm(n, "end"))]
    board.replace_events(records)
    assert board.events.records == records
    assert board.events.collisions == 500
    board.replace_events(records[:2])  # other settings: the count is that of the new analysis
    assert board.events.collisions == 1


def test_states_of_a_recording_push_out_no_alarm(board):
    alarms = [alarm(1), alarm(1, "end")]
    flashes = [flash("start"), flash("end")] * MOST_RECORDED
    board.replace_events([*alarms, *flashes])
    assert board.events.records == [*alarms, *flashes[2 - MOST_RECORDED :]]
    assert board.events.collisions == 1


def test_more_collisions_than_a_page_can_list_are_still_counted(board):
    board.replace_events([alarm(n) for n in range(3 * MOST_RECORDED)])
    assert [r["id"] for r in board.events.records] == list(range(2 * MOST_RECORDED, 3 * MOST_RECORDED))
    assert board.events.collisions == 3 * MOST_RECORDED


def test_a_night_without_the_camera_leaves_the_alarms_of_the_day(board):
    board.add_event(alarm(1))
    board.add_event(source("lost", reason="cable out"))
    for attempt in range(1, 5000):
        board.add_event(source("retry", attempt=attempt))
    board.add_event(source("back", attempt=5000))
    board.add_event(source("retry", attempt=1))  # of another loss
    assert board.events.records == [
        alarm(1), source("lost", reason="cable out"), source("retry", attempt=4999), source("back", attempt=5000),
        source("retry", attempt=1),
    ]  # fmt: skip
    assert board.events.version == 5003  # each of them was news to who looks
