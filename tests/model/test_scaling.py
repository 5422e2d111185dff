"""Kernels of wider pictures."""

import pytest

from lobula.errors import ParameterError
from lobula.model.presets import preset
from lobula.model.scaling import scaled
from lobula.params import to_dict, with_settings

P = preset("published")
NINE = with_settings(P, {"coarse": {"patch_px": 9}}, "test")


@pytest.mark.parametrize("width", [32, 64, 99, 148])  # 148 / 99 = 1.495
def test_narrow_pictures_keep_their_kernels(width):
    assert scaled(P, width) is P


@pytest.mark.parametrize(("width", "s"), [(149, 2), (198, 2), (320, 3), (640, 6), (1280, 13)])  # 1280 / 99 = 12.93
def test_golden_kernels_grow_with_the_width(width, s):
    p = scaled(P, width)
    assert (p.lamina.dog.radius_px, p.lamina.dog.sigma_px) == (2 * s, 2.0 * s)
    assert p.lptc.emd.spans_px == (s, 2 * s, 3 * s, 4 * s)
    assert p.lgmd1.neighbour_px == p.lgmd2.neighbour_px == s
    assert scaled(NINE, width).coarse.patch_px == 9 * s


def test_nothing_else_changes():
    p, base = to_dict(scaled(P, 320)), to_dict(P)
    for settings in (p, base):
        for name in ("radius_px", "sigma_px"):
            del settings["lamina"]["dog"][name]
        del settings["coarse"]["patch_px"]
        del settings["lptc"]["emd"]["spans_px"], settings["lgmd1"]["neighbour_px"], settings["lgmd2"]["neighbour_px"]
    assert p == base


def test_origins_are_kept():
    assert scaled(P, 320).lgmd2.source_of("change_ms") == P.lgmd2.source_of("change_ms")


def test_kernels_beyond_their_range_are_refused():  # 17 * 2 = 34 > 32
    with pytest.raises(ParameterError, match=r"DogParams\.radius_px = 34: must be int in \[1, 32\] px"):
        scaled(P, 17 * 99)
