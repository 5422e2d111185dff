"""The network as a whole: silence, ranges, what it remembers, what it makes of odd time."""

from dataclasses import replace

import numpy as np
import pytest

from lobula.model.network import TAPS, ReferenceNetwork
from lobula.model.presets import preset
from lobula.params import with_settings
from lobula.stimuli import translating

from .movies import approach, collisions, growing, noisy, run, stamps, states

PRESETS = pytest.mark.parametrize("name", ["published", "paper"])
EVERY = pytest.mark.parametrize("name", ["published", "paper", "lobula"])
SHAPE = (24, 32)


def at_rest(reading):
    return reading[1:6] == (0.5, 0.5, 0.0, 0.0, (0, 0, 0, 0))


@EVERY
@pytest.mark.parametrize("rate_hz", [15, 30, 60])
def test_silence_on_nothing(name, rate_hz):
    """A still scene is silent and, once warm, in order."""
    readings = run(preset(name), np.repeat(noisy(1), 40, axis=0), stamps(40, rate_hz))
    assert all(at_rest(reading) and not reading.collision for reading in readings)
    assert set(states(readings)) == {"warming_up", "ok"}
    assert states(readings)[-1] == "ok"


@PRESETS
def test_potentials_stay_in_their_ranges(name):
    black_and_white = np.repeat(np.array([0, 255] * 4, np.uint8), 24 * 32).reshape(8, *SHAPE)
    stripes = np.tile(np.arange(32) % 8 < 4, (8, 24, 1)) * np.uint8(255)
    drift = np.stack([np.roll(image, 2 * k, axis=1) for k, image in enumerate(stripes)])
    images = np.concatenate([noisy(12, low=0, high=256), black_and_white, drift, drift[::-1]])
    readings = run(preset(name), images, stamps(len(images)))
    for reading in readings:
        assert 0.5 <= reading.lgmd1 < 1
        assert 0.5 <= reading.lgmd2 < 1
        assert 0 <= reading.lptc_r < 1
        assert -1 < reading.lptc_l <= 0
    assert max(r.lptc_r for r in readings) > 0.9  # the drift one way,
    assert min(r.lptc_l for r in readings) < -0.9  # and the other


@EVERY
def test_adapted_potentials_never_reach_the_third_spike(name):
    # SFA holds an LGMD at or below 800 / 833.3 = 0.96: floor(exp(4 * 0.26)) = 2
    readings = run(preset(name), noisy(20), stamps(20))
    assert max(r.lgmd1 for r in readings) <= 0.96 + 1e-12
    assert {spikes for r in readings for spikes in r.spikes[:2]} <= {0, 1, 2}


@EVERY
def test_reset_really_resets(name):
    net = ReferenceNetwork(preset(name), SHAPE)
    images = noisy(12)
    first = run(net, images, stamps(12))
    net.reset()
    assert run(net, images, stamps(12)) == first
    assert len({r.lgmd1 for r in first}) > 3


def test_networks_do_not_share_anything():
    one, other = (ReferenceNetwork(preset(), SHAPE) for _ in range(2))
    images = noisy(10)
    mixed = []
    for k, t in enumerate(stamps(10)):
        mixed.append(one.step(images[k], t))
        other.step(images[9 - k], t)
    assert mixed == run(preset(), images, stamps(10))


def test_frames_are_not_modified_nor_kept():
    images = noisy(8)
    expected = run(preset(), images, stamps(8))
    net = ReferenceNetwork(preset(), SHAPE)
    buffer = np.empty(SHAPE, np.float32)
    for image, t, reading in zip(images, stamps(8), expected, strict=True):
        buffer[:] = image
        assert net.step(buffer, t) == reading
        assert np.array_equal(buffer, image)
        buffer[:] = 0  # the camera's own buffer goes on to something else


