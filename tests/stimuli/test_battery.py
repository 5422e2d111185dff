"""The battery: names, facts, and movies that bear them out."""

from typing import get_type_hints

import numpy as np
import pytest

from lobula import stimuli
from lobula.params import to_dict
from lobula.stimuli.moving_object import MovingObject, ObjectSettings

CASES = list(stimuli.battery())


def test_names_are_unique_and_the_set_is_whole():
    names = [case.name for case in CASES]
    assert len(set(names)) == len(names)
    assert {case.expectation.kind for case in CASES} == set(stimuli.CATALOGUE) - {"grating"}
    for kind in ("looming", "receding", "translating_right", "translating_left"):
        facts = [c.expectation for c in CASES if c.expectation.kind == kind]
        assert {(f.dark, f.speed_cm_s) for f in facts} >= {(d, s) for d in (True, False) for s in (4.0, 8.0, 12.0)}
        assert {f.background for f in facts} == {"plain", "stripes", "blobs", "arena"}
        assert {f.noise_sigma for f in facts} == {0.0, 1.5}
        assert len({f.object_cm for f in facts}) == 3
        assert len({f.contrast_grey for f in facts}) == 3


@pytest.mark.parametrize("case", CASES, ids=[case.name for case in CASES])
def test_movie_bears_out_the_facts(case):
    facts, movie = case.expectation, case.movie(rate_hz=15.0, width=40, height=30)
    assert case.name.startswith(facts.kind)
    assert movie.kind == facts.kind
    assert movie.rate_hz == 15.0
    assert movie.images.shape[1:] == (30, 40)
    assert movie.settings["noise_sigma"] == facts.noise_sigma
    assert movie.settings.get("speed_cm_s") == facts.speed_cm_s
    assert movie.settings.get("object_cm") == facts.object_cm
    assert (movie.contact_s is not None) == (facts.kind in ("looming", "angular"))
    light = movie.images.astype(np.float64).mean(axis=(1, 2))
    if facts.kind in ("looming", "flash"):
        assert (light.min() < light[0] - 1) == facts.dark
        assert (light.max() > light[0] + 1) == (not facts.dark)


def test_default_rate_is_thirty():
    assert CASES[0].movie().rate_hz == 30.0


def test_the_typed_keywords_are_the_settings():
    """``ObjectSettings`` is what an editor offers; ``MovingObject`` is what is checked."""
    typed = set(get_type_hints(ObjectSettings)) - {"scene"}
    assert typed == set(to_dict(MovingObject()))
