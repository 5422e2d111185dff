"""A run in the words of ROS: what is how serious."""

from __future__ import annotations

import pytest

from lobula.hooks import ros_words as words

from .office import END, START, SUMMARY, event

AT = {"frame": 1, "time_s": 0.1}


@pytest.mark.parametrize(
    ("record", "level"),
    [
        (START, 2),
        (END, 0),
        (event(1), 1),
        ({"type": "state", "state": "stale", "phase": "start", **AT}, 3),
        ({"type": "state", "state": "stale", "phase": "end", **AT}, 0),
        ({"type": "source", "phase": "lost", "reason": "no answer", **AT}, 3),
        ({"type": "source", "phase": "back", **AT}, 0),
        ({"type": "hook", "hook": "tcp:h:1", "phase": "start", "problem": "no answer", **AT}, 1),
        (SUMMARY, 0),
    ],
)
def test_levels_of_events(record, level):
    status = words.status(record)
    assert status.level == level
    assert dict(status.values) == {key: str(value) for key, value in record.items()}


def test_what_is_said_of_a_hook():
    record = {"type": "hook", "hook": "ros2", "phase": "start", "problem": "no answer", **AT}
    assert words.status(record).message == "hook ros2 start: no answer"


@pytest.mark.parametrize(
    ("collision", "state", "level"),
    [(True, "ok", 2), (False, "ok", 0), (False, "flash", 1), (False, "stale", 3), (False, "warming_up", 1)],
)
def test_levels_of_readings(collision, state, level):
    assert words.reading_status({"collision": collision, "state": state}).level == level
