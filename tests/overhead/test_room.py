from __future__ import annotations

import math

import numpy as np
import pytest

from lobula.errors import ParameterError
from lobula.overhead import Room, parse_room


def test_a_room_as_text_and_back():
    assert parse_room("70x55") == Room(70.0, 55.0) == Room()
    assert parse_room(" 140.5 X 80 cm") == Room(140.5, 80.0)
    assert parse_room("circle:35") == Room(70.0, 70.0, "circle")
    assert [str(parse_room(text)) for text in ("70x55", "circle:35")] == ["70x55", "circle:35"]


@pytest.mark.parametrize("text", ["", "70", "70x", "70x55x3", "circle", "-70x55", "7x55", "circle:3", "70x90000"])
def test_no_room(text):
    with pytest.raises(ParameterError, match="room '"):
        parse_room(text)


def test_how_far_outside():
    box, circle = Room(10.0, 8.0), Room(10.0, 10.0, "circle")
    x, y = np.array([5.0, 1.0, 11.0, 5.0]), np.array([4.0, 4.0, 4.0, -2.5])
    assert box.outside_cm(x, y).tolist() == [-4.0, -1.0, 1.0, 2.5]
    assert circle.outside_cm(np.array([5.0, 8.0]), np.array([5.0, 9.0])).tolist() == [-5.0, 0.0]


def test_along_the_wall_runs_once_round_the_room():
    box, circle = Room(10.0, 8.0), Room(10.0, 10.0, "circle")
    x, y = np.array([2.0, 10.0, 7.0, 0.0]), np.array([0.0, 3.0, 8.0, 6.0])
    assert box.along_cm(x, y).tolist() == [2.0, 13.0, 21.0, 30.0]  # 10, 10 + 8, 10 + 8 + 10 before the last three
    assert circle.along_cm(np.array([10.0, 5.0]), np.array([5.0, 10.0])) == pytest.approx([0.0, 2.5 * math.pi])


def test_corners_run_counter_clockwise_from_the_origin():
    assert Room(10.0, 8.0).corners_cm.tolist() == [[0, 0], [10, 0], [10, 8], [0, 8]]
