"""Alarms begun at several phases of a frame: what is told of them, by hand, and one movie seen through."""

import math

import pytest

from lobula.experiments.phases import alarms, differ, shift_s, spread_s
from lobula.model.presets import preset
from lobula.stimuli.battery import battery


def test_spread_is_from_the_first_to_the_last():
    assert spread_s([2.5, None, 2.0, 2.25]) == 0.5
    assert math.isnan(spread_s([None, None]))


def test_shift_is_between_means_of_what_is_there():
    assert shift_s([1.0, None, 2.0], [1.0, 1.25]) == pytest.approx(0.375)
    assert math.isnan(shift_s([None], [1.0]))


def test_phases_at_which_one_alone_alarms_are_counted():
    assert differ([1.0, None, None, 2.0], [1.5, 1.0, None, None]) == 2


def test_a_later_start_is_taken_out_of_its_alarm():
    case = next(case for case in battery() if case.name == "looming-dark-8cm_s")
    found = alarms(case, preset(), 30.0, 2)
    assert spread_s(found.all_s) < 0.2  # the paper's six frames
    assert differ(found.all_s, found.lgmds_s) == 0
