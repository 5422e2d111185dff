"""The public network: every behaviour once, on both engines."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from lobula import Frame, Network, preset, stimuli
from lobula.engine import library
from lobula.engine import network as network_module
from lobula.errors import ParameterError, ShapeError, TimeError
from lobula.params import with_settings
from lobula.types import TRACE_DTYPE

from .movies import MOVIES, stimulus

ENGINES = ("reference", "core") if library.available() else ("reference",)
SHAPE = (36, 52)
TIMES_S = np.arange(30) / 30


@pytest.fixture(params=ENGINES)
def net(request: pytest.FixtureRequest) -> Network:
    return Network(preset("published"), engine=request.param)


def steps(net: Network, images, times_s=TIMES_S):
    return [net.step(image, t) for image, t in zip(images, times_s, strict=True)]


def columns(table: np.ndarray) -> np.ndarray:
    return np.array([table[name] for name in ("lgmd1", "lgmd2", "lptc_r", "lptc_l")])


class TestWhatItSays:
    def test_an_approach_is_a_collision_and_a_recession_is_not(self, net: Network):
        for kind, collides in (("looming", True), ("receding", False)):
            movie = stimulus(kind, 30)
            net.reset()
            assert net.run(movie.images, movie.times_s)["collision"].any() == collides

    def test_a_mirrored_movie_swaps_the_lptcs(self, net: Network):
        movie = stimulus("translating", 30)
        there = net.run(movie.images, movie.times_s)
        net.reset()
        mirror = stimuli.mirrored(movie)
        back = net.run(mirror.images, mirror.times_s)
        assert there["lptc_r"].max() > 0.5
        np.testing.assert_allclose(back["lptc_r"], -there["lptc_l"], atol=1e-6)
        np.testing.assert_allclose(back["lptc_l"], -there["lptc_r"], atol=1e-6)
        for name in ("lgmd1", "lgmd2"):
            np.testing.assert_allclose(back[name], there[name], atol=1e-6)

    def test_ranges(self, net: Network):
        for movie in MOVIES.values():
            net.reset()
            table = net.run(movie(SHAPE, 30), TIMES_S)
            for name in ("lgmd1", "lgmd2"):
                assert ((table[name] >= 0.5) & (table[name] < 1)).all()
            assert ((table["lptc_r"] >= 0) & (table["lptc_r"] < 1)).all()
            assert ((table["lptc_l"] <= 0) & (table["lptc_l"] > -1)).all()
            assert (table["lptc_r"] * table["lptc_l"] == 0).all()

    def test_a_still_picture_is_silent(self, net: Network):
        table = net.run(MOVIES["constant"](SHAPE, 30), TIMES_S)
        assert columns(table)[:2].tolist() == [[0.5] * 30] * 2
        assert not columns(table)[2:].any()
        assert not table["collision"].any()
        assert table["state"].tolist() == ["warming_up"] * 6 + ["ok"] * 24

    def test_yaw_is_turning(self, net: Network):
        images = MOVIES["growing"](SHAPE, 12)
        yaw = [-90.0 if t == 8 else 3.0 for t in range(12)]
        states = [net.step(image, t / 30, yaw_rate_deg_s=yaw[t]).state for t, image in enumerate(images)]
        # 67 ms after the turn at frame 8: until frame 10
        assert states == ["warming_up"] * 6 + ["ok", "ok", "turning", "turning", "turning", "ok"]


class TestBlocks:
    @pytest.mark.parametrize("shape", [SHAPE, (72, 99), (200, 320)])
    def test_a_block_is_the_same_as_its_steps(self, net: Network, shape: tuple[int, int]):
        if net.engine == "reference" and shape[0] > 72:
            pytest.skip("slow, and a block is a loop there")
        images = np.concatenate([MOVIES["growing"](shape, 15), MOVIES["lamps"](shape, 15)])
        turning = np.arange(30) == 20
        one = [net.step(image, t / 30, turning=turning[t]) for t, image in enumerate(images)]
        net.reset()
        table = net.run(images, TIMES_S, turning=turning)
        assert table.dtype == TRACE_DTYPE
        assert table.shape == (30,)
        assert table["frame"].tolist() == list(range(30))
        assert table["time_s"].tolist() == TIMES_S.tolist()
        for r, row in zip(one, table, strict=True):
            assert [r.lgmd1, r.lgmd2, r.lptc_r, r.lptc_l] == [row[n] for n in ("lgmd1", "lgmd2", "lptc_r", "lptc_l")]
            assert list(r.spikes) == [row[f"spikes_{n}"] for n in ("lgmd1", "lgmd2", "lptc_r", "lptc_l")]
            assert (r.collision, r.state) == (row["collision"], row["state"])

    def test_blocks_follow_each_other(self, net: Network):
        images = MOVIES["growing"](SHAPE, 30)
        whole = net.run(images, TIMES_S)
        net.reset()
        parts = [net.run(images[i : i + 7], TIMES_S[i : i + 7]) for i in range(0, 30, 7)]
        assert np.concatenate(parts).tobytes() == whole.tobytes()

    @pytest.mark.parametrize("threads", [1, 2, 5])
    def test_streams_are_the_same_as_networks_of_their_own(self, net: Network, threads: int):
        images = np.array([MOVIES[name](SHAPE, 30).astype(np.float32) for name in ("growing", "sliding", "noise")])
        alone = []
        for stream in images:
            net.reset()
            alone.append(net.run(stream, TIMES_S))
        net.reset()
        first = net.run(images[:, :12], TIMES_S[:12], threads=threads)
        second = net.run(images[:, 12:], np.tile(TIMES_S[12:], (3, 1)), threads=threads)
        assert first.shape == (3, 12)
        assert np.concatenate([first, second], axis=1).tobytes() == np.array(alone).tobytes()

    def test_another_number_of_streams_starts_afresh(self, net: Network):
        images = MOVIES["growing"](SHAPE, 30)
        alone = net.run(images, TIMES_S)
        both = net.run(np.array([images, images]), TIMES_S)
        assert both[0].tobytes() == both[1].tobytes() == alone.tobytes()
        with pytest.raises(ParameterError, match="2 streams"):
            net.step(images[0], 2.0)
        with pytest.raises(ParameterError, match="2 streams"):
            net.state_dict()


class TestInput:
    def test_frames_bring_their_time(self, net: Network):
        images = MOVIES["growing"](SHAPE, 12)
        one = [net.step(Frame(image, t / 30, t)) for t, image in enumerate(images)]
        net.reset()
        assert one == steps(net, images, TIMES_S[:12])

    @pytest.mark.parametrize("dtype", [np.uint8, np.float16, np.float32, np.float64, ">f4"])
    def test_every_dtype_means_the_same(self, net: Network, dtype: str):
        images = MOVIES["growing"](SHAPE, 12)
        expected = steps(net, images, TIMES_S[:12])
        net.reset()
        assert steps(net, images.astype(dtype), TIMES_S[:12]) == expected
        net.reset()
        assert columns(net.run(images.astype(dtype), TIMES_S[:12])).T.tolist() == [list(r[1:5]) for r in expected]

    def test_views_of_any_stride_and_dtypes_in_turn(self, net: Network):
        images = MOVIES["growing"](SHAPE, 12)
        expected = steps(net, images, TIMES_S[:12])
        views = []
        for t, image in enumerate(images):
            wide = np.zeros((3 * SHAPE[0], 2 * SHAPE[1] + 3), (np.uint8, np.float32)[t % 2])
            view = wide[1::3, 2:-1:2] if t % 3 else wide[: SHAPE[0], ::-1][:, : SHAPE[1]]
            view[...] = image
            view.flags.writeable = False
            views.append(view)
        net.reset()
        assert steps(net, views, TIMES_S[:12]) == expected
        net.reset()
        backwards = np.ascontiguousarray(images[::-1])[::-1]
        assert columns(net.run(backwards, TIMES_S[:12])).T.tolist() == [list(r[1:5]) for r in expected]
        net.reset()
        transposed = np.ascontiguousarray(images.transpose(0, 2, 1)).transpose(0, 2, 1)
        assert columns(net.run(transposed, TIMES_S[:12])).T.tolist() == [list(r[1:5]) for r in expected]

    def test_input_is_left_alone(self, net: Network):
        images = MOVIES["sliding"](SHAPE, 12)
        before = images.copy()
        steps(net, images, TIMES_S[:12])
        assert (images == before).all()

    @pytest.mark.parametrize(
        ("image", "says"),
        [
            (np.zeros((*SHAPE, 3), np.uint8), "colour"),
            (np.zeros((1, 1), np.uint8), "at least 32 x 24"),
            (np.zeros((0, 0), np.uint8), "at least"),
            (np.zeros(SHAPE, np.int32), "astype"),
            (np.full(SHAPE, np.nan, np.float32), "NaN"),
            (np.full(SHAPE, 300.0), "0..255"),
            (np.full(SHAPE, -1.0, np.float32), "0..255"),
            (np.linspace(0, 1, SHAPE[0] * SHAPE[1]).reshape(SHAPE), "image \\* 255"),
            (np.zeros((3, *SHAPE), np.uint8), "must be"),
            ("picture", "must be"),
        ],
        ids=lambda value: value if isinstance(value, str) else None,
    )
    def test_bad_images_are_refused_in_one_line(self, net: Network, image: np.ndarray, says: str):
        with pytest.raises(ShapeError, match=says) as caught:
            net.step(image, 0.0)
        assert "\n" not in str(caught.value)

    def test_what_was_refused_leaves_no_trace(self, net: Network):
        images = MOVIES["growing"](SHAPE, 12)
        expected = steps(net, images, TIMES_S[:12])
        net.reset()
        readings = []
        for t, image in enumerate(images):
            for bad in (np.full(SHAPE, np.nan, np.float32), np.zeros((72, 99), np.uint8), np.zeros(SHAPE, np.int64)):
                with pytest.raises(ShapeError):
                    net.step(bad if t else np.zeros((3, 3)), 99.0)
            readings.append(net.step(image, t / 30))
            with pytest.raises(TimeError):
                net.step(image, t / 30)
        assert readings == expected

    def test_one_bad_pixel_in_a_float_frame(self, net: Network):
        net.step(np.full(SHAPE, 9.0, np.float32), 0.0)
        for value in (np.nan, np.inf, -np.inf, -0.5, 255.5):
            image = np.full(SHAPE, 9.0, np.float32)
            image[-1, -1] = value
            with pytest.raises(ShapeError):
                net.step(image, 1.0)
        image[-1, -1] = -0.0
        net.step(image, 1.0)

    @pytest.mark.parametrize("time_s", [0.5, 0.4, float("nan"), float("inf"), None])
    def test_times_that_do_not_increase(self, net: Network, time_s: float | None):
        net.step(np.zeros(SHAPE, np.uint8), 0.5)
        with pytest.raises(TimeError):
            net.step(np.zeros(SHAPE, np.uint8), time_s)

    def test_blocks_are_checked_before_anything_is_taken_in(self, net: Network):
        images = MOVIES["growing"](SHAPE, 30)
        expected = net.run(images, TIMES_S)
        net.reset()
        for times_s in (TIMES_S[::-1], np.zeros(30), np.full(30, np.nan)):
            with pytest.raises(TimeError, match="frame"):
                net.run(images, times_s)
        with pytest.raises(ShapeError, match="times_s"):
            net.run(images, TIMES_S[:-1])
        with pytest.raises(ShapeError, match="turning"):
            net.run(images, TIMES_S, turning=[True])
        with pytest.raises(ShapeError):
            net.run(images[0], TIMES_S)
        with pytest.raises(ShapeError, match=r"0\.\.1"):
            net.run(images / 255, TIMES_S)
        with pytest.raises(ParameterError, match="threads"):
            net.run(images, TIMES_S, threads=0)
        assert net.run(images, TIMES_S).tobytes() == expected.tobytes()
        with pytest.raises(TimeError, match="frame 0"):
            net.run(images, TIMES_S)
        with pytest.raises(ShapeError, match="reset"):
            net.run(np.zeros((2, 24, 32), np.uint8), [9.0, 9.1])

    def test_unknown_taps_and_engines(self, net: Network):
        for taps in (("motion", "soul"), "motion"):
            with pytest.raises(ParameterError, match="tap"):
                net.step(np.zeros(SHAPE, np.uint8), 0.0, taps=taps)
        with pytest.raises(ParameterError, match="auto, core, reference"):
            Network(engine="gpu")


class TestState:
    @pytest.mark.parametrize("other", ENGINES)
    @pytest.mark.parametrize("name", ["paper", "published"])
    def test_a_saved_state_continues_in_either_engine(self, net: Network, other: str, name: str, tmp_path):
        net = Network(preset(name), engine=net.engine)
        images = np.concatenate([MOVIES["growing"](SHAPE, 20), MOVIES["lamps"](SHAPE, 10)])
        expected = steps(net, images)
        net.reset()
        steps(net, images[:17], TIMES_S[:17])
        np.savez(tmp_path / "state.npz", **net.state_dict())
        restored = Network(preset(name), engine=other)
        with np.load(tmp_path / "state.npz") as state:
            restored.load_state_dict(state)
        after = steps(restored, images[17:], TIMES_S[17:])
        exact = other == net.engine
        for r, e in zip(after, expected[17:], strict=True):
            assert r[1:5] == (pytest.approx(e[1:5], abs=0 if exact else 1e-6))
            assert r[5:8] == e[5:8]

    def test_without_adaptation_too(self, net: Network):
        params = with_settings(preset("paper"), {"lamina": {"fdsr": {"enabled": False}}}, "test")
        images = MOVIES["growing"](SHAPE, 20)
        for other in ENGINES:
            one, two = Network(params, engine=net.engine), Network(params, engine=other)
            steps(one, images[:12], TIMES_S[:12])
            two.load_state_dict(one.state_dict())
            rest = images[12:], TIMES_S[12:20]
            for a, b in zip(steps(one, *rest), steps(two, *rest), strict=True):
                assert a[1:5] == pytest.approx(b[1:5], abs=1e-6)

    def test_frames_and_times_go_on(self, net: Network):
        images = MOVIES["growing"](SHAPE, 30)
        net.run(images[:20], TIMES_S[:20])
        restored = Network(preset("published"), engine=net.engine)
        restored.load_state_dict(net.state_dict())
        with pytest.raises(TimeError):
            restored.step(images[20], TIMES_S[19])
        assert restored.run(images[20:], TIMES_S[20:])["frame"].tolist() == list(range(20, 30))

    def test_a_state_is_a_copy(self, net: Network):
        images = MOVIES["growing"](SHAPE, 20)
        steps(net, images[:10], TIMES_S[:10])
        state = net.state_dict()
        kept = {name: np.copy(value) for name, value in state.items()}
        steps(net, images[10:], TIMES_S[10:20])
        assert all(np.array_equal(state[name], kept[name], equal_nan=True) for name in kept)

    def test_states_that_do_not_fit(self, net: Network):
        with pytest.raises(ParameterError, match="0 streams"):
            net.state_dict()
        net.step(np.zeros(SHAPE, np.uint8), 0.0)
        state = net.state_dict()
        with pytest.raises(ParameterError, match="luma"):
            net.load_state_dict({})
        with pytest.raises(ParameterError, match="window"):
            net.load_state_dict({name: value for name, value in state.items() if name != "window"})
        with pytest.raises(ShapeError, match="on has shape"):
            net.load_state_dict({**state, "on": np.zeros((3, 3), np.float32)})

    def test_reset_forgets_everything(self, net: Network):
        images = MOVIES["growing"](SHAPE, 12)
        first = steps(net, images, TIMES_S[:12])
        net.reset()
        net.step(np.zeros((24, 32), np.uint8), 7.0)
        net.reset()
        assert steps(net, images, TIMES_S[:12]) == first

    def test_networks_do_not_disturb_each_other(self, net: Network):
        other = Network(preset("paper"), engine=net.engine)
        images = MOVIES["growing"](SHAPE, 30)
        alone = steps(net, images)
        net.reset()
        mixed = []
        for t, image in enumerate(images):
            mixed.append(net.step(image, t / 30))
            other.step(images[-1 - t], t / 30)
        assert mixed == alone


class TestEngines:
    def test_auto_takes_the_core_where_it_is(self):
        assert Network().engine == ("core" if library.available() else "reference")

    def test_without_a_core_auto_says_so_once(self, monkeypatch: pytest.MonkeyPatch):
        monkeypatch.setattr(network_module, "available", lambda: False)
        monkeypatch.setattr(network_module, "why_not", lambda: "it was not built")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("default")
            assert [Network().engine for _ in range(3)] == ["reference"] * 3
        assert len(caught) == 1
        assert "it was not built" in str(caught[0].message)

    def test_kernels_grow_with_the_picture(self):
        images = MOVIES["sliding"]((48, 200), 8)
        fixed, grown = (Network(preset("published"), scale_kernels=scale) for scale in (False, True))
        a, b = fixed.run(images, TIMES_S[:8]), grown.run(images, TIMES_S[:8])
        assert not np.allclose(a["lptc_r"], b["lptc_r"])
        narrow = MOVIES["sliding"](SHAPE, 8)
        fixed.reset()
        grown.reset()
        assert fixed.run(narrow, TIMES_S[:8]).tobytes() == grown.run(narrow, TIMES_S[:8]).tobytes()
