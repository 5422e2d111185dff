"""Named states: which one is told, and that none of them raises a collision."""

from dataclasses import replace

import numpy as np
import pytest

from lobula.model.network import ReferenceNetwork
from lobula.model.presets import preset

from .movies import approach, collisions, noisy, run, stamps, states
from .stamps import HABITS, written

PUBLISHED = preset("published")
PRESETS = pytest.mark.parametrize("name", ["published", "paper"])
NOTHING = (0, 0, 0, 0)


def scene(count):
    """A still textured scene in which the light can go up by 40 without clipping."""
    wall = np.random.default_rng(0).integers(60, 160, (24, 32), np.uint8)
    return np.repeat(wall[None], count, axis=0)


def test_warming_up_for_200_ms():
    assert states(run(PUBLISHED, scene(9), stamps(9))) == ["warming_up"] * 6 + ["ok"] * 3
    assert states(run(PUBLISHED, scene(6), stamps(6, 15))) == ["warming_up"] * 3 + ["ok"] * 3


@pytest.mark.parametrize("habit", HABITS)
@pytest.mark.parametrize(
    ("hz", "warm", "turning"), [(10, 2, 1), (15, 3, 2), (20, 4, 2), (25, 5, 2), (30, 6, 3), (60, 12, 5)]
)
def test_the_rounding_of_stamps_changes_no_state(hz, warm, turning, habit):
    """Frames in less than 200 ms; the frame that turns, and those up to 67 ms after it."""
    told = states(run(PUBLISHED, scene(30), written(hz, 30, habit), [k == 15 for k in range(30)]))
    assert told == ["warming_up"] * warm + ["ok"] * (15 - warm) + ["turning"] * turning + ["ok"] * (15 - turning)


def test_flash_is_told_where_the_light_changes():
    images = scene(16)
    images[9:12] += 40  # on at frame 9, off at frame 12
    assert states(run(PUBLISHED, images, stamps(16)))[6:] == ["ok"] * 3 + ["flash", "ok", "ok", "flash"] + ["ok"] * 3


def test_flash_in_a_held_picture_is_told_once():
    images = np.repeat(np.concatenate([noisy(4).clip(60, 160), scene(4)]), 3, axis=0)
    images[18:] += 40  # the seventh picture of the 10 Hz source
    told = states(run(PUBLISHED, images, stamps(24)))
    assert told[18:] == ["flash"] + ["ok"] * 5


def test_turning_is_told_while_it_lasts_and_67_ms_more():
    turns = [8 <= k <= 10 for k in range(16)]
    told = states(run(PUBLISHED, scene(16), stamps(16), turns))
    assert told == ["warming_up"] * 6 + ["ok"] * 2 + ["turning"] * 5 + ["ok"] * 3


@pytest.mark.parametrize(
    ("frame", "turns", "flashes", "told"),
    [(3, True, True, "warming_up"), (3, False, True, "warming_up"), (9, True, True, "turning"),
     (9, True, False, "turning"), (9, False, True, "flash"), (9, False, False, "ok")],
)  # fmt: skip
def test_precedence(frame, turns, flashes, told):
    images = scene(12)
    if flashes:
        images[frame:] += 40
    turning = [turns and k == frame for k in range(12)]
    assert states(run(PUBLISHED, images, stamps(12), turning))[frame] == told


def test_turning_outlives_a_flash():
    images = scene(14)
    images[9:] += 40
    told = states(run(PUBLISHED, images, stamps(14), [k == 8 for k in range(14)]))
    assert told[8:12] == ["turning", "turning", "turning", "ok"]


def test_turn_on_a_frame_that_waits_counts():
    net = ReferenceNetwork(PUBLISHED, (24, 32))
    run(net, scene(20), stamps(20, 60))
    assert net.step(scene(1)[0], 20 / 60).state == "ok"
    assert net.step(scene(1)[0], 21 / 60, turning=True).state == "turning"
    assert [net.step(scene(1)[0], k / 60).state for k in (22, 23, 24, 25, 26)] == ["turning"] * 4 + ["ok"]


@PRESETS
def test_turning_never_raises_a_collision(name):
    movie = approach()
    first = collisions(run(preset(name), movie.images, movie.times_s))[0]
    for start in (0, 8, first - 1, first):
        turns = [k >= start for k in range(len(movie))]
        readings = run(preset(name), movie.images, movie.times_s, turns)
        assert not collisions(readings)
        assert states(readings)[max(start, 6) :] == ["turning"] * (len(movie) - max(start, 6))


def test_turning_lets_a_collision_end_by_itself():
    movie = approach()
    first = collisions(run(PUBLISHED, movie.images, movie.times_s))[0]
    turns = [k > first for k in range(len(movie))]
    seen = collisions(run(PUBLISHED, movie.images, movie.times_s, turns))
    assert seen[0] == first
    assert seen[-1] == first + 5  # at the sixth frame 200 ms are over


def test_after_a_turn_the_window_is_empty():
    """The spikes of before and of during the turn are gone: an alarm needs two steps after the 67 ms."""
    movie = approach()
    net = ReferenceNetwork(PUBLISHED, movie.images.shape[1:])
    first = collisions(run(PUBLISHED, movie.images, movie.times_s))[0]
    turns = [k == first - 1 for k in range(len(movie))]
    seen = []
    for k, (image, t) in enumerate(zip(movie.images, movie.times_s.tolist(), strict=True)):
        seen.append(net.step(image, t, turning=turns[k]))
        if first - 1 <= k <= first + 1:  # the turn, and the two frames of 67 ms after it
            assert not net.decision.window
    again = collisions(seen)[0]
    assert states(seen)[first - 1 : first + 3] == ["turning"] * 3 + ["ok"]
    assert again >= first + 3
    fresh = [seen[k].spikes for k in range(first + 2, again + 1)]
    assert min(sum(s.lgmd1 for s in fresh), sum(s.lgmd2 for s in fresh)) >= 4


@pytest.mark.parametrize("neurons", ["all", "lgmds", "lgmd2"])
def test_no_state_raises_a_collision(neurons):
    images = scene(40)
    images[20:22] += 40
    turns = [12 <= k < 16 for k in range(40)]
    times = np.array(stamps(40)) + np.where(np.arange(40) >= 30, 1.0, 0.0)  # and a gap
    readings = run(preset("paper", neurons=neurons), images, times, turns)
    assert set(states(readings)) == {"warming_up", "ok", "turning", "flash"}
    assert not collisions(readings)
    assert all(reading.spikes == NOTHING for reading in readings)


def test_states_do_not_change_the_potentials():
    movie = approach()
    plain = run(PUBLISHED, movie.images, movie.times_s)
    turned = run(PUBLISHED, movie.images, movie.times_s, [True] * len(movie))
    assert [r[:6] for r in plain] == [r[:6] for r in turned]


def test_no_wait_after_a_turn_where_none_is_set():
    p = replace(PUBLISHED, decision=replace(PUBLISHED.decision, after_turn_ms=0.0))
    told = states(run(p, scene(12), stamps(12), [k == 8 for k in range(12)]))
    assert told[8:] == ["turning", "ok", "ok", "ok"]
