"""``lobula.open`` is ``frames.open`` with the core's resize, where there is a core."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import lobula
from lobula import frames
from lobula.runtime import opening

IMAGES = np.random.default_rng(0).integers(0, 256, (5, 120, 160), np.uint8)


def test_the_same_pictures_to_float32_rounding():
    with lobula.open(IMAGES) as ours, frames.open(IMAGES) as plain:
        for a, b in zip(ours, plain, strict=True):
            assert a.time_s == b.time_s
            np.testing.assert_allclose(a.image, b.image, atol=2e-3)


def test_the_same_signature_and_words():
    assert inspect.signature(lobula.open) == inspect.signature(frames.open)
    assert lobula.open.__doc__ == frames.open.__doc__


def test_another_resizer_may_be_given():
    made = []

    def own(*arguments):
        made.append(arguments)
        return frames.AreaAverage(*arguments)

    with lobula.open(IMAGES, resizer=own) as source:
        next(source)
    assert made


@pytest.mark.parametrize("there", [True, False])
def test_without_a_core_numpy_does_it(monkeypatch, there):
    seen = []
    monkeypatch.setattr(opening, "available", lambda: there)
    opened = opening._resized_by_the_core(lambda source, **options: seen.append(options))
    opened("clip.mp4")
    assert ("resizer" in seen[0]) == there
