"""The event table."""

from __future__ import annotations

import numpy as np

from lobula.arena.contact import WALL, obstacle_code
from lobula.arena.events import EVENT_DTYPE, KINDS, NOTHING, RULES, event_table, name_of


def test_every_name_fits_its_column():
    for column, names in (("kind", KINDS), ("geometric", KINDS), ("rule", RULES)):
        assert max(map(len, names)) <= EVENT_DTYPE[column].itemsize // 4


def test_what_a_row_does_not_name_is_missing():
    row = event_table([{"tick": 7, "kind": "CP", "robot": 1}])[0]
    assert row["tick"] == 7
    assert row["kind"] == "CP"
    assert row["other"] == NOTHING
    assert np.isnan(row["miss_cm"])
    assert np.isnan(row["lgmd1"])
    assert not row["seen"]


def test_codes_in_words():
    names = [name_of(code) for code in (0, 6, WALL, obstacle_code(0), obstacle_code(3), NOTHING)]
    assert names == ["robot 0", "robot 6", "wall", "obstacle 0", "obstacle 3", "nothing"]


def test_an_empty_table_has_all_columns():
    assert event_table().dtype == EVENT_DTYPE
    assert len(event_table()) == 0
