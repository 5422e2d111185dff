"""Pictures follow the light of the room; an automatic gain brings them to one mean, a filter's way at a time."""

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from lobula.arena.controls import NeverTurn
from lobula.arena.exposure import Exposure
from lobula.arena.simulation import Simulation
from lobula.arena.world import CameraParams, LightParams

from .stand_ins import PlainEye, world_of


class Dim(PlainEye):
    """A room of one grey, 30; notes the light."""

    def views(self, cameras: Any, bodies: Any, **settings: Any) -> np.ndarray:
        self.light = np.array(settings["light"])
        grey = np.broadcast_to(30 * self.light[:, None, None], (len(cameras), *self.shape))
        return grey.clip(0, 255).astype(np.uint8)


def test_the_gain_follows_a_dark_room() -> None:
    camera = CameraParams(auto_gain=True, auto_gain_grey=120, auto_gain_ms=100)
    sim = Simulation(replace(world_of(2), camera=camera), NeverTurn(), 0, eye=Dim())
    means = []
    for _ in range(60):
        sim.tick()
        assert sim.images is not None
        means.append(float(sim.images.mean()))
    assert means[0] == 30
    assert means[-1] == pytest.approx(120, abs=1.5)
    assert all(later >= sooner for sooner, later in pairwise(means))
    # log gain closes the gap by dt / (dt + tau) = 1/4 a frame
    assert np.log(means[1] / 30) == pytest.approx(np.log(4) / 4, abs=0.03)
    np.testing.assert_allclose(sim.past(0).light, np.array(means[-len(sim.past(0).light) :]) / 30, rtol=0.04)


def test_the_gain_has_its_limits() -> None:
    exposure = Exposure(replace(world_of(2), camera=CameraParams(auto_gain=True, auto_gain_ms=0)), 2)
    black, white = np.zeros((24, 32), np.uint8), np.full((24, 32), 255, np.uint8)
    for _ in range(10):
        exposure.follow(np.array([black, white]))
    assert exposure.at(0.0).tolist() == [8.0, 0.125]


def test_steps_of_light_reach_the_pictures() -> None:
    eye = Dim()
    world = replace(world_of(), light=LightParams(course="steps", step_every_s=1, step_gain=0.5))
    sim, light = Simulation(world, NeverTurn(), 0, eye=eye), []
    for _ in range(61):
        sim.tick()
        light.append(float(eye.light[0]))
    assert light == [1.0] * 30 + [0.5] * 30 + [1.0]
