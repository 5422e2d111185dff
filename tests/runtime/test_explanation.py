"""What an explanation says must be what the network did."""

from __future__ import annotations

import numpy as np
import pytest

import lobula
from lobula.errors import ParameterError
from lobula.model.network import TAPS
from lobula.runtime.explanation import explain

from .readings import LiveSource

MOVIES = {
    "approach": lobula.stimuli.looming(scene="arena"),
    "passing": lobula.stimuli.translating(scene="arena"),
    "recession": lobula.stimuli.receding(scene="arena"),
}


def explained(movie, at_s, **preset):
    with lobula.open(movie) as source:
        return explain(source, lobula.Network(lobula.preset(**preset)), at_s)


@pytest.mark.parametrize("neurons", ["all", "lgmds", "lgmd2"])
@pytest.mark.parametrize("name", MOVIES)
def test_all_conditions_hold_exactly_when_the_rule_held(name, neurons):
    movie = MOVIES[name]
    net = lobula.Network(lobula.preset(neurons=neurons))
    held = []
    for frame in movie.frames():
        net.step(frame)
        held.append(net.state_dict()["held_s"] == frame.time_s)
    moments = sorted({*range(0, len(movie), 12), *(np.flatnonzero(np.diff(held)) + 1), *np.flatnonzero(np.diff(held))})
    for index in moments:
        found = explained(movie, movie.times_s[index], neurons=neurons)
        assert found.frame.index == index
        if found.advanced:
            assert all(c.holds for c in found.conditions) == held[index], (index, found.conditions)


def test_the_reading_and_the_maps_are_those_of_the_run():
    movie, net = MOVIES["approach"], lobula.Network()
    readings = [net.step(frame, taps=TAPS) for frame in movie.frames()]
    found = explained(movie, movie.times_s[100])
    assert found.reading[:8] == readings[100][:8]
    for name in TAPS:
        assert np.array_equal(found.reading.taps[name], readings[100].taps[name])
        assert found.layers[name].peak == np.abs(readings[100].taps[name]).max()


def test_the_window_holds_the_last_200_ms_spike_by_spike():
    movie, net = MOVIES["passing"], lobula.Network()
    readings = [net.step(frame) for frame in movie.frames()]
    found = explained(movie, movie.times_s[60])
    last_six = readings[55:61]  # 6 ticks of 1/30 s are 200 ms; each step is one tick, so spikes count once
    assert [w.lgmd1 for w in found.window] == pytest.approx([r.spikes.lgmd1 for r in last_six])
    assert [w.lptc for w in found.window] == pytest.approx([max(r.spikes.lptc_r, r.spikes.lptc_l) for r in last_six])
    sums = [sum(r.spikes.lgmd1 for r in last_six), sum(r.spikes.lgmd2 for r in last_six)]
    assert found.lgmd == pytest.approx(min(sums))


def test_a_turn_keeps_it_from_deciding():
    movie = MOVIES["approach"]
    with lobula.open(movie) as source:
        found = explain(source, lobula.Network(), 2.0, yaw_rate_deg_s=lambda time_s: 90.0 if time_s > 1.95 else 0.0)
    assert found.reading.state == "turning"
    assert found.verdict == "no collision: 0 ms since the last turn, 67 are needed"


def test_warming_up_is_said_first():
    assert explained(MOVIES["approach"], 0.1).verdict == "no collision: 100 ms since the start, 200 are needed"


def test_the_nearest_frame_is_explained():
    assert explained(MOVIES["approach"], 1.99).frame.index == 60  # 2.000 s is nearer than 1.967 s
    assert explained(MOVIES["approach"], 1.98).frame.index == 59


@pytest.mark.parametrize("at_s", [-1.0, float("nan"), 99.0])
def test_a_moment_outside_the_source_is_refused(at_s):
    with pytest.raises(ParameterError, match="must"):
        explained(MOVIES["approach"], at_s)


def test_a_camera_cannot_be_explained():
    with pytest.raises(ParameterError, match="camera: is live: must be a recording"):
        explain(LiveSource([], None), lobula.Network(), 1.0)
