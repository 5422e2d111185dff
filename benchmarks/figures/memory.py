"""What one more stream takes."""

from __future__ import annotations

import tracemalloc

import numpy as np

from lobula.engine.core import CoreNetwork, Workspace
from lobula.engine.library import library
from lobula.engine.structures import core_params
from lobula.model.presets import preset

from .figure import Figure

STREAMS = 64


def figures(rounds: int, quick: bool) -> list[Figure]:
    """Ask the core for its state, and Python for all it holds of a stream."""
    p = preset("published")
    state = library().lobula_state_size(core_params(p), 99, 72, 0)
    workspace = Workspace(p, (72, 99))
    image = np.zeros((72, 99), np.uint8)
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    streams = [CoreNetwork(p, (72, 99), workspace=workspace) for _ in range(STREAMS)]
    for stream in streams:
        stream.step(image, 0.0)
    held = (tracemalloc.get_traced_memory()[0] - before) / STREAMS
    tracemalloc.stop()
    details = {"state_bytes": state, "all_bytes_of_a_stream": round(held)}
    return [
        Figure("state of a stream, 99x72", state / 1024, "KiB", 256, 200, "less", details),
        Figure("all that Python holds of a stream, 99x72", held / 1024, "KiB", better="less", details=details),
    ]
