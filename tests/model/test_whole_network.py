"""Every layer, potential, spike and decision of a tiny movie against a slow network."""

import numpy as np
import pytest
from oracles.network import PUBLISHED, Oracle, Wiring

from lobula.model.network import TAPS, ReferenceNetwork
from lobula.model.presets import preset

from .movies import growing


def calibrated():
    """The ``paper`` preset's own scales: calibrated, so there is no other place to take them from."""
    lgmd, lptc = preset("paper").lgmd1, preset("paper").lptc
    return Wiring(True, lgmd.grouping.threshold_grey, lgmd.grouping.floor_grey, lgmd.sigmoid_grey, lptc.sigmoid_grey2)


WIRINGS = {"published": PUBLISHED, "paper": calibrated()}


RAGGED = np.cumsum([0, 33, 40, 27, 67, 33, 100, 30, 36, 50, 33]) / 1000
"""Late frames and dropped ones: steps of 0.8 to 3 ticks."""
MOVIES = {
    "approach": (growing(11, 0.9), np.arange(11) / 30),
    "pass": (growing(11, 0.0, 1.5), np.arange(11) / 30),
    "approach-15hz": (growing(11, 0.8, 0.5), np.arange(11) / 15),
    "approach-ragged": (growing(11, 0.9, -0.4), RAGGED),
}


@pytest.mark.parametrize(
    ("name", "movie"),
    [("published", "approach"), ("published", "pass"), ("published", "approach-ragged"), ("paper", "approach"),
     ("paper", "approach-15hz"), ("paper", "approach-ragged")],
)  # fmt: skip
def test_agrees_with_the_oracle(name, movie):
    images, times_s = MOVIES[movie]
    net = ReferenceNetwork(preset(name), images.shape[1:])
    oracle = Oracle(WIRINGS[name])
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
