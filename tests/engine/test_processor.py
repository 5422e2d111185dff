"""What only the core has: instruction sets that agree, the caller's float mode left alone, threads, memory."""

from __future__ import annotations

import threading

import numpy as np
import pytest

import lobula
from lobula.engine.library import isa, isas, library
from lobula.engine.network import Network
from lobula.engine.structures import core_params
from lobula.errors import ParameterError
from lobula.types import NEURONS

from .engines import assert_alike, needs_core, run
from .films import at_hz, drifting, faint_noise, filmed, growing, lamps, looming, noise, one_pixel

pytestmark = needs_core

BOTH = pytest.mark.parametrize("preset", ["paper", "published"])
SHAPES = [(36, 52), (25, 33), (30, 64)]


def assert_the_same(core, plainest, params):
    assert_alike(core, plainest, params)
    for name in NEURONS:
        np.testing.assert_allclose(core[name], plainest[name], atol=1e-6)


@BOTH
@pytest.mark.parametrize("name", isas())
def test_every_instruction_set(name, preset, monkeypatch):
    params = lobula.preset(preset)
    films = [filmed(looming(scene="arena")), drifting(77, 101), noise(25, 33), one_pixel()]
    films += [make(*shape, frames=20) for make in (growing, drifting, lamps) for shape in SHAPES]
    for film in films:
        monkeypatch.setenv("LOBULA_ISA", isas()[0])
        plainest = run("core", params, film)
        monkeypatch.setenv("LOBULA_ISA", name)
        assert isa() == name
        assert_the_same(run("core", params, film), plainest, params)


def test_the_best_is_chosen_unless_told(monkeypatch):
    monkeypatch.delenv("LOBULA_ISA", raising=False)
    assert isa() == isas()[-1]
    monkeypatch.setenv("LOBULA_ISA", isas()[0])
    assert isa() == isas()[0]


def test_one_that_is_not_there(monkeypatch):
    monkeypatch.setenv("LOBULA_ISA", "z80")
    with pytest.raises(ParameterError, match="z80: must be one of"):
        Network(engine="core").step(np.zeros((24, 32), np.uint8), 0.0)


def test_states_move_between_instruction_sets(monkeypatch):
    film = growing()
    net = Network(engine="core")
    expected = net.run(film.images, film.times_s)
    net.reset()
    for i, name in enumerate(isas() * 2):
        monkeypatch.setenv("LOBULA_ISA", name)
        other = Network(engine="core")
        if i:
            other.load_state_dict(net.state_dict())
        part = slice(5 * i, 5 * i + 5)
        assert_the_same(other.run(film.images[part], film.times_s[part]), expected[part], net.params)
        net = other


def denormals_work():
    tiny = np.full(64, 2e-38, np.float32)
    return bool((tiny * np.float32(0.125) > 0).all()) and 2e-308 * 0.125 > 0


def test_the_float_mode_is_put_back():
    assert denormals_work()
    net = Network(engine="core")
    film = noise(48, 64, dtype=np.float32)
    for image, time_s in zip(film.images, film.times_s, strict=True):
        net.step(image, time_s)
        assert denormals_work()
    net.run(film.images, film.times_s + 10)
    assert denormals_work()
    net.load_state_dict(net.state_dict())
    assert denormals_work()


def assert_no_denormals(state):
    for name, value in state.items():
        size = np.abs(np.asarray(value, np.float32))
        assert not ((size > 0) & (size < np.finfo(np.float32).tiny)).any(), name


@BOTH
@pytest.mark.parametrize("make", [drifting, faint_noise])
def test_motion_that_stops_leaves_no_denormals(preset, make):
    """Residuals fall tenfold a step: 46 steps take them from 255 past the smallest normal number."""
    moving = make(48, 64, frames=6).images
    images = np.concatenate([moving, np.repeat(moving[-1:], 90, axis=0)])
    stepped, at_once = (Network(lobula.preset(preset), engine="core") for _ in range(2))
    for image, time_s in zip(images, at_hz(30, len(images)), strict=True):
        stepped.step(image, time_s)
        assert_no_denormals(stepped.state_dict())
    at_once.run(images, at_hz(30, len(images)))
    for net in (stepped, at_once):
        state = net.state_dict()
        assert_no_denormals(state)
        assert not any(state[name].any() for name in ("on", "off", "adapted_on", "adapted_off"))


@pytest.mark.parametrize("shape", [(200, 320), (260, 420)])
def test_a_block_of_pictures_that_outgrow_the_cache(shape):
    """From about 2 MB of state the core takes several frames through the rows together."""
    film = drifting(*shape, frames=19)
    film = film._replace(turning=np.arange(19) % 7 == 3, times_s=film.times_s + (np.arange(19) > 11) * 0.9)
    net = Network(lobula.preset("published"), engine="core")
    rows = net.run(film.images, film.times_s, turning=film.turning)
    net.reset()
    for image, time_s, turning, row in zip(*film[:2], film.turning.tolist(), rows, strict=True):
        r = net.step(image, time_s, turning=turning)
        assert (*r[:5], *r.spikes, r.collision, r.state) == row.tolist()[1:]


def test_state_is_small_enough_for_a_cache():
    for name in ("paper", "published"):
        assert library().lobula_state_size(core_params(lobula.preset(name)), 99, 72, 0) <= 200 * 1024


def test_networks_on_threads_of_their_own():
    film = growing()
    expected = run("core", lobula.preset(), film).tobytes()
    tables: list[bytes] = []

    def work() -> None:
        for _ in range(5):
            net = Network(engine="core")
            parts = [net.run(film.images[part], film.times_s[part]) for part in (slice(9), slice(9, None))]
            tables.append(np.concatenate(parts).tobytes())

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert tables == [expected] * 20


def test_a_network_dropped_leaves_the_others_alone():
    film, other = growing(), drifting(40, 70, frames=21)
    net = Network(engine="core")
    first = net.run(film.images[:10], film.times_s[:10])
    for _ in range(20):
        run("core", lobula.preset(), other)
    second = net.run(film.images[10:], film.times_s[10:])
    assert first.tolist() + second.tolist() == run("core", lobula.preset(), film).tolist()
