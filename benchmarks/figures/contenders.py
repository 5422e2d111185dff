"""The networks that figures are measured with."""

from __future__ import annotations

from lobula.bench.network import network
from lobula.engine.network import Network


def published() -> Network:
    """Return the core with the preset that the baselines compute."""
    return network("core", "published")


def paper() -> Network:
    """Return it with the other preset: all four neurons read the lamina."""
    return network("core", "paper")


def scaled() -> Network:
    """Return it with kernels that grow with the picture."""
    return network("core", "published", scale_kernels=True)
