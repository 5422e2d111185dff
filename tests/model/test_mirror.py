"""A mirrored movie swaps the LPTCs and leaves the LGMDs as they are."""

import pytest

from lobula.model.presets import preset
from lobula.params import with_settings
from lobula.stimuli import angular, grating, mirrored, translating

from .movies import approach, run

SMALL = {"width": 64, "height": 48}
MOVING = {"lead_s": 0.1, "hold_s": 0.0, "speed_cm_s": 16.0, **SMALL}
MOVIES = {
    "pass": translating(distance_cm=6.0, span_cm=5.0, background="blobs", noise_sigma=1.5, **MOVING),
    "from the left": angular(angle_deg=-40.0, start_cm=10.0, background="stripes", noise_sigma=1.5, **MOVING),
    "off centre": approach(start_cm=10.0, offset_cm=1.0, lead_s=0.1, object_contrast_grey=20.0),
    "grating": grating(period_px=16.0, lead_s=0.1, duration_s=0.4, **SMALL),
}


# Patches of 8 px fill 64 x 48 px, so that the mirror leaves them where they are.
PATCHES = {
    "saturation": {"enabled": True, "limit_grey": 60.0},
    "coarse": {"patch_px": 8},
    "lgmd2": {"coarse_gain": 1.0, "coarse_on_weight": 2.0, "sigmoid_grey": 4.0},
}
SETTINGS = {
    "published": preset("published"),
    "paper": preset("paper"),
    "patches": with_settings(preset("published"), PATCHES, "test"),
}


@pytest.mark.parametrize("name", SETTINGS)
@pytest.mark.parametrize("movie", MOVIES)
def test_mirrored_movie_swaps_the_lptcs(name, movie):
    movie = MOVIES[movie]
    there, back = (run(SETTINGS[name], m.images, m.times_s) for m in (movie, mirrored(movie)))
    for one, other in zip(there, back, strict=True):
        assert one.lptc_r == pytest.approx(-other.lptc_l, abs=1e-6)
        assert one.lptc_l == pytest.approx(-other.lptc_r, abs=1e-6)
        assert one.lgmd1 == pytest.approx(other.lgmd1, abs=1e-6)
        assert one.lgmd2 == pytest.approx(other.lgmd2, abs=1e-6)
    assert max(max(r.lptc_r, -r.lptc_l) for r in there) > 0.05  # they do say something
