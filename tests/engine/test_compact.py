"""Compact networks, the robot's arithmetic: 16-bit planes change next to nothing, and states go on as they were."""

from __future__ import annotations

import numpy as np
import pytest

import lobula
from lobula.arena.network_controller import NetworkController
from lobula.engine.network import Network
from lobula.errors import ParameterError
from lobula.types import NEURONS

from .engines import assert_in_range, near_a_step, needs_core
from .films import NASTY, filmed, growing, looming, turned

pytestmark = needs_core

PRESETS = ("paper", "published", "lobula")


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("name", [name for name, film in NASTY.items() if film().images.dtype == np.uint8])
def test_as_the_float_network(name: str, preset: str) -> None:
    """A plane's rounding is 1 part in 2048 at most: so near are the potentials, but in single frames where it takes the
    model over one of its own steps: the grouping's threshold, or the growth below which a potential fades."""
    params, film = lobula.preset(preset), NASTY[name]()
    compact, exact = (
        Network(params, storage=storage).run(film.images, film.times_s, turning=film.turning)
        for storage in ("compact", "float")
    )
    assert_in_range(compact)
    assert compact["state"].tolist() == exact["state"].tolist()
    for neuron in NEURONS:
        error = np.abs(compact[neuron] - exact[neuron])
        assert np.percentile(error, 90) <= 5e-4, neuron
        assert error.max() <= 0.1, f"{neuron}: {error.max()} at {error.argmax()}"
        spiking = params.lptc.spiking if neuron.startswith("lptc") else getattr(params, neuron).spiking
        for t in np.flatnonzero(compact[f"spikes_{neuron}"] != exact[f"spikes_{neuron}"]):
            assert error[t] > 1e-4 or near_a_step(exact[neuron][t], spiking.gain, spiking.threshold)


@pytest.mark.parametrize("preset", PRESETS)
def test_blocks_and_steps_are_the_same(preset: str) -> None:
    film = turned(growing())
    net, again = (Network(lobula.preset(preset), storage="compact") for _ in range(2))
    block = net.run(film.images, film.times_s, turning=film.turning)
    for t, image in enumerate(film.images):
        reading = again.step(image, film.times_s[t], turning=bool(film.turning[t]), taps=("motion", "lamina"))
        assert reading[1:5] == tuple(block[t][name] for name in NEURONS)


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("way", ["state_dict", "snapshot"])
def test_a_state_goes_on_as_it_was(way: str, preset: str) -> None:
    film = growing()
    net, again = (Network(lobula.preset(preset), storage="compact") for _ in range(2))
    net.run(film.images[:17], film.times_s[:17])
    if way == "snapshot":
        again.restore(net.snapshot())
    else:
        again.load_state_dict(net.state_dict())
    rest, same = (n.run(film.images[17:], film.times_s[17:]) for n in (net, again))
    assert rest.tobytes() == same.tobytes()


def test_planes_are_rounded_to_halves_and_the_luma_not_at_all() -> None:
    film = growing()
    states = {}
    for storage in ("compact", "float"):
        net = Network(lobula.preset("published"), storage=storage)
        net.run(film.images[:9], film.times_s[:9])
        states[storage] = net.state_dict()
    np.testing.assert_array_equal(states["compact"]["luma"], film.images[8])
    for name in ("on", "off", "adapted_on", "change_on", "change_off"):
        kept = states["compact"][name]
        np.testing.assert_array_equal(kept, kept.astype(np.float16).astype(np.float32))
        np.testing.assert_allclose(kept, states["float"][name], rtol=2e-3, atol=2e-2)


def test_float_pictures_count_as_whole_grey_levels() -> None:
    film = filmed(looming(quantised=False))
    assert film.images.dtype != np.uint8
    given, rounded = (
        Network(storage="compact").run(images, film.times_s)
        for images in (film.images, np.rint(film.images).astype(np.uint8))
    )
    assert given.tobytes() == rounded.tobytes()


def test_a_snapshot_of_the_other_storage_is_refused() -> None:
    film = growing(frames=3)
    net = Network(storage="compact")
    net.run(film.images, film.times_s)
    with pytest.raises(ParameterError, match="storage"):
        Network().restore(net.snapshot())


def test_what_cannot_be() -> None:
    with pytest.raises(ParameterError, match="storage 'tiny': must be one of float, compact"):
        Network(storage="tiny")
    with pytest.raises(ParameterError, match="must go with engine 'core'"):
        Network(engine="reference", storage="compact")
    with pytest.raises(ParameterError, match="storage"):
        NetworkController(storage="tiny")


def test_a_controller_drives_with_it() -> None:
    film = growing()
    controller = NetworkController(lobula.preset("published"), storage="compact")
    controller.start(1, np.random.default_rng(0))
    said = [
        bool(controller.step(image[None], t, np.zeros(1, bool))[0])
        for image, t in zip(film.images, film.times_s, strict=True)
    ]
    alone = Network(lobula.preset("published"), storage="compact").run(film.images, film.times_s)["collision"]
    assert said == alone.tolist()
