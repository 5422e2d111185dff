"""The palette: apart for every colour blindness, readable on its ground."""

from itertools import combinations

import numpy as np
import pytest
from numpy.typing import NDArray

from lobula.report.palette import DARK, LIGHT, RANGES, STATE_LABELS, Theme, thresholds
from lobula.types import NEURONS, STATES

# Machado, Oliveira & Fernandes 2009, severity 1.0, linear RGB; the identity stands for full colour vision.
SEEN_AS = {
    "all": np.eye(3),
    "protanopia": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "deuteranopia": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "tritanopia": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}


def linear(colour: str) -> NDArray[np.float64]:
    c = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def lab(rgb: NDArray[np.float64]) -> NDArray[np.float64]:
    to_xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    xyz = to_xyz @ np.clip(rgb, 0, 1) / (0.9505, 1.0, 1.089)
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


@pytest.mark.parametrize("theme", [LIGHT, DARK])
@pytest.mark.parametrize("sight", SEEN_AS)
def test_neurons_and_collision_stay_apart(theme: Theme, sight: str) -> None:
    colours = [*theme.neurons.values(), theme.collision]
    seen = [lab(SEEN_AS[sight] @ linear(colour)) for colour in colours]
    assert min(np.linalg.norm(a - b) for a, b in combinations(seen, 2)) > 15  # CIE76; 2.3 is just noticeable


@pytest.mark.parametrize("theme", [LIGHT, DARK])
def test_text_and_curves_are_readable(theme: Theme) -> None:
    def contrast(a: str, b: str) -> float:  # WCAG 2: 4.5 for text, 3 for graphics
        high, low = sorted((float(np.array([0.2126, 0.7152, 0.0722]) @ linear(c)) for c in (a, b)), reverse=True)
        return (high + 0.05) / (low + 0.05)

    assert min(contrast(theme.ground, c) for c in (theme.text, theme.dim)) > 4.5
    assert min(contrast(theme.panel, c) for c in (*theme.neurons.values(), theme.collision)) > 3


def test_every_neuron_and_state_has_a_look() -> None:
    for theme in (LIGHT, DARK):
        assert set(theme.neurons) == set(RANGES) == set(NEURONS)
        assert set(theme.states) == set(STATE_LABELS) == set(STATES)


def test_thresholds_are_the_papers_unless_given() -> None:
    assert thresholds({}) == {"lgmd1": 0.7, "lgmd2": 0.7, "lptc_r": 0.2, "lptc_l": -0.2}
    for sign in (1, -1):
        assert thresholds({"thresholds": {"lgmd1": 0.8, "lptc_l": sign * 0.3}}) == {
            "lgmd1": 0.8,
            "lgmd2": 0.7,
            "lptc_r": 0.2,
            "lptc_l": -0.3,
        }
