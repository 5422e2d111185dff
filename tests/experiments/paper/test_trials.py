"""One trial: what is counted of a trace, by hand, and what the table of trials holds."""

from __future__ import annotations

import csv
from dataclasses import replace

import numpy as np
import pytest

import lobula
from lobula.arena.world import World
from lobula.experiments.paper.courses import CourseParams, course
from lobula.experiments.paper.stage import Film
from lobula.experiments.paper.trials import About, as_csv, first_alarm_s, trial
from lobula.model.decision import DecisionParams
from lobula.types import NEURONS, TRACE_DTYPE

from .made import made

P = CourseParams()


class Scripted:
    """A network that gives a trace written beforehand."""

    params = lobula.preset("paper")

    def __init__(self, trace):
        self.trace = trace

    def reset(self):
        pass

    def run(self, images, times_s):
        return self.trace


def scripted(motion: str = "approach"):
    """An approach at 10 cm/s moves from 0.5 to 3.15 s; its window starts at 1.55 s."""
    drive = course(motion, 10.0, P, 2.0)
    times_s = drive.times_s(P, 30.0)
    trace = np.zeros(len(times_s), TRACE_DTYPE)
    trace["time_s"], trace["state"] = times_s, "ok"
    trace["lgmd1"] = trace["lgmd2"] = 0.5
    about = About(
        figure="fig5", course=drive, p=P, world=World(), seed=7, label="s80", reading="motor", setup="main"
    )  # fmt: skip
    film = Film(np.zeros((len(times_s), 72, 99), np.uint8), times_s, 1 / 30, "scene")
    return about, film, trace


def test_what_is_counted() -> None:
    about, film, trace = scripted()
    trace["spikes_lgmd1"][[30, 60, 61, 70, 94, 95, 97]] = [1, 2, 2, 1, 1, 1, 5]  # 1.0, 2.0, ... 3.13, 3.17, 3.23 s
    trace["lgmd1"][60] = 0.9
    trace["lptc_l"][50], trace["lptc_r"][50] = -0.4, 0.1
    one = trial(about, film, "paper", Scripted(trace))
    assert one.spikes["lgmd1"] == 2 + 2 + 1 + 1 + 1  # up to one frame after the motion
    assert one.spikes_course["lgmd1"] == 13
    assert one.fastest["lgmd1"] == 7  # the last three, within 200 ms
    assert one.burst_s["lgmd1"] == pytest.approx((97 - 30) / 30)
    assert one.burst_s["lgmd2"] == 0.0
    assert one.peak == {"lgmd1": 0.9, "lgmd2": 0.5, "lptc_r": 0.1, "lptc_l": -0.4}
    assert (one.seed, one.preset, one.scene_hash, one.motion) == (7, "paper", "scene", "approach")
    assert one.alarm_s is None
    assert one.end_s == pytest.approx(3.15)


def test_counts_by_name() -> None:
    one = made("fig5", "approach", {"lgmd1": 3, "lgmd2": 5, "lptc_r": 7, "lptc_l": 11})
    assert [one.count(name) for name in ("lgmd2", "busier", "lesser", "lptcs")] == [5, 5, 3, 18]


@pytest.mark.parametrize(
    ("neurons", "alarm_s"),
    [("lgmds", 62 / 30), ("all", 63 / 30)],
)
def test_who_decides_makes_the_alarm(neurons, alarm_s) -> None:
    _, _, trace = scripted()
    trace["spikes_lgmd1"][60:70] = trace["spikes_lgmd2"][60:70] = [2, 1, 1, 2, 2, 2, 2, 2, 2, 2]
    trace["spikes_lptc_r"][61] = 5  # 4 LGMD spikes do not win against 5, 6 do
    assert first_alarm_s(trace, DecisionParams(neurons=neurons)) == pytest.approx(alarm_s)
    trace["state"] = "turning"
    assert first_alarm_s(trace, DecisionParams(neurons=neurons)) is None


@pytest.mark.parametrize("neurons", ["all", "lgmds"])
def test_alarms_are_those_of_the_network_itself(neurons) -> None:
    movie = lobula.stimuli.translating(scene="arena", distance_cm=6.0)
    params = lobula.preset("paper")
    trace = lobula.Network(params).run(movie.images, movie.times_s)
    decision = replace(params.decision, neurons=neurons)
    called = lobula.Network(replace(params, decision=decision)).run(movie.images, movie.times_s)
    expected = called["time_s"][called["collision"]]
    assert first_alarm_s(trace, decision) == (expected[0] if len(expected) else None)


def test_the_table_has_a_row_a_trial_and_a_column_a_neuron() -> None:
    spikes = dict(zip(NEURONS, (1, 2, 3, 4), strict=True))
    rows = list(csv.DictReader(as_csv([made("fig5", "recession", spikes, seed=s) for s in (1, 2)]).splitlines()))
    assert [row["seed"] for row in rows] == ["1", "2"]
    assert [rows[0][f"spikes_{n}"] for n in NEURONS] == ["1", "2", "3", "4"]
    assert rows[0]["alarm_s"] == ""  # never
    assert rows[0]["settings_hash"] == "s"
