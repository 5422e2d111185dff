from __future__ import annotations

import math

import numpy as np
import pytest

from lobula.overhead import TRACK_DTYPE
from lobula.overhead.gaps import bridged, plausible


def rows(*, frame, x, heading=0.0):
    table = np.zeros(len(frame), TRACK_DTYPE)
    table["frame"], table["time_s"], table["id"] = frame, np.array(frame) / 10, 4
    table["x_cm"], table["heading_rad"], table["found"] = x, heading, True
    return table


FRAMES = np.arange(20)
TIMES_S = FRAMES / 10


def test_a_short_gap_by_hand():
    """Seen at 0.2 s and 0.5 s: a third and two thirds of the way between them; the heading goes through pi."""
    whole = bridged(rows(frame=[1, 2, 5], x=[0.0, 1.0, 4.0], heading=[0, 3.0, -3.0]), FRAMES, TIMES_S, 0.5)
    assert whole["frame"].tolist() == [1, 2, 3, 4, 5]
    assert whole["found"].tolist() == [True, True, False, False, True]
    assert whole["x_cm"] == pytest.approx([0, 1, 2, 3, 4])
    step = (2 * math.pi - 6) / 3
    assert whole["heading_rad"] == pytest.approx([0, 3, 3 + step, -3 - step, -3])
    assert (whole["id"] == 4).all()
    assert whole["time_s"] == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.5])
    assert np.isnan(whole["error_cm"]).tolist() == [False, False, True, True, False]


def test_a_long_gap_stays():
    whole = bridged(rows(frame=[1, 2, 9], x=[0.0, 1.0, 4.0]), FRAMES, TIMES_S, 0.5)
    assert whole["frame"].tolist() == [1, 2, 9]


def test_nothing_before_the_first_sighting_nor_after_the_last():
    whole = bridged(rows(frame=[7], x=[1.0]), FRAMES, TIMES_S, 0.5)
    assert whole["frame"].tolist() == [7]


def test_one_wild_sighting_is_not_believed():
    """10 cm in a tenth of a second is 100 cm/s; there and back again in two."""
    wild = rows(frame=[0, 1, 2, 3, 4], x=[0.0, 1.0, 30.0, 2.0, 3.0])
    assert plausible(wild, 100.0).tolist() == [True, True, False, True, True]
    assert plausible(wild[[2, 3, 4]], 100.0).tolist() == [False, True, True]  # at the beginning
    assert plausible(wild[[0, 1, 2]], 100.0).tolist() == [True, True, False]  # at the end


def test_a_robot_that_was_carried_is_believed():
    assert plausible(rows(frame=[0, 1, 2, 3], x=[0.0, 1.0, 30.0, 31.0]), 100.0).all()
    assert plausible(rows(frame=[0, 1], x=[0.0, 30.0]), 100.0).all()  # two cannot tell which is wrong
