"""A saved trace on the page: all of its collisions, however many, and nothing that the page could not show."""

from __future__ import annotations

import numpy as np
import pytest

from lobula.dashboard.about import board_of_trace
from lobula.dashboard.server import Site
from lobula.errors import ParameterError
from lobula.runtime.events import collisions_of
from lobula.types import NEURONS, TRACE_DTYPE

from .stage import Watcher, toml


def trace(seconds):
    """Frames at 10 Hz; in the first of every second an alarm, in the third and fourth a flash."""
    rows = np.zeros(10 * seconds, TRACE_DTYPE)
    rows["frame"] = np.arange(len(rows))
    rows["time_s"] = rows["frame"] / 10
    rows["collision"] = rows["frame"] % 10 == 0
    rows["state"] = np.where(np.isin(rows["frame"] % 10, [2, 3]), "flash", "ok")
    return rows


def test_a_long_one_tells_every_collision():
    rows = trace(500)
    assert len(collisions_of(rows)) == 500  # what `lobula run` counts
    with Site(board_of_trace(rows, {}, "long.npz"), toml) as site, Watcher(site) as watcher:
        head = watcher.until(lambda m: "events" in m.head).head
    assert head["collisions"] == 500
    listed = [e["id"] for e in head["events"] if e["type"] == "collision" and e["phase"] == "start"]
    assert listed == list(range(1, 501))


@pytest.mark.parametrize("column", ["time_s", *NEURONS])
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_value_that_is_not_finite_is_refused(column, value):
    rows = trace(1)
    rows[column][[3, 5]] = value
    with pytest.raises(ParameterError) as refused:
        board_of_trace(rows, {}, "runs/night.csv")
    assert str(refused.value) == f"trace runs/night.csv: column {column}, row 4: {value}: must be finite"


def test_the_page_is_called_as_the_file():
    assert board_of_trace(trace(1), {}, "runs/night.csv").about["name"] == "night.csv"
