"""However frames are handed over, one by one, in blocks, in streams: the same numbers, to the bit, on both engines."""

from __future__ import annotations

import numpy as np
import pytest

import lobula
from lobula.engine.network import Network
from lobula.errors import ParameterError
from lobula.types import NEURONS, TRACE_DTYPE

from .engines import needs_core
from .films import Film, at_hz, drifting, filmed, growing, jittered, lamps, looming, noise, translating, turned

CORE = [pytest.param("core", name, marks=needs_core) for name in ("paper", "published", "lobula")]
FILMS = {
    "looming": lambda: filmed(looming(scene="arena")),
    "turning": lambda: turned(filmed(translating(scene="arena"))),
    "60-hz": lambda: filmed(looming(rate_hz=60.0)),
    "gap": lambda: jittered(filmed(looming(scene="arena")), gap_s=0.8),
    "noise": lambda: noise(33, 47, frames=40),
    "drifting": lambda: drifting(40, 70, frames=21),
    "lamps": lambda: turned(lamps(72, 99)),
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


class TestBlocks:
    @pytest.mark.parametrize(("engine", "preset"), [*CORE, ("reference", "published")])  # where a block is a loop
    @pytest.mark.parametrize("name", FILMS)
    def test_a_block_is_its_steps(self, net, name):
        film = FILMS[name]()
        rows = by_block(net, film)
        net.reset()
        assert rows == by_steps(net, film)
        assert [row[:2] for row in rows] == list(enumerate(film.times_s))

    def test_a_block_is_a_table(self, net):
        trace = net.run(growing().images, growing().times_s)
        assert (trace.dtype, trace.shape) == (TRACE_DTYPE, (30,))

    @pytest.mark.parametrize("cut", [1, 2, 7, 20])
    def test_blocks_and_steps_take_turns(self, net, cut):
        film = turned(growing())
        whole = by_block(net, film)
        net.reset()
        mixed = by_block(net, film, slice(0, cut))
        mixed += by_steps(net, film, slice(cut, cut + 3))
        mixed += by_block(net, film, slice(cut + 3, None))
        assert mixed == whole

    def test_blocks_follow_each_other(self, net):
        film = growing()
        whole = by_block(net, film)
        net.reset()
        assert [row for i in range(0, 30, 7) for row in by_block(net, film, slice(i, i + 7))] == whole

    @pytest.mark.parametrize("threads", [1, 2, 5])
    def test_streams_are_networks_alone(self, net, engine, threads):
        films = [drifting(30, 40, frames=18), growing(30, 40, frames=18), noise(30, 40, frames=18)]
        block = np.array([film.images for film in films], np.float32)
        times = np.array([at_hz(hz, 18) for hz in (15, 30, 60)])
        turning = np.zeros((3, 18), np.bool_)
        turning[1, 5] = True
        first = net.run(block[:, :7], times[:, :7], turning=turning[:, :7], threads=threads)
        second = net.run(block[:, 7:], times[:, 7:], turning=turning[:, 7:], threads=threads)
        assert (first.shape, second.shape) == ((3, 7), (3, 11))
        for i in range(3):
            alone = Network(net.params, engine=engine)
            assert first[i].tolist() + second[i].tolist() == by_block(alone, Film(block[i], times[i], turning[i]))

    def test_one_row_of_times_serves_all_streams_and_their_number_may_change(self, net):
        film = growing()
        alone = net.run(film.images, film.times_s)
        both = net.run(np.array([film.images, film.images]), film.times_s)  # starts afresh
        assert both[0].tolist() == both[1].tolist() == alone.tolist()
        again = net.run(np.array([film.images, film.images]), np.tile(film.times_s + 1, (2, 1)))
        assert again["frame"].tolist() == [list(range(30, 60))] * 2
        with pytest.raises(ParameterError, match="2 streams: must be one"):
            net.step(film.images[0], 9.0)
        with pytest.raises(ParameterError, match="2 streams"):
            net.state_dict()

    def test_networks_that_take_turns_do_not_meet(self, engine):
        films = [growing(), filmed(translating(width=80, height=40))]
        nets = [Network(lobula.preset(name), engine=engine) for name in ("paper", "published")]
        rows = [[], []]
        for i in range(30):
            for net, film, row in zip(nets, films, rows, strict=True):
                row += by_steps(net, film, slice(i, i + 1))
        for net, film, row in zip(nets, films, rows, strict=True):
            net.reset()
            assert row == by_steps(net, film, slice(0, 30))

    def test_reset_forgets_everything(self, net, engine):
        by_block(net, FILMS["turning"]())
        net.reset()
        film = noise(33, 47)  # of another size
        assert by_steps(net, film) == by_steps(Network(net.params, engine=engine), film)
