"""The core's eye: every instruction set draws the same, any number of bodies, and a library without it is told."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from lobula.engine import eye as module
from lobula.engine.library import available, isas
from lobula.errors import ParameterError

if not available():
    pytest.skip("the C core was not built", allow_module_level=True)

from lobula.engine.eye import CoreEye, focal_px

OPTIONAL = ("own", "keys", "light", "shown", "obstacles", "walls")


def cylinder(**changed):
    settings = {"radius_cm": 2.0, "height_cm": 3.0, "bands_grey": np.array([45.0]), "around_grey": np.zeros(0)}
    return SimpleNamespace(**{**settings, **changed})


def scene(**changed):
    rng = np.random.default_rng(1)
    settings = {
        "shape": "box", "size_cm": (70.0, 55.0), "wall_cm": 12.0, "wall_grey": rng.uniform(100, 220, 300),
        "floor_grey": 95.0, "above_grey": 200.0, "body": cylinder(), "obstacles": (),
        "obstacle_poses": np.zeros((0, 3)),
    }  # fmt: skip
    return SimpleNamespace(**{**settings, **changed})


def lens(**changed):
    settings = {
        "width_px": 99, "height_px": 72, "fov_deg": 70.0, "ahead_cm": 1.33, "above_floor_cm": 1.6, "noise_grey": 1.5,
        "blur_px": 0.0,
    }  # fmt: skip
    return SimpleNamespace(**{**settings, **changed})


def views(eye, bodies, count=3, shape=(72, 99), **optional):
    cameras = np.column_stack([np.linspace(10, 60, count), np.linspace(10, 40, count), np.arange(count)])
    out = np.full((count, *shape), 7, np.uint8)
    assert eye.views(cameras, np.asarray(bodies, float), {**dict.fromkeys(OPTIONAL), **optional}, out)
    return out


BODIES = np.array([[20.0, 20.0, 0.3], [40.0, 30.0, 1.0], [50.0, 15.0, 2.0]])


def test_focal_length():
    assert focal_px(99, 70.0) == pytest.approx(70.6933, abs=1e-4)  # 49.5 / 0.700208
    assert focal_px(100, 90.0) == pytest.approx(50)


@pytest.mark.parametrize("size", [(99, 72), (32, 24), (33, 25), (64, 40), (101, 79)])
@pytest.mark.parametrize("blur_px", [0.0, 1.2])
def test_every_instruction_set_draws_the_same(monkeypatch, size, blur_px):
    camera = lens(width_px=size[0], height_px=size[1], blur_px=blur_px)
    drawn = []
    for name in isas():
        monkeypatch.setenv("LOBULA_ISA", name)
        keys = np.arange(3, dtype=np.uint64)
        drawn.append(views(CoreEye(scene(), camera), BODIES, shape=size[::-1], keys=keys))
    assert all(np.array_equal(drawn[0], other) for other in drawn[1:])
    assert drawn[0].std() > 10


def test_more_bodies_than_before():
    eye = CoreEye(scene(), lens())
    rng = np.random.default_rng(2)
    crowd = np.column_stack([rng.uniform(0, 70, 200), rng.uniform(0, 55, 200), rng.uniform(0, 6, 200)])
    few = views(eye, BODIES)
    assert np.array_equal(views(CoreEye(scene(), lens()), crowd), views(eye, crowd))
    assert np.array_equal(views(eye, BODIES), few)


def test_what_was_left_out_once_is_there_again():
    eye = CoreEye(scene(), lens())
    all_there = views(eye, BODIES)
    hidden = views(eye, BODIES, shown=np.zeros((3, 3), bool), walls=np.zeros(3, bool), light=np.full(3, 0.5))
    assert not np.array_equal(hidden, all_there)
    assert np.array_equal(views(eye, BODIES), all_there)


def test_a_number_out_of_range_draws_nothing():
    eye = CoreEye(scene(), lens())
    out = np.full((1, 72, 99), 7, np.uint8)
    assert not eye.views(np.array([[np.nan, 0, 0]]), BODIES, dict.fromkeys(OPTIONAL), out)
    assert (out == 7).all()


@pytest.mark.parametrize(
    "made",
    [
        lambda: CoreEye(scene(size_cm=(0.0, 55.0)), lens()),
        lambda: CoreEye(scene(wall_cm=float("nan")), lens()),
        lambda: CoreEye(scene(body=cylinder(bands_grey=np.zeros(0))), lens()),
        lambda: CoreEye(scene(), lens(blur_px=1000.0)),
    ],
)
def test_scenes_and_cameras_that_cannot_be(made):
    with pytest.raises(ParameterError, match="Eye: a scene or camera that the eye does not take"):
        made()


class Stale:
    """A library whose functions all return 0, the ABI's number too."""

    def __getattr__(self, name):
        return type("Function", (), {"__call__": lambda self: 0})()


@pytest.mark.parametrize(("stale", "message"), [(object(), "has no eye"), (Stale(), "has another eye")])
def test_a_library_of_another_version(monkeypatch, stale, message):
    module._eye_library.cache_clear()
    with monkeypatch.context() as patched:
        patched.setattr(module, "library", lambda: stale)
        with pytest.raises(ParameterError, match=f"the C core here {message}: .*install again"):
            CoreEye(scene(), lens())
    CoreEye(scene(), lens())
