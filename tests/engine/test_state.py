"""A state saved by one engine goes on in the other."""

from __future__ import annotations

import math

import numpy as np
import pytest

import lobula
from lobula.engine.network import Network
from lobula.errors import ParameterError, ShapeError
from lobula.model.state import NAMES, PLANES

from .engines import assert_alike, changed, needs_core, run
from .films import drifting, filmed, jittered, looming, turned

pytestmark = needs_core

OFF = {"enabled": False}
PARAMS = {
    "paper": lobula.preset("paper"),
    "published": lobula.preset("published"),
    "no-fdsr": changed(lobula.preset("paper"), lamina={"fdsr": OFF}),
    "reads-mixed": changed(lobula.preset("published"), lgmd1={"reads": "lamina"}),
}
PATHS = [("core", "reference"), ("reference", "core"), ("core", "core"), ("reference", "reference")]


@pytest.fixture(scope="module")
def film():
    return turned(jittered(filmed(looming(scene="arena"))))


@pytest.fixture(scope="module")
def uninterrupted(film):
    return {(name, engine): run(engine, params, film) for name, params in PARAMS.items()
            for engine in ("core", "reference")}  # fmt: skip


@pytest.mark.parametrize("cut", [1, 12, 30])
@pytest.mark.parametrize(("first", "second"), PATHS)
@pytest.mark.parametrize("name", PARAMS)
def test_goes_on_in_the_other(name, first, second, cut, film, uninterrupted, tmp_path):
    params = PARAMS[name]
    before, after = (Network(params, engine=engine) for engine in (first, second))
    head = before.run(film.images[:cut], film.times_s[:cut], turning=film.turning[:cut])
    np.savez(tmp_path / "state.npz", **before.state_dict())
    with np.load(tmp_path / "state.npz") as state:
        after.load_state_dict(dict(state))
    tail = after.run(film.images[cut:], film.times_s[cut:], turning=film.turning[cut:])
    whole = np.concatenate([head, tail])
    assert whole["frame"].tolist() == list(range(len(film.images)))
    if first == second:
        assert whole.tolist() == uninterrupted[name, first].tolist()
    assert_alike(whole, uninterrupted[name, "reference"], params)


@pytest.mark.parametrize("name", PARAMS)
def test_both_remember_the_same(name, film):
    states = []
    for engine in ("core", "reference"):
        net = Network(PARAMS[name], engine=engine)
        net.run(film.images[:25], film.times_s[:25], turning=film.turning[:25])
        states.append(net.state_dict())
    core, reference = states
    reads = {PARAMS[name].lgmd1.reads, PARAMS[name].lgmd2.reads}
    assert set(core) == set(reference) == {*NAMES, "frames"}
    for entry in NAMES:
        if entry in ("change_on", "change_off") and "change" not in reads:
            continue  # nobody reads them: the core does not keep them
        assert np.shape(core[entry]) == np.shape(reference[entry])
        np.testing.assert_allclose(core[entry], reference[entry], rtol=0, atol=2e-4, err_msg=entry)


def test_a_state_is_a_copy(film):
    net = Network(engine="core")
    net.run(film.images[:20], film.times_s[:20])
    state = net.state_dict()
    kept = {name: np.copy(state[name]) for name in PLANES}
    net.run(film.images[20:], film.times_s[20:])
    assert all(np.array_equal(state[name], kept[name]) for name in PLANES)
    state["luma"][:] = 0
    assert net.state_dict()["luma"].max() > 0


def test_loading_over_a_used_network(film):
    used, fresh, saved = (Network(engine="core") for _ in range(3))
    saved.run(film.images[:20], film.times_s[:20])
    other = drifting(48, 64)
    used.run(other.images, other.times_s)
    for net in (used, fresh):
        net.load_state_dict(saved.state_dict())
    a, b = (net.run(film.images[20:], film.times_s[20:]) for net in (used, fresh))
    assert a.tolist() == b.tolist()


@pytest.mark.parametrize("engine", ["core", "reference"])
def test_what_it_refuses(engine, film):
    net = Network(engine=engine)
    with pytest.raises(ParameterError, match="0 streams"):
        net.state_dict()
    net.run(film.images[:3], film.times_s[:3])
    state = net.state_dict()
    assert math.isnan(state["turned_s"])
    with pytest.raises(ParameterError, match="no entry 'window'"):
        net.load_state_dict({name: value for name, value in state.items() if name != "window"})
    with pytest.raises(ShapeError, match="adapted_on has shape"):
        net.load_state_dict(state | {"adapted_on": np.zeros((10, 10), np.float32)})
