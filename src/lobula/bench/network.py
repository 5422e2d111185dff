"""Passes of a network over endless movies, for timing: step by step, in blocks, and many streams at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..engine.network import Network
from ..model.presets import preset
from .scenes import Images, Loop
from .timing import Pass

Step = Callable[[Any, float], Any]
"""Takes in one picture and its stamp."""


def network(engine: str = "auto", name: str = "default", *, scale_kernels: bool = False) -> Network:
    """Return a fresh network with the settings of preset ``name``."""
    return Network(preset(name), engine=engine, scale_kernels=scale_kernels)


def frame_by_frame(make_step: Callable[[], Step], movies: Sequence[Images], count: int | None = None) -> Pass:
    """Return a pass over ``movies``, a network of its own for each, one picture at a time.

    A pass takes ``count`` pictures of each movie, going on where the last one stopped; without, the whole movie.
    """
    pairs = [(make_step(), Loop(images)) for images in movies]

    def work() -> int:
        frames = 0
        for step, loop in pairs:
            for image, time_s in loop.take(count or len(loop)):
                step(image, time_s)
            frames += count or len(loop)
        return frames

    return work


def in_blocks(make: Callable[[], Network], movies: Sequence[Images]) -> Pass:
    """Return a pass over ``movies``, each handed over as one block."""
    pairs = [(make(), Loop(images)) for images in movies]

    def work() -> int:
        frames = 0
        for net, loop in pairs:
            net.run(loop.images, loop.times_s())
            frames += len(loop)
        return frames

    return work


def streams_in_blocks(make: Callable[[], Network], movies: Sequence[Images], streams: int, threads: int) -> Pass:
    """Return a pass of ``streams`` networks at once, each over one of ``movies``."""
    # Each stream has pictures of its own, as cameras have.
    block = np.stack([np.roll(movies[i % len(movies)], i, axis=2) for i in range(streams)])
    net, clock = make(), Loop(block[0])

    def work() -> int:
        net.run(block, clock.times_s(), threads=threads)
        return streams * len(clock)

    return work
