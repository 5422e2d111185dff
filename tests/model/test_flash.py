"""Changes of light before the whole network: silent on a still scene, no obstacle to an alarm."""

from dataclasses import replace

import numpy as np
import pytest

from lobula.model.network import ReferenceNetwork
from lobula.model.presets import preset
from lobula.stimuli import flicker, looming, still, with_flash, with_flicker

from .movies import approach, collisions, run, states

NAMES = ("published", "paper")
SMALL = {"width": 49, "height": 36}
FLASHES = (
    {"offset_grey": 40.0}, {"offset_grey": -40.0}, {"offset_grey": 60.0, "lasts_s": 0.05},
    {"offset_grey": -35.0, "lasts_s": 0.15},
)  # fmt: skip
"""Lamp on, lamp off, a short pulse of light and one of darkness; none clips the scene or changes its contrast."""
MOMENTS = (-6, -2, 0, 3)
"""Frames from the first alarm."""


def lit(movie):
    return movie.images, movie.times_s


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("flash", [*FLASHES, {"gain": 0.5}, {"gain": 1.4}], ids=str)
def test_flash_on_a_still_scene_is_silent(name, flash):
    scene = still(background="blobs", noise_sigma=1.5, duration_s=0.6, **SMALL)
    readings = run(preset(name), *lit(with_flash(scene, at_s=0.4, **flash)))
    told = states(readings)
    assert told[12] == "flash"
    assert told.count("flash") == (2 if "lasts_s" in flash else 1)
    assert not collisions(readings)
    assert {r.spikes for r in readings} == {(0, 0, 0, 0)}


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("hz", "amplitude"), [(1, 0.1), (3, 0.1), (10, 0.05), (10, 0.2), (50, 0.1)])
def test_flicker_on_a_still_scene_is_silent(name, hz, amplitude):
    movie = flicker(hz=hz, amplitude=amplitude, background="stripes", noise_sigma=1.5, duration_s=0.8, **SMALL)
    readings = run(preset(name, neurons="lgmd2"), *lit(movie))
    assert not collisions(readings)
    assert {r.spikes for r in readings} == {(0, 0, 0, 0)}


class Approach:
    """One approach, run once; what comes after any of its frames can be run again in another light."""

    def __init__(self, name):
        self.name = name
        self.movie = approach(width=99, height=72)
        net = ReferenceNetwork(preset(name), self.movie.images.shape[1:])
        self.readings, self.before = [], []
        for image, t in zip(self.movie.images, self.movie.times_s.tolist(), strict=True):
            self.before.append(net.state_dict())
            self.readings.append(net.step(image, t))
        self.first = collisions(self.readings)[0]

    def relit(self, frame, flash):
        """The readings with a flash at ``frame``."""
        movie = with_flash(self.movie, at_s=self.movie.times_s[frame], **flash)
        net = ReferenceNetwork(preset(self.name), movie.images.shape[1:])
        net.load_state_dict(self.before[frame])
        return self.readings[:frame] + run(net, movie.images[frame:], movie.times_s[frame:])


@pytest.fixture(scope="module", params=NAMES)
def approaching(request):
    return Approach(request.param)


def test_approach_alone_is_no_flash(approaching):
    """It ends with nothing else in view, and the alarm stands until then."""
    assert np.ptp(approaching.movie.images[-1]) == 0
    assert "flash" not in states(approaching.readings)
    assert collisions(approaching.readings) == list(range(approaching.first, len(approaching.movie)))


@pytest.mark.parametrize("flash", FLASHES, ids=str)
def test_flash_neither_holds_back_nor_ends_an_alarm(approaching, flash):
    for moment in MOMENTS:
        frame = approaching.first + moment
        readings = approaching.relit(frame, flash)
        alarm = collisions(readings)
        assert states(readings)[frame] == "flash"
        assert abs(alarm[0] - approaching.first) <= 2, moment
        assert alarm == list(range(alarm[0], len(readings))), moment


def test_flicker_does_not_hold_back_an_alarm(approaching):
    for hz, amplitude in ((1.0, 0.1), (10.0, 0.1), (50.0, 0.1)):
        movie = with_flicker(approaching.movie, hz=hz, amplitude=amplitude, start_s=0.5)
        net = ReferenceNetwork(preset(approaching.name), movie.images.shape[1:])
        net.load_state_dict(approaching.before[15])  # the light is steady until frame 15
        alarm = collisions(approaching.readings[:15] + run(net, movie.images[15:], movie.times_s[15:]))
        assert abs(alarm[0] - approaching.first) <= 2
        assert alarm == list(range(alarm[0], len(movie)))


RUSHES = (
    {"object_grey": 5.0, "background_grey": 45.0, "background": "stripes", "background_contrast_grey": 5.0,
     "object_cm": 2.2, "height_cm": 1.3, "speed_cm_s": 87.5, "stop_cm": 0.1, "rate_hz": 15.0},
    {"object_grey": 120.0, "background_grey": 175.0, "background": "blobs", "background_deg": 6.7,
     "background_contrast_grey": 30.0, "object_cm": 6.3, "height_cm": 8.5, "speed_cm_s": 206.1, "stop_cm": 0.3,
     "rate_hz": 15.0},
    {"object_grey": 230.0, "background_grey": 140.0, "background": "stripes", "background_contrast_grey": 5.0,
     "object_contrast_grey": 25.0, "object_cm": 10.0, "shape": "disc", "speed_cm_s": 196.5, "stop_cm": 1.0,
     "rate_hz": 15.0},
)  # fmt: skip
"""So fast that one step takes the object from a part of the view over nearly all of it, dark and bright."""


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("settings", RUSHES, ids=lambda s: f"{s['object_grey']:g}")
@pytest.mark.parametrize("noise_sigma", [0.0, 0.5, 1.5, 4.0])
def test_object_that_jumps_over_the_view_is_no_flash(name, settings, noise_sigma):
    movie = looming(start_cm=60.0, lead_s=0.4, hold_s=0.2, width=66, height=48, noise_sigma=noise_sigma, **settings)
    p = preset(name)
    readings = run(p, *lit(movie))
    blind = run(replace(p, flash=replace(p.flash, enabled=False)), *lit(movie))
    assert "flash" not in states(readings)
    assert [r.collision for r in readings] == [r.collision for r in blind]


def test_bright_object_in_the_dark_is_no_flash():
    movie = approach(object_grey=200.0, background_grey=30.0, background="blobs")
    readings = run(preset("published"), *lit(movie))
    assert "flash" not in states(readings)
    assert sum(r.spikes.lgmd1 for r in readings) >= 4  # LGMD-1 sees it come
    assert sum(r.spikes.lgmd2 for r in readings) == 0  # LGMD-2 is for dark ones