def test_taps_are_maps_of_the_picture_and_change_nothing():
    images = noisy(6)
    plain = run(preset(), images, stamps(6))
    net = ReferenceNetwork(preset(), SHAPE)
    tapped = [net.step(image, t, taps=TAPS) for image, t in zip(images, stamps(6), strict=True)]
    assert [r[:-1] for r in tapped] == [r[:-1] for r in plain]
    for reading in tapped:
        assert set(reading.taps) == set(TAPS)
        assert {(m.shape, m.dtype.name) for m in reading.taps.values()} == {(SHAPE, "float32")}
    assert not any(m.any() for m in tapped[0].taps.values())  # nothing to compare the first picture with
    assert np.array_equal(tapped[3].taps["change"], images[3].astype(np.float32) - images[2])


def test_what_saturates_and_what_the_patches_hear():
    """Half the picture darkens by 60: 20 go on, yet the patches hear it all, and so does the arousal of LGMD-1."""
    settings = {
        "saturation": {"enabled": True, "limit_grey": 20.0},
        "coarse": {"patch_px": 8, "floor_grey": 2.0},  # 3 x 4 patches, 6 of which darken
        "lgmd2": {"on_gain": 0.0, "off_gain": 0.0, "product_gain": 0.0, "coarse_gain": 1.0, "sigmoid_grey": 29.0},
    }
    net = ReferenceNetwork(with_settings(preset("published"), settings, "test"), SHAPE)
    image = np.full(SHAPE, 100, np.uint8)
    net.step(image, 0.0)
    image[:, 16:] = 40
    reading = net.step(image, 1 / 30, taps=("change", "lgmd1_summation", "lgmd1_inhibition_off"))
    assert set(np.unique(reading.taps["change"])) == {-20.0, 0.0}
    # OFF = 6 * 64 * (60 - 2) = 29 * 768; K = 1 / (1 + exp(-1)) = 0.731059, U = 0.96 K
    assert reading.lgmd2 == pytest.approx(0.96 * 0.731059, abs=1e-5)
    # arousal 1000/30 / (1000/30 + 10) * 30 / 20 = 1.153846 is the bias: a mean change of 30, not of 10
    cell, inhibition = (reading.taps[f"lgmd1_{name}"][12, 24] for name in ("summation", "inhibition_off"))
    assert inhibition == pytest.approx(20 * 0.652659, rel=1e-5)
    assert cell == pytest.approx(20 * (1 - 1.153846 * 0.652659), rel=1e-4)


def test_only_the_taps_asked_for_are_returned():
    net = ReferenceNetwork(preset(), SHAPE)
    assert set(net.step(noisy(1)[0], 0.0, taps=("motion",)).taps) == {"motion"}
    assert set(net.step(noisy(2)[1], 0.034, taps=("change", "lgmd2_grouped")).taps) == {"change", "lgmd2_grouped"}
    assert net.step(noisy(1)[0], 0.067).taps == {}


def test_a_frame_that_waits_shows_nothing_new():
    net = ReferenceNetwork(preset(), SHAPE)
    last = run(net, noisy(4), stamps(4))[-1]
    reading = net.step(noisy(1, seed=3)[0], 0.105, taps=TAPS)
    assert not any(m.any() for m in reading.taps.values())
    assert reading.spikes == (0, 0, 0, 0)
    assert reading[1:5] == last[1:5]  # the potentials stand until the next tick


def test_warm_up_spikes_do_not_count():
    """An object already near at the start spikes at once; the decision waits 200 ms and then starts from nothing."""
    images = growing(11, 0.9)
    readings = run(preset("published"), images, stamps(11))
    assert min(sum(r.spikes[i] for r in readings[:6]) for i in (0, 1)) >= 4
    assert states(readings)[:7] == ["warming_up"] * 6 + ["ok"]
    assert collisions(readings)[0] >= 7  # two steps of evidence, of which frame 6 is the first
    cold = replace(preset("published"), decision=replace(preset("published").decision, warm_up_ms=0.0))
    assert collisions(run(cold, images, stamps(11)))[0] < 6


