"""Rows: numbered for good, the oldest go where only some are kept, a new beginning is told apart."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lobula.dashboard.rows import ROW, Rows, columns, rows_of
from lobula.types import Reading, Spikes

from ..report.approach import table


def reading(number: int) -> Reading:
    return Reading(number / 10, 0.5, 0.75, 0.25, -0.25, Spikes(0, 1, 300, 3), number % 2 == 1, "flash")


def some(first: int, count: int):
    rows = np.zeros(count, ROW)
    rows["frame"] = np.arange(first, first + count)
    return rows


def test_a_reading_as_a_row():
    rows = Rows()
    rows.append(7, reading(3))
    _, first, (row,) = rows.since(0, 0, 10)
    assert (first, row["time_s"], row["frame"], row["collision"]) == (0, 0.3, 7, 1)
    assert row["potentials"].tolist() == [0.5, 0.75, 0.25, -0.25]
    assert row["spikes"].tolist() == [0, 1, 255, 3]  # a byte each
    assert row["state"] == 3  # the place of flash in STATES


@given(keep=st.integers(1, 9), chunks=st.lists(st.integers(1, 5), max_size=30), asked=st.integers(0, 120))
def test_kept_rows_are_the_newest_and_keep_their_numbers(keep, chunks, asked):
    rows, end = Rows(keep), 0
    for count in chunks:
        count = min(count, keep)
        rows.put(end, some(end, count))
        end += count
    version, first, found = rows.since(0, asked, 1000)
    assert version == 0
    assert found["frame"].tolist() == list(range(first, end))
    assert first == end or first >= asked
    _, oldest, every = rows.since(0, 0, 1000)
    assert min(keep, end) <= len(every) <= 2 * keep
    assert first == min(max(asked, oldest), end)


def test_all_rows_are_kept_where_nothing_is_said():
    rows = Rows()
    for first in range(0, 5000, 500):
        rows.put(first, some(first, 500))
    assert rows.since(0, 0, 10_000)[2]["frame"].tolist() == list(range(5000))
    assert rows.since(0, 4990, 4)[2]["frame"].tolist() == [4990, 4991, 4992, 4993]


def test_rows_are_laid_over_those_that_are_there():
    rows = Rows()
    rows.put(0, some(0, 6))
    rows.put(2, some(100, 2))
    assert rows.since(0, 0, 10)[2]["frame"].tolist() == [0, 1, 100, 101, 4, 5]


def test_a_new_beginning_is_given_from_its_start():
    rows = Rows()
    rows.put(0, some(0, 6))
    rows.restart()
    rows.put(0, some(50, 2))
    version, first, found = rows.since(0, 6, 10)
    assert (version, first, found["frame"].tolist()) == (1, 0, [50, 51])
    assert rows.since(1, 2, 10)[1:][0] == 2


def test_a_trace_as_rows():
    trace = table()
    rows = rows_of(trace)
    np.testing.assert_array_equal(rows["time_s"], trace["time_s"])
    np.testing.assert_array_equal(rows["spikes"][:, 3], trace["spikes_lptc_l"])
    assert rows["potentials"][:, 1] == pytest.approx(trace["lgmd2"])
    assert rows["state"][:4].tolist() == [1, 1, 1, 0]  # warming up is the second of STATES


def test_columns_are_laid_one_after_the_other():
    rows = some(4, 3)
    rows["time_s"], rows["collision"] = [0.5, 1.5, 2.5], [0, 1, 0]
    data = columns(rows)
    assert len(data) == 3 * (8 + 4 + 16 + 4 + 1 + 1)
    assert np.frombuffer(data, "<f8", 3).tolist() == [0.5, 1.5, 2.5]
    assert np.frombuffer(data, "<u4", 3, 24).tolist() == [4, 5, 6]
    assert list(data[-3:]) == [0, 1, 0]
