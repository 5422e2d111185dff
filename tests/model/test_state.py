"""What a network remembers: saved anywhere, it continues as if nothing had happened."""

import io
import math

import numpy as np
import pytest

from lobula.errors import ParameterError, ShapeError
from lobula.model.network import ReferenceNetwork
from lobula.model.presets import preset
from lobula.model.state import NAMES, PLANES

from .movies import growing, noisy, run, stamps

SHAPE = (24, 32)
# on the way: warm-up, a collision, held repeats, a turn, a frame that waits, a flash, a gap
FAST = noisy(4, seed=1)
IMAGES = np.concatenate([growing(11, 0.9), np.repeat(noisy(3), 3, axis=0), FAST, FAST[2:3] + 40, noisy(4, seed=2)])
TIMES = [*stamps(20), *(20 / 30 + k / 60 for k in range(5)), *(1.5 + t for t in stamps(4))]
TURNING = [16 <= k <= 17 for k in range(len(IMAGES))]


def after(count, name="published"):
    net = ReferenceNetwork(preset(name), SHAPE)
    run(net, IMAGES[:count], TIMES[:count], TURNING[:count])
    return net


@pytest.mark.parametrize("name", ["published", "paper"])
def test_continues_from_any_frame(name):
    whole = run(preset(name), IMAGES, TIMES, TURNING)
    assert {r.state for r in whole} == {"warming_up", "ok", "turning", "flash"}
    assert any(r.collision for r in whole)
    for count in range(0, len(IMAGES), 3):
        other = ReferenceNetwork(preset(name), SHAPE)
        other.load_state_dict(after(count, name).state_dict())
        rest = run(other, IMAGES[count:], TIMES[count:], TURNING[count:])
        assert rest == whole[count:]


def test_holds_the_names_it_promises():
    state = after(12).state_dict()
    assert tuple(state) == NAMES
    for name in PLANES:
        assert (state[name].shape, state[name].dtype) == (SHAPE, np.float32)
    assert state["window"].shape[1] == 4
    assert state["frame_s"] == TIMES[11]


def test_moments_that_have_not_been_are_nan():
    state = ReferenceNetwork(preset(), SHAPE).state_dict()
    assert all(math.isnan(state[name]) for name in ("frame_s", "turned_s", "held_s"))
    assert state["window"].shape == (0, 4)


def test_is_a_copy():
    net = after(12)
    state = net.state_dict()
    for value in state.values():
        if isinstance(value, np.ndarray):
            value[...] = 7
    expected = run(after(12), IMAGES[12:], TIMES[12:], TURNING[12:])
    assert run(net, IMAGES[12:], TIMES[12:], TURNING[12:]) == expected


def test_survives_a_file():
    file = io.BytesIO()
    np.savez(file, **after(12).state_dict())
    file.seek(0)
    net = ReferenceNetwork(preset("published"), SHAPE)
    net.load_state_dict(np.load(file))
    assert run(net, IMAGES[12:], TIMES[12:], TURNING[12:]) == run(after(12), IMAGES[12:], TIMES[12:], TURNING[12:])


@pytest.mark.parametrize("name", NAMES)
def test_a_missing_entry_is_named(name):
    state = after(3).state_dict()
    del state[name]
    with pytest.raises(ParameterError, match=f"load_state_dict: no entry '{name}'"):
        ReferenceNetwork(preset(), SHAPE).load_state_dict(state)


@pytest.mark.parametrize("name", PLANES)
def test_a_plane_of_another_size_is_named(name):
    state = after(3).state_dict() | {name: np.zeros((24, 33), np.float32)}
    with pytest.raises(ShapeError, match=rf"load_state_dict: {name} has shape \(24, 33\): must be \(24, 32\)"):
        ReferenceNetwork(preset(), SHAPE).load_state_dict(state)


@pytest.mark.parametrize("window", [np.zeros(4), np.zeros((2, 3))])
def test_a_window_of_another_form_is_refused(window):
    with pytest.raises(ShapeError, match=r"window has shape .*: must be \(N, 4\)"):
        ReferenceNetwork(preset(), SHAPE).load_state_dict(after(3).state_dict() | {"window": window})


def test_a_refused_state_changes_nothing():
    net = after(12)
    with pytest.raises(ParameterError):
        net.load_state_dict({"luma": np.zeros(SHAPE, np.float32)})
    assert run(net, IMAGES[12:], TIMES[12:], TURNING[12:]) == run(after(12), IMAGES[12:], TIMES[12:], TURNING[12:])
