"""The two engines: a test that asks for ``engine`` or ``net`` runs once on each."""

from __future__ import annotations

import pytest

import lobula
from lobula.engine.network import Network

from .engines import needs_core


@pytest.fixture(params=[pytest.param("core", marks=needs_core), "reference"])
def engine(request) -> str:
    return request.param


@pytest.fixture
def preset() -> str:
    """The preset whose two kinds of neurons read different maps; a test may be given others by this name."""
    return "published"


@pytest.fixture
def net(engine, preset) -> Network:
    return Network(lobula.preset(preset), engine=engine)
