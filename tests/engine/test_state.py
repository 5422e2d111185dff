"""A state saved by one engine goes on in the other."""

from __future__ import annotations

import math

import numpy as np
import pytest

import lobula
from lobula import stimuli
from lobula.engine.network import Network
from lobula.errors import ParameterError, ShapeError, TimeError
from lobula.model.state import NAMES

from .engines import assert_alike, changed, needs_core, run
from .films import drifting, filmed, growing, jittered, looming, turned

OFF = {"enabled": False}
PARAMS = {
    "paper": lobula.preset("paper"),
    "published": lobula.preset("published"),
    "no-fdsr": changed(lobula.preset("paper"), lamina={"fdsr": OFF}),
    "reads-mixed": changed(lobula.preset("published"), lgmd1={"reads": "lamina"}),
    "lobula": lobula.preset("lobula"),
}
ENGINES = (pytest.param("core", marks=needs_core), "reference")


@pytest.fixture(scope="module")
def film():
    """An approach filmed by a poor clock; the camera turns in frames 6, 7, 18 and 20, in frame 12 a light goes on."""
    movie = looming(scene="arena", lead_s=0.1)
    return turned(jittered(filmed(stimuli.with_flash(movie, at_s=0.4, offset_grey=40.0))))


@pytest.fixture(scope="module")
def uninterrupted(film):
    made = {}

    def trace(name, engine):
        if (name, engine) not in made:
            made[name, engine] = run(engine, PARAMS[name], film)
        return made[name, engine]

    return trace


class TestState:
    @pytest.mark.parametrize("cut", [1, 13, 31])
    @pytest.mark.parametrize("other", ENGINES)
    @pytest.mark.parametrize("name", PARAMS)
    def test_it_goes_on_in_either_engine(self, name, engine, other, cut, film, uninterrupted, tmp_path):
        params = PARAMS[name]
        before, after = (Network(params, engine=which) for which in (engine, other))
        head = before.run(film.images[:cut], film.times_s[:cut], turning=film.turning[:cut])
        np.savez(tmp_path / "state.npz", **before.state_dict())
        with np.load(tmp_path / "state.npz") as state:
            after.load_state_dict(state)
        tail = after.run(film.images[cut:], film.times_s[cut:], turning=film.turning[cut:])
        whole = np.concatenate([head, tail])
        assert whole["frame"].tolist() == list(range(len(film.images)))
        if engine == other:
            assert whole.tolist() == uninterrupted(name, engine).tolist()
        assert_alike(whole, uninterrupted(name, "reference"), params)

    def test_the_film_is_worth_it(self, uninterrupted):
        """It must turn, flash and alarm at the cuts, or nothing would show that these go on."""
        trace = uninterrupted("paper", "reference")
        assert {"warming_up", "ok", "turning", "flash"} == set(trace["state"])
        assert trace["state"][12] == "flash"
        assert trace["collision"][30]

    @needs_core
    @pytest.mark.parametrize("name", PARAMS)
    def test_both_remember_the_same(self, name, film):
        states = []
        for which in ("core", "reference"):
            net = Network(PARAMS[name], engine=which)
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

    def test_it_is_a_copy(self, net, film):
        net.run(film.images[:20], film.times_s[:20])
        state = net.state_dict()
        kept = {name: np.copy(value) for name, value in state.items()}
        net.run(film.images[20:], film.times_s[20:])
        assert all(np.array_equal(state[name], kept[name], equal_nan=True) for name in kept)
        state["luma"][:] = 0
        assert net.state_dict()["luma"].max() > 0

    def test_it_replaces_what_a_used_network_remembers(self, engine, film):
        used, fresh, saved = (Network(engine=engine) for _ in range(3))
        saved.run(film.images[:20], film.times_s[:20])
        other = drifting(48, 64)
        used.run(other.images, other.times_s)
        for net in (used, fresh):
            net.load_state_dict(saved.state_dict())
        a, b = (net.run(film.images[20:], film.times_s[20:]) for net in (used, fresh))
        assert a.tolist() == b.tolist()

    def test_times_go_on(self, net, engine):
        film = growing(frames=12)
        net.run(film.images[:10], film.times_s[:10])
        restored = Network(net.params, engine=engine)
        restored.load_state_dict(net.state_dict())
        with pytest.raises(TimeError):
            restored.step(film.images[10], film.times_s[9])
        assert restored.run(film.images[10:], film.times_s[10:])["frame"].tolist() == [10, 11]

    def test_states_that_do_not_fit(self, net):
        with pytest.raises(ParameterError, match="0 streams"):
            net.state_dict()
        film = growing(frames=3)
        net.run(film.images, film.times_s)
        state = net.state_dict()
        assert math.isnan(state["turned_s"])
        with pytest.raises(ParameterError, match="no entry 'luma'"):
            net.load_state_dict({})
        with pytest.raises(ParameterError, match="no entry 'window'"):
            net.load_state_dict({name: value for name, value in state.items() if name != "window"})
        for name in ("on", "adapted_on"):
            with pytest.raises(ShapeError, match=f"{name} has shape"):
                net.load_state_dict(state | {name: np.zeros((10, 10), np.float32)})
