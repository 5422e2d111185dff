"""What the network says of a movie, on both engines: the claims of the paper, the named states, the maps."""

from __future__ import annotations

import numpy as np
import pytest

from lobula import stimuli
from lobula.engine.network import Network
from lobula.model.network import TAPS

from .engines import assert_in_range
from .films import NASTY, Film, drifting, filmed, growing, looming

BOTH = pytest.mark.parametrize("preset", ["paper", "published"])


def run(net: Network, film: Film, **kwargs):
    return net.run(film.images, film.times_s, turning=film.turning, **kwargs)


class TestBehaviour:
    def test_the_engine_is_told(self, net, engine):
        assert net.engine == engine

    @BOTH
    def test_an_approach_is_a_collision_before_contact(self, net):
        movie = stimuli.looming(speed_cm_s=12.0)
        alarms = movie.times_s[run(net, filmed(movie))["collision"]]
        assert 0.5 < alarms[0] < movie.contact_s

    @pytest.mark.parametrize(
        ("preset", "make"),
        [("paper", stimuli.receding), ("published", stimuli.receding), ("paper", stimuli.translating)],
    )
    def test_nothing_else_is(self, net, make):
        assert not run(net, filmed(make(speed_cm_s=12.0)))["collision"].any()

    @BOTH
    def test_the_lptcs_tell_right_from_left_and_the_mirror_swaps_them(self, net):
        right = stimuli.translating(speed_cm_s=12.0, direction="right", lead_s=0.3, hold_s=0.1)
        there = run(net, filmed(right))
        assert there["lptc_r"].max() > 0.5
        assert there["spikes_lptc_r"].sum() > 10 * there["spikes_lptc_l"].sum()
        net.reset()
        back = run(net, filmed(stimuli.mirrored(right)))
        for name, twin, sign in (("lptc_r", "lptc_l", -1), ("lptc_l", "lptc_r", -1), ("lgmd1", "lgmd1", 1),
                                 ("lgmd2", "lgmd2", 1)):  # fmt: skip
            np.testing.assert_allclose(back[name], sign * there[twin], atol=1e-6)
        assert back["spikes_lptc_l"].sum() > 10 * back["spikes_lptc_r"].sum()

    @BOTH
    @pytest.mark.parametrize("name", ["growing", "drifting", "lamps", "checks", "one-pixel", "extremes"])
    def test_potentials_stay_in_their_ranges(self, net, name):
        assert_in_range(run(net, NASTY[name]()))

    def test_a_still_picture_is_silent(self, net):
        trace = net.run(np.full((30, 36, 52), 77, np.uint8), np.arange(30) / 30)
        assert (trace["lgmd1"] == 0.5).all()
        assert (trace["lgmd2"] == 0.5).all()
        assert not trace["lptc_r"].any()
        assert not trace["lptc_l"].any()
        assert not trace["collision"].any()
        assert trace["state"].tolist() == ["warming_up"] * 6 + ["ok"] * 24

    def test_turning_is_a_state_and_no_collision(self, net):
        film = filmed(looming())
        assert run(net, film)["collision"].any()
        net.reset()
        trace = run(net, film._replace(turning=np.ones(len(film.images), np.bool_)))
        assert not trace["collision"].any()
        assert set(trace["state"]) == {"warming_up", "turning"}

    def test_a_yaw_rate_is_turning_where_it_is_fast(self, net):
        images = growing(frames=12).images
        yaw = [-90.0 if t == 8 else 3.0 for t in range(12)]
        states = [net.step(image, t / 30, yaw_rate_deg_s=yaw[t]).state for t, image in enumerate(images)]
        # 67 ms after the turn at frame 8: until frame 10
        assert states == ["warming_up"] * 6 + ["ok", "ok", "turning", "turning", "turning", "ok"]

    def test_kernels_grow_with_the_picture_where_that_is_asked_for(self, net, engine):
        grown = Network(net.params, engine=engine, scale_kernels=True)
        wide, narrow = drifting(48, 200, frames=8), drifting(36, 52, frames=8)
        assert not np.allclose(run(net, wide)["lptc_l"], run(grown, wide)["lptc_l"])
        net.reset()
        grown.reset()
        assert run(net, narrow).tolist() == run(grown, narrow).tolist()

    def test_asking_for_maps_changes_no_reading(self, net, engine):
        film = growing()
        tapped = Network(net.params, engine=engine)
        for i, (image, time_s) in enumerate(zip(film.images, film.times_s, strict=True)):
            a = net.step(image, time_s)
            b = tapped.step(image, time_s, taps=[TAPS[i % len(TAPS)]])
            assert a[:8] == b[:8]
            assert a.taps == {}
            assert b.taps[TAPS[i % len(TAPS)]].shape == (36, 52)

    def test_maps_of_a_frame_that_does_not_move_it_on_are_empty(self, net):
        image = growing(frames=1).images[0]
        assert not net.step(image, 0.0, taps=["change"]).taps["change"].any()
        net.step(image[::-1], 0.1)
        assert not net.step(image, 0.1001, taps=["change"]).taps["change"].any()  # joins an unfinished tick
