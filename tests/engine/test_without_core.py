"""Which engine runs: the core where it is; where it is not, that is said once, and the reference runs."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from lobula.engine import library
from lobula.engine.network import Network
from lobula.errors import ParameterError

from .engines import needs_core

GREY = np.full((24, 32), 120, np.float32)


@pytest.fixture
def place(monkeypatch, tmp_path):
    """Where the library is looked for; nothing is there yet."""
    monkeypatch.setattr(library, "FILE", tmp_path / "liblobula.so")
    library._load.cache_clear()
    yield tmp_path / "liblobula.so"
    library._load.cache_clear()


@needs_core
def test_auto_takes_the_core_where_it_is():
    assert (Network().engine, library.why_not()) == ("core", "")


def test_auto_warns_once_and_runs_the_reference(place):
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("default")
        nets = [Network() for _ in range(3)]
    assert [str(w.message) for w in said] == [
        "lobula runs on its NumPy reference, about 40 times slower than its C core: it was not built: no C compiler "
        "was found when lobula was installed"
    ]
    assert {net.engine for net in nets} == {"reference"}
    assert nets[0].step(GREY, 0.0).lgmd1 == 0.5
    assert nets[0].step(GREY, 0.1).lgmd1 == 0.5
    assert not library.available()
    assert library.isas() == ()


def test_asking_for_the_core_is_an_error(place):
    with pytest.raises(ParameterError, match=r"engine 'core': it was not built.*; use engine='reference' or 'auto'"):
        Network(engine="core")


def test_asking_for_the_reference_is_silent(place):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert Network(engine="reference").step(GREY, 0.0).lgmd1 == 0.5


def test_a_file_that_is_no_library(place):
    place.write_text("not a library")
    with pytest.warns(RuntimeWarning, match=r"liblobula\.so cannot be loaded"):
        assert Network().engine == "reference"
    assert not library.available()
    assert "cannot be loaded" in library.why_not()
    with pytest.raises(ParameterError, match="use engine='reference' or 'auto'"):
        Network(engine="core")


@pytest.mark.parametrize("name", ["steam", ""])
def test_unknown_engine(name):
    with pytest.raises(ParameterError, match=f"engine '{name}': must be one of auto, core, reference"):
        Network(engine=name)