@EVERY
@pytest.mark.parametrize("factor", [2, 4])
def test_fast_sources_are_sampled_at_the_tick(name, factor):
    """60 and 120 Hz: the pictures in between may be anything."""
    slow, fast = noisy(10), noisy(10 * factor, seed=1)
    fast[::factor] = slow
    readings = run(preset(name), fast, stamps(10 * factor, 30 * factor))
    assert readings[::factor] == run(preset(name), slow, stamps(10))
    assert all(not any(r.spikes) for k, r in enumerate(readings) if k % factor)


@EVERY
def test_repeats_in_a_file_are_neither_stillness_nor_double_motion(name):
    """A 10 Hz source in a 30 Hz file reads as the 10 Hz source itself."""
    slow = noisy(12)
    readings = run(preset(name), np.repeat(slow, 3, axis=0), stamps(36))
    assert readings[::3] == run(preset(name), slow, stamps(12, 10))
    held = [r for k, r in enumerate(readings) if k % 3]
    assert not any(any(r.spikes) for r in held)
    assert held[10].lgmd1 == readings[15].lgmd1  # potentials stand meanwhile


def test_compressed_repeats_count_as_repeats():
    """A codec touches a held picture a little: less than 8 grey, and in few places."""
    slow = noisy(8)
    file = np.repeat(slow, 3, axis=0)
    file[1::3, 4, :10] += 7  # 10 of 768 pixels by 7: a mean of 0.09
    readings = run(preset(), file, stamps(24))
    assert readings[::3] == run(preset(), slow, stamps(8, 10))


@EVERY
def test_gap_starts_afresh(name):
    images = noisy(20)
    times = [*stamps(10, 31), *(1.0 + t for t in stamps(10, 31))]  # at 31 Hz no frame falls on 200 ms
    readings = run(preset(name), images, times)
    assert at_rest(readings[10])
    assert states(readings) == (["warming_up"] * 7 + ["ok"] * 3) * 2
    fresh = run(preset(name), images[10:], times[10:])
    assert [r[:6] for r in readings[10:]] == [r[:6] for r in fresh]


def test_gap_ends_a_collision_by_the_clock():
    """A late frame leaves it on; after more than half a second it is over."""
    movie = approach()
    p = preset("published")
    first = collisions(run(p, movie.images, movie.times_s))[0]
    times = movie.times_s.copy()
    times[first + 1 :] += 0.1
    assert collisions(run(p, movie.images, times))[:3] == [first, first + 1, first + 2]
    times[first + 1 :] += 0.5
    assert collisions(run(p, movie.images, times))[:1] == [first]
    assert not run(p, movie.images, times)[first + 1].collision


@PRESETS
def test_one_dropped_frame_moves_an_alarm_by_67_ms_at_most(name):
    movie = approach()
    first = movie.times_s[collisions(run(preset(name), movie.images, movie.times_s))[0]]
    for lost in range(12, len(movie) - 1, 3):
        images, times = np.delete(movie.images, lost, axis=0), np.delete(movie.times_s, lost)
        assert times[collisions(run(preset(name), images, times))[0]] == pytest.approx(first, abs=0.067)


@pytest.mark.parametrize(("speed_cm_s", "scene"), [(8.0, "arena"), (12.0, "arena"), (20.0, "plain"), (30.0, "plain")])
def test_passing_objects_drive_the_lptc_alike_at_15_hz(speed_cm_s, scene):
    """From 2 to 8 px a frame, and twice that at 15 Hz: the typical net motion is the same within a factor of two."""
    drive = []
    for rate_hz in (15.0, 30.0):
        movie = translating(speed_cm_s=speed_cm_s, distance_cm=6.0, span_cm=10.0, scene=scene, rate_hz=rate_hz,
                            lead_s=0.2, hold_s=0.0)  # fmt: skip
        readings = run(preset("paper"), movie.images, movie.times_s)
        hs = np.array([2 * np.arctanh(r.lptc_r) for r in readings])  # |HS| / (n K_hs), from the sigmoid
        drive.append(np.median(hs[hs > 0.2 * hs.max()]))
    assert 0.5 < drive[0] / drive[1] < 2.0
