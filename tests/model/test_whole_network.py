"""Every layer, potential, spike and decision of a tiny movie against a slow network."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.network import PUBLISHED, Oracle, Wiring

from lobula.model.network import TAPS, ReferenceNetwork
from lobula.model.presets import preset
from lobula.params import with_settings

from .movies import growing, run


def calibrated():
    """The ``paper`` preset's own scales: calibrated, so there is no other place to take them from."""
    lgmd, lptc = preset("paper").lgmd1, preset("paper").lptc
    return Wiring(True, lgmd.grouping.threshold_grey, lgmd.grouping.floor_grey, lgmd.sigmoid_grey, lptc.sigmoid_grey2)


def with_patches(name, limit, side, noise, gains, on_weights, c_sig):
    """A base preset whose LGMDs hear patches, of a change that saturates; and the same for the oracle."""
    lgmds = {
        lgmd: {"coarse_gain": gain, "coarse_on_weight": weight, "sigmoid_grey": c_sig}
        for lgmd, gain, weight in zip(("lgmd1", "lgmd2"), gains, on_weights, strict=True)
    }
    settings = {
        "saturation": {"enabled": limit < 255, "limit_grey": limit},
        "coarse": {"patch_px": side, "floor_grey": noise},
        **lgmds,
    }
    wiring = replace(
        WIRINGS[name], limit=limit, side=side, noise=noise, gains=gains, on_weights=on_weights, c_sig=c_sig
    )
    return with_settings(preset(name), settings, "test"), wiring


WIRINGS = {"published": PUBLISHED, "paper": calibrated()}
PATCHED = {
    "patches": with_patches("published", 255.0, 9, 1.0, (0.0, 2.0), (0.0, 1.0), 20.0),
    "saturated": with_patches("published", 20.0, 9, 1.0, (0.0, 0.0), (0.0, 0.0), 1.0),
    "both": with_patches("published", 35.0, 5, 0.5, (0.2, 0.4), (8.0, 1.5), 1.5),
    "both-on-lamina": with_patches("paper", 25.0, 4, 2.0, (0.5, 0.4), (1.0, 0.0), 1.0),
}
CASES = {**{name: (preset(name), wiring) for name, wiring in WIRINGS.items()}, **PATCHED}


RAGGED = np.cumsum([0, 33, 40, 27, 67, 33, 100, 30, 36, 50, 33]) / 1000
"""Late frames and dropped ones: steps of 0.8 to 3 ticks."""
MOVIES = {
    "approach": (growing(11, 0.9), np.arange(11) / 30),
    "pass": (growing(11, 0.0, 1.5), np.arange(11) / 30),
    "approach-15hz": (growing(11, 0.8, 0.5), np.arange(11) / 15),
    "approach-ragged": (growing(11, 0.9, -0.4), RAGGED),
}


@pytest.mark.parametrize("name", PATCHED)
def test_the_cases_say_something(name):
    """Agreement where patches and limit do nothing would prove nothing."""
    params, _ = CASES[name]
    nothing = {
        "saturation": {"enabled": False},
        **{lgmd: {"coarse_gain": 0.0} for lgmd in ("lgmd1", "lgmd2")},
    }
    images, times_s = MOVIES["approach"]
    with_it, without = (run(p, images, times_s) for p in (params, with_settings(params, nothing, "test")))
    assert max(abs(a.lgmd2 - b.lgmd2) for a, b in zip(with_it, without, strict=True)) > 0.05


@pytest.mark.parametrize(
    ("name", "movie"),
    [("published", "approach"), ("published", "pass"), ("published", "approach-ragged"), ("paper", "approach"),
     ("paper", "approach-15hz"), ("paper", "approach-ragged"),
     ("patches", "approach"), ("patches", "pass"), ("saturated", "approach"), ("both", "approach-15hz"),
     ("both", "approach-ragged"), ("both-on-lamina", "approach"), ("both-on-lamina", "pass")],
)  # fmt: skip
def test_agrees_with_the_oracle(name, movie):
    images, times_s = MOVIES[movie]
    params, wiring = CASES[name]
    net = ReferenceNetwork(params, images.shape[1:])
    oracle = Oracle(wiring, params.decision.neurons)
    oracle.start(images[0].tolist(), times_s[0])
    assert net.step(images[0], times_s[0]).spikes == (0, 0, 0, 0)
    for image, time_s in zip(images[1:], times_s[1:].tolist(), strict=True):
        reading = net.step(image, time_s, taps=TAPS)
        for neuron, potential in oracle.step(image.tolist(), time_s).items():
            assert getattr(reading, neuron) == pytest.approx(potential, abs=1e-4), (neuron, time_s)
        assert reading.spikes == oracle.spikes
        assert reading.collision == oracle.collision
        for tap, layer in oracle.maps.items():
            expected = np.array(layer)
            assert np.abs(reading.taps[tap] - expected).max() <= 1e-5 * np.abs(expected).max() + 1e-9, (tap, time_s)
