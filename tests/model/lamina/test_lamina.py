"""The lamina as a layer: its order and what it keeps."""

import numpy as np
import pytest

from lobula.model.lamina import Lamina, LaminaParams
from lobula.model.lamina.dog import DogParams, difference_of_gaussians
from lobula.model.lamina.fdsr import FdsrParams

from ..pictures import CLOCK_MS, noise

SHAPE = (9, 12)


def run(lamina, steps=4):
    return [lamina.step(noise(seed, SHAPE, low=-255), 0.1, CLOCK_MS) for seed in range(steps)]


def same(outputs, others):
    return all(
        np.array_equal(a, b)
        for one, two in zip(outputs, others, strict=True)
        for a, b in ((one.edges, two.edges), *zip(one.adapted, two.adapted, strict=True),
                     *zip(one.adapted_before, two.adapted_before, strict=True))
    )  # fmt: skip


def test_golden_two_steps_by_hand():
    # without DoG: P = +10 then 0 then +20. ON = 10, 1, 20.1; rises 10, none, 19.1; share 1 / 34.333 = 0.029126
    lamina = Lamina(LaminaParams(dog=DogParams(enabled=False)), (3, 3))
    outputs = [lamina.step(np.full((3, 3), p, np.float32), 0.1, CLOCK_MS) for p in (10, 0, 20)]
    assert [float(o.adapted.on[1, 1]) for o in outputs] == pytest.approx([0.29126, 0, 0.55631], abs=1e-5)
    assert [float(o.adapted_before.on[1, 1]) for o in outputs] == pytest.approx([0, 0.29126, 0], abs=1e-5)
    assert not any(o.adapted.off.any() for o in outputs)


def test_order_is_dog_then_split_then_adaptation():
    change = noise(0, SHAPE, low=-255)
    lamina = Lamina(LaminaParams(fdsr=FdsrParams(enabled=False)), SHAPE)
    edges = difference_of_gaussians(change, DogParams())
    output = lamina.step(change, 0.1, CLOCK_MS)
    assert np.array_equal(output.edges, edges)
    assert np.array_equal(output.adapted.on, np.maximum(edges, 0))
    assert np.array_equal(output.adapted.off, np.maximum(-edges, 0))


def test_reset_really_resets():
    lamina = Lamina(LaminaParams(), SHAPE)
    first = run(lamina)
    assert not same(run(lamina)[:1], first[:1])  # it does remember
    lamina.reset()
    assert same(run(lamina), first)


def test_silence_on_nothing():
    lamina = Lamina(LaminaParams(), SHAPE)
    for _ in range(3):
        output = lamina.step(np.zeros(SHAPE, np.float32), 0.1, CLOCK_MS)
        assert not any(m.any() for m in (output.edges, *output.adapted, *output.adapted_before))


def test_keeps_float32():
    output = run(Lamina(LaminaParams(), SHAPE), 2)[-1]
    assert {m.dtype.name for m in (output.edges, *output.adapted, *output.adapted_before)} == {"float32"}
