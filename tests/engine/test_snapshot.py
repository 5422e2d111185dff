"""A snapshot is a quick copy of a whole network: from it everything goes on as if nothing had happened."""

import numpy as np
import pytest

from lobula import Network
from lobula.errors import ParameterError

from .engines import needs_core

RNG = np.random.default_rng(5)
IMAGES = np.clip(128 + np.cumsum(RNG.normal(0, 6, (24, 36, 48)), axis=2), 0, 255).astype(np.uint8)
TIMES_S = np.arange(24) / 30
ENGINES = (pytest.param("core", marks=needs_core), "reference")


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("at", [0, 1, 13])
def test_another_network_goes_on_from_a_snapshot_as_the_first_does(engine: str, at: int) -> None:
    first, second = Network(engine=engine), Network(engine=engine)
    if at:
        first.run(IMAGES[:at], TIMES_S[:at])
    kept = first.snapshot()
    rest = first.run(IMAGES[at:], TIMES_S[at:])
    second.run(IMAGES[::-1], TIMES_S)  # something else before
    second.restore(kept)
    np.testing.assert_array_equal(second.run(IMAGES[at:], TIMES_S[at:]), rest)
    second.restore(kept)  # and again: it did not change
    np.testing.assert_array_equal(second.run(IMAGES[at:], TIMES_S[at:]), rest)


@needs_core
def test_a_snapshot_remembers_the_last_time() -> None:
    net = Network(engine="core")
    net.step(IMAGES[0], 1.0)
    again = Network(engine="core")
    again.restore(net.snapshot())
    with pytest.raises(ValueError, match="runs backwards"):
        again.step(IMAGES[1], 0.5)


@needs_core
def test_a_snapshot_of_another_build_is_refused() -> None:
    net = Network(engine="core")
    net.step(IMAGES[0], 0.0)
    kept = net.snapshot()
    block = kept["block"].copy()
    block[0] ^= 1
    with pytest.raises(ParameterError, match="another build"):
        Network(engine="core").restore({**kept, "block": block})
    with pytest.raises(ParameterError, match="another build"):
        Network(engine="core").restore({**kept, "width": 64})
    with pytest.raises(ParameterError, match="engine 'core'"):
        Network(engine="reference").restore(kept)


@needs_core
def test_several_streams_have_no_snapshot() -> None:
    net = Network(engine="core")
    net.run(np.stack([IMAGES[:2], IMAGES[:2]]), TIMES_S[:2])
    with pytest.raises(ParameterError, match="2 streams"):
        net.snapshot()
