"""What only the C core has: instruction sets, its library, the caller's float mode, threads."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from lobula import Network, preset
from lobula.engine import library
from lobula.errors import ParameterError

from .movies import MOVIES

if not library.available():
    pytest.skip("the C core was not built", allow_module_level=True)

from lobula.engine.core import CoreNetwork
from lobula.engine.structures import core_params

SHAPE = (36, 52)
TIMES_S = np.arange(30) / 30


@pytest.mark.parametrize("name", ["paper", "published"])
@pytest.mark.parametrize("isa", library.isas())
def test_instruction_sets_agree(isa: str, name: str, monkeypatch: pytest.MonkeyPatch):
    for movie in ("growing", "sliding", "lamps", "one_pixel"):
        for shape in (SHAPE, (25, 33), (30, 64)):
            images = MOVIES[movie](shape, 20)
            monkeypatch.setenv("LOBULA_ISA", library.isas()[0])
            plainest = CoreNetwork(preset(name), shape).run_block(images, TIMES_S[:20])
            monkeypatch.setenv("LOBULA_ISA", isa)
            assert library.isa() == isa
            table = CoreNetwork(preset(name), shape).run_block(images, TIMES_S[:20])
            for neuron in ("lgmd1", "lgmd2", "lptc_r", "lptc_l"):
                np.testing.assert_allclose(table[neuron], plainest[neuron], atol=1e-6)


def test_an_instruction_set_that_is_not_there(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("LOBULA_ISA", "z80")
    with pytest.raises(ParameterError, match="z80: must be one of"):
        Network(engine="core").step(np.zeros(SHAPE, np.uint8), 0.0)


def test_states_move_between_instruction_sets(monkeypatch: pytest.MonkeyPatch):
    images = MOVIES["growing"](SHAPE, 30)
    net = Network(engine="core")
    expected = net.run(images, TIMES_S)
    net.reset()
    for i, isa in enumerate(library.isas() * 2):
        monkeypatch.setenv("LOBULA_ISA", isa)
        other = Network(engine="core")
        if i:
            other.load_state_dict(net.state_dict())
        part = slice(5 * i, 5 * i + 5)
        table = other.run(images[part], TIMES_S[part])
        np.testing.assert_allclose(table["lgmd1"], expected["lgmd1"][part], atol=1e-6)
        net = other


def test_a_scene_that_comes_to_rest_leaves_no_denormals_and_the_float_mode_is_put_back():
    net = Network(preset("published"), engine="core")
    images = np.concatenate([MOVIES["faint_noise"](SHAPE, 10), np.repeat(MOVIES["faint_noise"](SHAPE, 1), 90, axis=0)])
    net.run(images, np.arange(100) / 30)
    state = net.state_dict()
    tiny = np.finfo(np.float32).tiny
    for name in ("on", "off", "adapted_on", "adapted_off", "change_on", "change_off"):
        assert not ((state[name] > 0) & (state[name] < tiny)).any()
    assert np.float32(1e-40) * np.float32(1) > 0  # with flush to zero this would be 0


def test_networks_on_threads_of_their_own():
    images = MOVIES["growing"](SHAPE, 30)
    expected = Network(engine="core").run(images, TIMES_S).tobytes()
    tables: list[bytes] = []

    def work() -> None:
        for _ in range(5):
            net = Network(engine="core")
            parts = [net.run(images[part], TIMES_S[part]) for part in (slice(9), slice(9, None))]
            tables.append(np.concatenate(parts).tobytes())

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert tables == [expected] * 20


def test_state_is_small_enough_for_a_cache():
    for name in ("paper", "published"):
        assert library.library().lobula_state_size(core_params(preset(name)), 99, 72) <= 200 * 1024


def test_the_reason_why_there_is_no_core(monkeypatch: pytest.MonkeyPatch, tmp_path):
    for content, says in ((None, "not built"), (b"not a library", "cannot be loaded")):
        file = tmp_path / f"lib{says.split()[0]}.so"
        if content is not None:
            file.write_bytes(content)
        monkeypatch.setattr(library, "FILE", file)
        library._load.cache_clear()
        assert not library.available()
        assert says in library.why_not()
        with pytest.raises(ParameterError, match="reference"):
            Network(engine="core")
    monkeypatch.undo()
    library._load.cache_clear()
    assert library.why_not() == ""
