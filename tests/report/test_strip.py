"""The strip: curves at the height and time they should have, ticks for spikes, collisions shaded."""

import numpy as np
import pytest
from numpy.typing import NDArray

from lobula.report.canvas import rgb
from lobula.report.palette import DARK, thresholds
from lobula.report.strip import SPAN_S, STRIP_HEIGHT, Strip
from lobula.types import NEURONS, Reading, Spikes

WIDTH = 640
# The layout: a head of 40 rows, then 60 for each neuron (40 for its trace, 14 for its spikes); plots 522 columns wide.
LEFT, RIGHT = 108, 629
TOPS = {"lgmd1": 40, "lgmd2": 100, "lptc_r": 160, "lptc_l": 220}


def drawn(readings: list[Reading]) -> NDArray[np.uint8]:
    strip = Strip(WIDTH, thresholds({}))
    for index, reading in enumerate(readings):
        strip.push(index, reading)
    canvas = np.zeros((STRIP_HEIGHT, WIDTH, 3), np.uint8)
    strip.draw(canvas)
    return canvas


def steady(count: int = 91, hz: float = 30.0, **changes: float) -> list[Reading]:
    values = {"lgmd1": 0.5, "lgmd2": 0.5, "lptc_r": 0.0, "lptc_l": 0.0, **changes}
    return [Reading(k / hz, **values, spikes=Spikes(), collision=False, state="ok") for k in range(count)]


def rows_of(canvas: NDArray[np.uint8], neuron: str, column: int) -> list[int]:
    """Rows, from the top of a neuron's plot, that hold its full colour."""
    plot = canvas[TOPS[neuron] : TOPS[neuron] + 40, column].astype(int)
    return list(np.flatnonzero(np.abs(plot - rgb(DARK.neurons[neuron])).max(axis=1) < 60))


# 37 pixels for the range, 1 above it: 0.5 -> row 38, 0.75 -> 1 + 37/2, 1.0 -> row 1; LPTC-L hangs from its 0.
@pytest.mark.parametrize(
    ("neuron", "value", "row"),
    [
        ("lgmd1", 0.75, 19.5),
        ("lgmd2", 0.9, 8.4),
        ("lptc_r", 0.5, 19.5),
        ("lptc_r", 0.0, 38),
        ("lptc_l", -0.5, 19.5),
        ("lptc_l", -0.25, 10.25),
    ],
)
def test_potential_sets_the_row(neuron: str, value: float, row: float) -> None:
    canvas = drawn(steady(**{neuron: value}))
    for column in (LEFT + 5, 350, RIGHT):
        assert np.mean(rows_of(canvas, neuron, column)) == pytest.approx(row, abs=0.6)


def test_newest_is_at_the_right_and_old_ones_leave() -> None:
    readings = steady(200, lgmd1=0.95)
    readings[-1] = readings[-1]._replace(lgmd1=0.55)
    canvas = drawn(readings)
    assert np.mean(rows_of(canvas, "lgmd1", LEFT + 2)) < 8
    assert max(rows_of(canvas, "lgmd1", RIGHT)) > 30


def test_before_the_first_reading_there_is_nothing() -> None:
    canvas = drawn(steady(46))  # 1.5 s: half of the span
    empty = canvas[TOPS["lgmd1"] + 26 : TOPS["lgmd1"] + 39, LEFT : LEFT + 250]  # below the threshold's line
    assert (empty == rgb(DARK.panel)).all()
    assert rows_of(canvas, "lgmd1", LEFT + 280)


@pytest.mark.parametrize("hz", [10.0, 30.0, 120.0])
def test_a_spike_is_a_tick_at_its_time_and_more_are_taller(hz: float) -> None:
    count = round(SPAN_S * hz) + 1
    readings = steady(count, hz)
    one, many = count // 3, 2 * count // 3
    readings[one] = readings[one]._replace(spikes=Spikes(lgmd1=1))
    readings[many] = readings[many]._replace(spikes=Spikes(lgmd1=3))
    band = drawn(readings)[TOPS["lgmd1"] + 41 : TOPS["lgmd1"] + 54, LEFT : RIGHT + 1]
    inked = (band == rgb(DARK.neurons["lgmd1"])).all(axis=2)
    heights, columns = inked.sum(axis=0), np.flatnonzero(inked.any(axis=0))
    for index, height in ((one, 4), (many, 8)):  # 4 log2(1 + n)
        column = round((RIGHT - LEFT) * index / (count - 1))
        assert heights[column] == height
    assert len(columns) <= 10


def test_a_collision_is_shaded_while_it_lasts() -> None:
    readings = steady()
    for k in range(45, 60):
        readings[k] = readings[k]._replace(collision=True)
    row = drawn(readings)[TOPS["lgmd2"] + 30, LEFT : RIGHT + 1].astype(int)
    red = row[:, 0] > row[:, 1] + 40
    assert red[265:345].all()  # columns of the frames 46 to 59: 521/90 pixels each
    assert not red[:255].any()
    assert not red[355:].any()


def test_the_drawing_never_fails() -> None:
    rng = np.random.default_rng(5)
    for count in (1, 2, 3, 400):
        times_s = np.cumsum(rng.uniform(1e-6, 5.0, count)) - 3.0
        drawn(
            [
                Reading(
                    float(t),
                    *rng.uniform(0.5, 1, 2),
                    rng.random(),
                    -rng.random(),
                    Spikes(*map(int, rng.integers(0, 60, len(NEURONS)))),
                    bool(rng.random() < 0.5),
                    "flash",
                )
                for t in times_s
            ]
        )
