"""Both engines side by side: run them on the same film and say how far apart they may be."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from lobula.engine.library import available, why_not
from lobula.engine.network import Network
from lobula.model.network import NetworkParams
from lobula.params import with_settings
from lobula.types import NEURONS

from .films import Film

needs_core = pytest.mark.skipif(not available(), reason=f"the C core cannot be used here: {why_not()}")


def changed(params: NetworkParams, **settings: Any) -> NetworkParams:
    """Return ``params`` with nested settings replaced."""
    return with_settings(params, settings, "test")


def run(engine: str, params: NetworkParams, film: Film, **kwargs: Any) -> np.ndarray:
    """Return the trace of the film, frame by frame."""
    net = Network(params, engine=engine, **kwargs)
    return net.run(film.images, film.times_s, turning=film.turning)


def assert_alike(core: np.ndarray, reference: np.ndarray, params: NetworkParams) -> None:
    """Potentials to rounding, spikes except at a step of Eq. (4), states, and collisions where spikes are the same."""
    assert core["state"].tolist() == reference["state"].tolist()
    assert core["time_s"].tolist() == reference["time_s"].tolist()
    same_spikes = True
    for name in NEURONS:
        error = np.abs(core[name] - reference[name])
        assert np.isfinite(core[name]).all()
        assert np.percentile(error, 99) <= 1e-5, f"{name}: {error.max()} at frame {error.argmax()}"
        assert error.max() <= 1e-3, f"{name}: {error.max()} at frame {error.argmax()}"
        spiking = params.lptc.spiking if name.startswith("lptc") else getattr(params, name).spiking
        for a, b, potential in zip(core[f"spikes_{name}"], reference[f"spikes_{name}"], reference[name], strict=True):
            assert a == b or near_a_step(potential, spiking.gain, spiking.threshold), f"{name}: {a} spikes, not {b}"
            same_spikes &= bool(a == b)
    if same_spikes:
        assert core["collision"].tolist() == reference["collision"].tolist()


def assert_in_range(trace: np.ndarray) -> None:
    """The potentials of the paper: LGMDs from one half up, each LPTC on its own side of 0, never both at once."""
    for lgmd in ("lgmd1", "lgmd2"):
        assert ((trace[lgmd] >= 0.5) & (trace[lgmd] < 1)).all()
    assert ((trace["lptc_r"] >= 0) & (trace["lptc_r"] < 1)).all()
    assert ((trace["lptc_l"] <= 0) & (trace["lptc_l"] > -1)).all()
    assert (trace["lptc_r"] * trace["lptc_l"] == 0).all()


def near_a_step(potential: float, gain: float, threshold: float) -> bool:
    """Whether floor(exp(gain (|U| - threshold))) changes within 1e-4 of U."""
    low, high = (math.floor(math.exp(gain * (abs(potential) + d - threshold))) for d in (-1e-4, 1e-4))
    return low != high
