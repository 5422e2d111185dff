"""The C core against the definition: the same potentials, spikes, states and decisions on whatever a camera shows."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import lobula
from lobula.engine.network import Network
from lobula.model.network import TAPS

from .engines import assert_alike, assert_in_range, changed, needs_core, run
from .films import NASTY, drifting, filmed, jittered, looming, noise

pytestmark = needs_core

PRESETS = ("paper", "published", "lobula")


def compare(params, film, **kwargs):
    core, reference = (run(engine, params, film, **kwargs) for engine in ("core", "reference"))
    for trace in (core, reference):
        assert_in_range(trace)
    assert_alike(core, reference, params)


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("name", NASTY)
def test_films(name, preset):
    compare(lobula.preset(preset), NASTY[name]())


def test_the_films_say_something():
    """Agreement on silence would prove nothing."""
    loud = {name: run("core", lobula.preset(), NASTY[name]()) for name in ("looming", "translating-right", "flash")}
    assert loud["looming"]["collision"].any()
    assert loud["translating-right"]["spikes_lptc_r"].max() > 0
    assert "flash" in loud["flash"]["state"]


@pytest.mark.parametrize("neurons", ["lgmds", "lgmd2"])
@pytest.mark.parametrize("preset", PRESETS)
def test_who_decides(preset, neurons):
    compare(lobula.preset(preset, neurons=neurons), filmed(looming()))


OFF = {"enabled": False}
VARIANTS = {
    "no-dog": {"lamina": {"dog": OFF}},
    "no-fdsr": {"lamina": {"fdsr": OFF}},
    "no-dog-no-fdsr": {"lamina": {"dog": OFF, "fdsr": OFF}},
    "no-grouping": {"lgmd1": {"grouping": OFF}, "lgmd2": {"grouping": OFF}},
    "one-groups": {"lgmd1": {"grouping": OFF}},
    "no-sfa": {"lgmd1": {"sfa": OFF}, "lgmd2": {"sfa": OFF}},
    "no-flash": {"flash": OFF},
    "no-repeats": {"clock": {"repeats": False}},
    "reads-mixed": {"lgmd1": {"reads": "lamina", "sigmoid_grey": 0.01, "grouping": {"threshold_grey": 0.1}},
                    "lgmd2": {"reads": "change", "sigmoid_grey": 1.0}},
    "reads-mixed-other-way": {"lgmd1": {"reads": "change", "sigmoid_grey": 1.0}, "lgmd2": {"reads": "lamina"}},
    "reads-mixed-no-fdsr": {"lgmd1": {"reads": "lamina"}, "lgmd2": {"reads": "change"}, "lamina": {"fdsr": OFF}},
    "radius-1": {"lamina": {"dog": {"radius_px": 1, "sigma_px": 0.8}}},
    "radius-3": {"lamina": {"dog": {"radius_px": 3, "sigma_px": 2.5, "surround": 3}}},
    "radius-9": {"lamina": {"dog": {"radius_px": 9, "sigma_px": 5.0, "surround": 4}}},
    "one-span": {"lptc": {"emd": {"spans_px": (3,), "delays_ms": (25.0,)}}},
    "eight-spans": {"lptc": {"emd": {"spans_px": (1, 2, 3, 5, 8, 13, 21, 34), "delays_ms": (50.0,) * 8}}},
    "spans-past-the-border": {"lptc": {"emd": {"spans_px": (1, 60, 64), "delays_ms": (40.0, 30.0, 20.0)}}},
    "neighbours-2": {"lgmd1": {"neighbour_px": 2}, "lgmd2": {"neighbour_px": 2}},
    "neighbours-1-3": {"lgmd1": {"neighbour_px": 1}, "lgmd2": {"neighbour_px": 3}},
    "neighbours-32": {"lgmd1": {"neighbour_px": 32}, "lgmd2": {"neighbour_px": 32}},
    "products": {"lgmd1": {"product_gain": 0.5, "on_gain": 0.3}, "lgmd2": {"off_gain": 2.0, "on": {"bias": 0.2}}},
    "on-only": {"lgmd1": {"off_gain": 0.0}, "lgmd2": {"off_gain": 0.0, "product_gain": 0.0, "on": {"bias": 0.1}}},
    "all-silent": {"lgmd1": {"on_gain": 0.0, "off_gain": 0.0}, "lgmd2": {"on": {"bias": 8.0}, "off": {"bias": 8.0}}},
    "easily-aroused": {"lgmd1": {"change_scale_grey": 0.5}, "lgmd2": {"change_scale_grey": 0.5, "change_ms": 300.0}},
    "slow-clock": {"clock": {"period_ms": 66.0, "change_exponent": 0.3}},
    "long-residual": {"lamina": {"on_off": {"residual": 0.6}}},
    "dead-zone": {"lamina": {"dog": {"dead_zone_grey": 0.5}}},
    "eager": {"decision": {"collision_spikes": 1, "window_ms": 1000.0, "warm_up_ms": 0.0, "lptc_weight": 0.2}},
}  # fmt: skip
LIMIT = {"saturation": {"enabled": True, "limit_grey": 12.0}}
EARS = {
    "lgmd1": {"coarse_gain": 0.4, "coarse_on_weight": 2.0, "sigmoid_grey": 4.0},
    "lgmd2": {"coarse_gain": 0.6, "coarse_on_weight": 0.5, "sigmoid_grey": 4.0},
}
COARSE = {
    "saturation": LIMIT,
    "patches": {**EARS, "saturation": OFF},
    "saturation-and-patches": {**LIMIT, **EARS},
    "one-hears-patches": {"lgmd1": EARS["lgmd1"], "lgmd2": {"coarse_gain": 0.0}},
    "patches-of-2": {**EARS, "coarse": {"patch_px": 2, "floor_grey": 4.0}},
    "patches-of-7": {**LIMIT, **EARS, "coarse": {"patch_px": 7, "floor_grey": 0.0}},
    "patches-as-wide-as-half-the-picture": {**EARS, "coarse": {"patch_px": 32}},
    "patches-read-lamina": {**LIMIT, "lgmd1": EARS["lgmd1"] | {"reads": "lamina"},
                            "lgmd2": EARS["lgmd2"] | {"reads": "lamina"}},
    "patches-read-mixed": {**LIMIT, "lgmd1": EARS["lgmd1"] | {"reads": "lamina"},
                           "lgmd2": EARS["lgmd2"] | {"reads": "change"}},
    "patches-no-dog-no-fdsr": {**LIMIT, **EARS, "lamina": {"dog": OFF, "fdsr": OFF}},
    "patches-neighbours-3": {**LIMIT, "lgmd1": EARS["lgmd1"] | {"neighbour_px": 3}, "lgmd2": EARS["lgmd2"]},
    "patches-all-else-silent": {**EARS, "lgmd2": EARS["lgmd2"] | {"on": {"bias": 8.0}, "off": {"bias": 8.0}}},
}  # fmt: skip
DEAF = {"coarse": {"patch_px": 100}}  # larger than the picture
VARIANTS |= COARSE | {"patches-larger-than-the-picture": {**LIMIT, **EARS, **DEAF}}


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("name", VARIANTS)
def test_settings(name, preset):
    params = changed(lobula.preset(preset), **VARIANTS[name])
    compare(params, filmed(looming(scene="arena", lead_s=0.1)))
    compare(params, drifting(33, 49, frames=8))


@pytest.mark.parametrize("name", COARSE)
def test_the_settings_of_patches_say_something(name):
    film = filmed(looming(scene="arena", lead_s=0.1))
    own, without = COARSE[name], {**COARSE[name], **DEAF, "saturation": OFF}
    a, b = (run("core", changed(lobula.preset("published"), **settings), film) for settings in (own, without))
    assert max(np.abs(a[lgmd] - b[lgmd]).max() for lgmd in ("lgmd1", "lgmd2")) > 0.01


@pytest.mark.parametrize("film", ["flash", "flash-pulse", "flicker", "lamps", "7-hz", "turning", "looming-unrounded",
                                  "noise-tall", "noise-odd", "extremes"])  # fmt: skip
@pytest.mark.parametrize("name", ["patches-of-7", "patches-read-mixed"])
def test_films_with_patches(name, film):
    compare(changed(lobula.preset("published"), **COARSE[name]), NASTY[film]())


@pytest.mark.parametrize("width", [200, 297])
def test_kernels_that_grow_with_the_picture(width):
    film = filmed(looming(scene="arena", width=width, height=100, start_cm=10.0, lead_s=0.2))
    for params in (lobula.preset(), changed(lobula.preset("published"), **COARSE["saturation-and-patches"])):
        compare(params, film, scale_kernels=True)


@given(st.integers(0, 10**6), st.integers(24, 60), st.integers(32, 70), st.integers(2, 72), st.sampled_from(PRESETS),
       st.booleans())  # fmt: skip
@settings(max_examples=60, deadline=None, derandomize=True)
def test_drawn_sizes(seed, height, width, patch, preset, smooth):
    film = drifting(height, width, seed=seed, frames=8) if smooth else noise(height, width, seed=seed, frames=8)
    params = changed(lobula.preset(preset), coarse={"patch_px": patch, "floor_grey": 0.0})
    compare(params, jittered(film, seed=seed))


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("name", ["as-it-is", "no-dog-no-fdsr", "no-grouping", "reads-mixed", "neighbours-1-3",
                                  "products", "all-silent", "saturation", "patches", "saturation-and-patches",
                                  "patches-read-mixed", "patches-no-dog-no-fdsr"])  # fmt: skip
def test_taps(name, preset):
    params = changed(lobula.preset(preset), **VARIANTS.get(name, {}))
    film = filmed(looming(scene="arena", width=45, height=31))
    core, reference = (Network(params, engine=engine) for engine in ("core", "reference"))
    for image, time_s in zip(film.images, film.times_s, strict=True):
        a, b = (net.step(image, float(time_s), taps=TAPS) for net in (core, reference))
        assert set(a.taps) == set(b.taps) == set(TAPS)
        for tap in TAPS:
            assert a.taps[tap].shape == (31, 45)
            scale = max(1.0, float(np.abs(b.taps[tap]).max()))
            error = np.abs(a.taps[tap] - b.taps[tap]) / scale
            # A cell may fall on the other side of a threshold: of the dead zone, or of the grouping.
            assert (error > 1e-5).mean() < 2e-3, f"{tap} at {time_s} s: {error.max()}"


def test_the_change_that_is_tapped_is_the_one_that_goes_on():
    params = changed(lobula.preset("published"), **COARSE["saturation-and-patches"])
    film = filmed(looming(scene="arena", width=45, height=31))
    net, limited = Network(params, engine="core"), 0
    net.step(film.images[0], 0.0)
    for t, (before, image) in enumerate(zip(film.images, film.images[1:], strict=False)):
        change = net.step(image, (t + 1) / 30, taps=["change"]).taps["change"]
        whole = image.astype(np.float32) - before
        np.testing.assert_allclose(change, np.clip(whole, -12, 12), rtol=0, atol=1e-4)
        limited += int((np.abs(whole) > 12).sum())
    assert limited > 100
