"""Small random maps for the properties, and how many of them are tried."""

from __future__ import annotations

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays, mutually_broadcastable_shapes
from numpy.typing import NDArray

Map = NDArray[np.float32]
CLOCK_MS = 1000.0 / 30.0

few = settings(max_examples=20, deadline=None, derandomize=True)
"""The same 20 examples in every run: a test that fails today fails tomorrow."""

shapes = mutually_broadcastable_shapes(num_shapes=1, min_dims=2, max_dims=2, min_side=3, max_side=7).map(
    lambda s: s.input_shapes[0]
)


def _maps(low: float, count: int) -> st.SearchStrategy[tuple[Map, ...]]:
    # light finer than a thousandth of a grey level only tests where float32 ends
    values = st.floats(low, 255, width=32).map(lambda v: v if abs(v) > 1e-3 else 0.0)
    return shapes.flatmap(lambda shape: st.tuples(*[arrays(np.float32, shape, elements=values)] * count))


signed = _maps(-255, 1).map(lambda maps: maps[0])
"""A change of luminance, (H, W) float32."""
channel = _maps(0, 1).map(lambda maps: maps[0])
"""An ON or OFF channel, (H, W) float32, >= 0."""
channels = _maps(0, 2)
"""The same channel now and one step ago, (H, W) each."""


def noise(seed: int, shape: tuple[int, int] = (9, 12), low: float = 0.0, high: float = 255.0) -> Map:
    """Uniform noise without the round numbers and ties that hypothesis likes."""
    return np.random.default_rng(seed).uniform(low, high, shape).astype(np.float32)


def spot(shape: tuple[int, int], row: int, column: int, value: float) -> Map:
    """One pixel on a black map."""
    picture = np.zeros(shape, np.float32)
    picture[row, column] = value
    return picture
