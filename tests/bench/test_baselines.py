"""A baseline that computes something else would make any ratio worthless: both must be the model itself."""

import importlib

import numpy as np
import pytest

from lobula import stimuli
from lobula.model.network import ReferenceNetwork
from lobula.model.presets import preset

TOLERANCE = 1e-3
MOVIES = {
    "approach": lambda: stimuli.looming(scene="arena", start_cm=14, stop_cm=4, speed_cm_s=15, seed=1),
    "passing": lambda: stimuli.translating(scene="arena", speed_cm_s=20, seed=2),
    "drift": lambda: stimuli.grating(noise_sigma=1.5, duration_s=1.0),
    "noise, odd size": lambda: stimuli.noise(sigma=8, duration_s=1.0, width=61, height=45),
}


@pytest.fixture(params=["numpy_scipy:NumpyScipyNetwork", "opencv:OpencvNetwork", "opencv_folded:FoldedOpencvNetwork"])
def baseline(request):
    file, name = request.param.split(":")
    needs, extra = ("scipy", "scipy") if file == "numpy_scipy" else ("cv2", "opencv-python-headless")
    pytest.importorskip(needs, reason=f"{extra} is not installed: pip install 'lobula[bench]'")
    return getattr(importlib.import_module(f"baselines.{file}"), name)


@pytest.mark.parametrize("movie", MOVIES.values(), ids=MOVIES.keys())
def test_says_what_the_model_says(baseline, movie):
    movie = movie()
    p, shape = preset("published"), movie.images.shape[1:]
    model, other = ReferenceNetwork(p, shape), baseline(p, shape)
    for image, time_s in zip(movie.images, movie.times_s, strict=True):
        expected, found = model.step(image, float(time_s)), other.step(image, float(time_s))
        assert np.abs(np.subtract(found[:4], expected[1:5])).max() <= TOLERANCE
        thresholds = np.abs(np.abs(expected[1:5]) - (0.7, 0.7, 0.2, 0.2))
        if thresholds.min() > TOLERANCE:
            assert np.array_equal(np.minimum(found.spikes, 1), np.minimum(expected.spikes, 1))


def test_the_movies_wake_every_neuron():
    awake = np.zeros(4)
    for movie in (MOVIES["approach"](), MOVIES["passing"]()):
        model = ReferenceNetwork(preset("published"), movie.images.shape[1:])
        for image, time_s in zip(movie.images, movie.times_s, strict=True):
            awake += np.abs(model.step(image, float(time_s))[1:5]) > (0.7, 0.7, 0.05, 0.001)
    assert (awake > 0).all()
