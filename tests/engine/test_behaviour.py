"""The claims of the paper and the refusals that guard them, through each engine alike."""

from __future__ import annotations

import numpy as np
import pytest

import lobula
from lobula import stimuli
from lobula.engine.network import Network
from lobula.errors import ParameterError, ShapeError

from .engines import needs_core

GREY = np.full((48, 64), 120, np.uint8)


@pytest.fixture(params=[pytest.param("core", marks=needs_core), "reference"])
def engine(request):
    return request.param


@pytest.fixture
def net(engine):
    return Network(engine=engine)


class TestNetwork:
    def test_engine_is_told(self, net, engine):
        assert net.engine == engine

    @pytest.mark.parametrize("preset", ["paper", "published"])
    def test_looming_collides_before_contact(self, engine, preset):
        movie = stimuli.looming(speed_cm_s=12.0)
        trace = Network(lobula.preset(preset), engine=engine).run(movie.images, movie.times_s)
        alarms = trace["time_s"][trace["collision"]]
        assert 0.5 < alarms[0] < movie.contact_s

    @pytest.mark.parametrize("make", [stimuli.receding, stimuli.translating])
    def test_nothing_else_does(self, net, make):
        movie = make(speed_cm_s=12.0)
        assert not net.run(movie.images, movie.times_s)["collision"].any()

    def test_direction(self, net):
        for direction, sees, is_blind in (("right", "lptc_r", "lptc_l"), ("left", "lptc_l", "lptc_r")):
            net.reset()
            movie = stimuli.translating(speed_cm_s=12.0, direction=direction)
            trace = net.run(movie.images, movie.times_s)
            assert np.abs(trace[sees]).max() > 0.2
            assert trace[f"spikes_{sees}"].sum() > 10 * trace[f"spikes_{is_blind}"].sum()

    def test_turning_is_a_state_and_no_collision(self, net):
        movie = stimuli.looming(speed_cm_s=12.0)
        trace = net.run(movie.images, movie.times_s, turning=np.ones(len(movie), np.bool_))
        assert not trace["collision"].any()
        assert set(trace["state"]) == {"warming_up", "turning"}

    def test_another_size_is_refused_and_nothing_taken_in(self, net):
        net.step(GREY, 0.0)
        with pytest.raises(ShapeError, match=r"32 x 24 px after 64 x 48"):
            net.step(np.zeros((24, 32), np.uint8), 0.1)
        with pytest.raises(ShapeError, match=r"32 x 24 px after 64 x 48"):
            net.run(np.zeros((2, 24, 32), np.uint8), [0.1, 0.2])
        net.step(GREY, 0.1)

    @pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, -0.5, 255.5])
    @pytest.mark.parametrize("place", [(0, 0), (47, 63), (20, 33)])
    def test_values_that_are_no_luminance(self, net, bad, place):
        image = GREY.astype(np.float32)
        net.step(image, 0.0)
        image[place] = bad
        for started in (net, Network(engine=net.engine)):
            with pytest.raises(ShapeError, match=r"NaN or infinity|must lie in 0\.\.255"):
                started.step(image, 0.1)
            with pytest.raises(ShapeError, match=r"NaN or infinity|must lie in 0\.\.255"):
                started.run(image[None], [0.1])

    def test_unit_range_is_refused(self, net):
        image = np.linspace(0, 1, 64 * 48, dtype=np.float32).reshape(48, 64)
        with pytest.raises(ShapeError, match=r"look like 0\.\.1: must be 0\.\.255"):
            net.step(image, 0.0)
        with pytest.raises(ShapeError, match=r"look like 0\.\.1: must be 0\.\.255"):
            net.run(image[None], [0.0])
        net.step(255 * image, 0.0)
        net.step(image, 0.1)  # dark after daylight is dark

    def test_taps_of_a_frame_that_does_not_advance_are_empty(self, net):
        assert not net.step(GREY, 0.0, taps=["change"]).taps["change"].any()
        assert net.step(GREY, 0.1).taps == {}

    def test_streams_and_single_frames_do_not_mix(self, net):
        net.run(np.zeros((2, 3, 24, 32), np.uint8), [0.0, 0.1, 0.2])
        with pytest.raises(ParameterError, match="2 streams: must be one"):
            net.step(np.zeros((24, 32), np.uint8), 1.0)
