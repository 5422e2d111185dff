"""What the core does with the processor: every instruction set agrees, and the caller's float mode is left alone."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

import lobula
from lobula.engine.library import isa, isas
from lobula.engine.network import Network

from .engines import assert_alike, needs_core, run
from .films import Film, at_hz, drifting, filmed, looming, noise

pytestmark = needs_core

CHILD = """
import sys
import numpy as np
import lobula
from lobula.engine.library import isa

films = np.load(sys.argv[1])
traces = {"isa": isa()}
for key in films:
    preset = key.split("-")[0]
    net = lobula.Network(lobula.preset(preset), engine="core")
    traces[key] = net.run(films[key], np.arange(len(films[key])) / 30.0)
np.savez(sys.argv[2], **traces)
"""


@pytest.fixture(scope="module")
def films():
    movies = {"looming": filmed(looming(scene="arena")), "drifting": drifting(77, 101), "noise": noise(25, 33)}
    return {f"{preset}-{name}": film.images for preset in ("paper", "published") for name, film in movies.items()}


@pytest.mark.parametrize("name", isas())
def test_every_instruction_set(name, films, tmp_path):
    np.savez(tmp_path / "films.npz", **films)
    subprocess.run([sys.executable, "-c", CHILD, tmp_path / "films.npz", tmp_path / "traces.npz"], check=True,
                   env={**os.environ, "LOBULA_ISA": name}, timeout=60)  # fmt: skip
    with np.load(tmp_path / "traces.npz") as traces:
        assert str(traces["isa"]) == name
        for key, images in films.items():
            params = lobula.preset(key.split("-")[0])
            here = run("core", params, Film(images, np.arange(len(images)) / 30.0))
            assert_alike(traces[key], here, params)


def test_the_best_is_chosen_unless_told(monkeypatch):
    monkeypatch.delenv("LOBULA_ISA", raising=False)
    assert isa() == isas()[-1]
    monkeypatch.setenv("LOBULA_ISA", isas()[0])
    assert isa() == isas()[0]


def denormals_work():
    tiny = np.full(64, 2e-38, np.float32)
    return bool((tiny * np.float32(0.125) > 0).all()) and 2e-308 * 0.125 > 0


def test_the_float_mode_is_put_back():
    assert denormals_work()
    net = Network(engine="core")
    film = noise(48, 64, dtype=np.float32)
    for image, time_s in zip(film.images, film.times_s, strict=True):
        net.step(image, float(time_s))
        assert denormals_work()
    net.run(film.images, film.times_s + 10)
    assert denormals_work()
    net.load_state_dict(net.state_dict())
    assert denormals_work()


@pytest.mark.parametrize("preset", ["paper", "published"])
def test_motion_that_stops_leaves_no_denormals(preset):
    """Residuals fall tenfold a step: 46 steps take them from 255 past the smallest normal number."""
    moving = drifting(48, 64, frames=6).images
    images = np.concatenate([moving, np.repeat(moving[-1:], 70, axis=0)])
    net = Network(lobula.preset(preset), engine="core")
    for image, time_s in zip(images, at_hz(30, len(images)), strict=True):
        net.step(image, float(time_s))
        for name, value in net.state_dict().items():
            size = np.abs(np.asarray(value, np.float32))
            assert not ((size > 0) & (size < np.finfo(np.float32).tiny)).any(), name
    state = net.state_dict()
    assert not any(state[name].any() for name in ("on", "off", "adapted_on", "adapted_off"))
