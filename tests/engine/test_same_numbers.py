"""However frames are handed over, one by one, in blocks, in streams, on threads: the same numbers, to the bit."""

from __future__ import annotations

import numpy as np
import pytest

import lobula
from lobula.engine.network import Network
from lobula.types import NEURONS

from .engines import needs_core, run
from .films import Film, at_hz, drifting, filmed, jittered, looming, noise, translating, turned

pytestmark = needs_core

FILMS = {
    "looming": lambda: filmed(looming(scene="arena")),
    "turning": lambda: turned(filmed(translating(scene="arena"))),
    "60-hz": lambda: filmed(looming(rate_hz=60.0)),
    "gap": lambda: jittered(filmed(looming(scene="arena")), gap_s=0.8),
    "noise": lambda: noise(33, 47, frames=40),
    "drifting": lambda: drifting(40, 70, frames=21),
}


def by_steps(net, film, frames=slice(None)):
    turning = np.zeros(len(film.images), np.bool_) if film.turning is None else film.turning
    rows = []
    for i in range(*frames.indices(len(film.images))):
        r = net.step(film.images[i], float(film.times_s[i]), turning=bool(turning[i]))
        rows.append((i, r.time_s, *(getattr(r, name) for name in NEURONS), *r.spikes, r.collision, r.state))
    return rows


def by_block(net, film, frames=slice(None)):
    turning = None if film.turning is None else film.turning[frames]
    return net.run(film.images[frames], film.times_s[frames], turning=turning).tolist()


@pytest.mark.parametrize("preset", ["paper", "published"])
@pytest.mark.parametrize("name", FILMS)
def test_block_is_steps(name, preset):
    film, params = FILMS[name](), lobula.preset(preset)
    assert by_block(Network(params, engine="core"), film) == by_steps(Network(params, engine="core"), film)


@pytest.mark.parametrize("cut", [1, 2, 7, 20])
def test_blocks_and_steps_take_turns(cut):
    film = FILMS["turning"]()
    net = Network(engine="core")
    mixed = by_block(net, film, slice(0, cut))
    mixed += by_steps(net, film, slice(cut, cut + 3))
    mixed += by_block(net, film, slice(cut + 3, None))
    assert mixed == by_block(Network(engine="core"), film)


def test_a_block_of_pictures_that_outgrow_the_cache():
    """From about 2 MB of state the core takes several frames through the rows together."""
    film = drifting(260, 420, frames=19)
    film = film._replace(turning=np.arange(19) % 7 == 3, times_s=film.times_s + (np.arange(19) > 11) * 0.9)
    params = lobula.preset("published")
    assert by_block(Network(params, engine="core"), film) == by_steps(Network(params, engine="core"), film)


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_streams_are_networks_alone(threads):
    films = [drifting(40, 60, seed=seed, frames=18) for seed in range(3)]
    times = np.array([at_hz(hz, 18) for hz in (15, 30, 60)])
    turning = np.zeros((3, 18), np.bool_)
    turning[1, 5] = True
    net = Network(engine="core")
    block = np.array([film.images for film in films])
    first = net.run(block[:, :7], times[:, :7], turning=turning[:, :7], threads=threads)
    second = net.run(block[:, 7:], times[:, 7:], turning=turning[:, 7:], threads=threads)
    for i, film in enumerate(films):
        alone = run("core", net.params, Film(film.images, times[i], turning[i]))
        assert first[i].tolist() + second[i].tolist() == alone.tolist()


def test_networks_that_take_turns_do_not_meet():
    films = [FILMS["looming"](), filmed(translating(width=80, height=40))]
    nets = [Network(lobula.preset(name), engine="core") for name in ("paper", "published")]
    length = min(len(film.images) for film in films)
    rows = [[], []]
    for i in range(length):
        for net, film, row in zip(nets, films, rows, strict=True):
            row += by_steps(net, film, slice(i, i + 1))
    for net, film, row in zip(nets, films, rows, strict=True):
        assert row == by_steps(Network(net.params, engine="core"), film, slice(0, length))


def test_reset_forgets_everything():
    net = Network(engine="core")
    by_block(net, FILMS["turning"]())
    net.reset()
    film = FILMS["noise"]()  # of another size
    assert by_steps(net, film) == by_steps(Network(engine="core"), film)


def test_a_network_dropped_leaves_the_others_alone():
    film = FILMS["looming"]()
    net = Network(engine="core")
    rows = by_steps(net, film, slice(0, 10))
    for _ in range(20):
        by_block(Network(engine="core"), FILMS["drifting"]())
    assert rows + by_steps(net, film, slice(10, None)) == by_steps(Network(engine="core"), film)


def test_pictures_are_not_written_to():
    film = FILMS["drifting"]()
    before = film.images.copy()
    film.images.flags.writeable = False
    by_block(Network(engine="core"), film)
    assert np.array_equal(film.images, before)
