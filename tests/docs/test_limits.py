"""docs/limits.md tells the truth about what goes wrong: a limit that has gone must leave the page too."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import lobula
from lobula import stimuli
from lobula.stimuli import Movie

BRIGHT = {"object_grey": 175.0, "background_grey": 45.0}


def alarms(images: NDArray[np.uint8], times_s: NDArray[np.float64]) -> bool:
    return bool(lobula.Network().run(images, times_s)["collision"].any())


def alarms_at(movie: Movie) -> bool:
    return alarms(movie.images, movie.times_s)


def test_a_dark_object_that_comes_is_what_it_is_made_for() -> None:
    assert alarms_at(stimuli.looming())


def test_a_bright_object_that_comes_is_missed() -> None:
    assert not alarms_at(stimuli.looming(**BRIGHT))


def test_a_bright_object_that_goes_away_alarms() -> None:
    assert alarms_at(stimuli.receding(**BRIGHT))


def test_an_object_of_nearly_the_grey_of_its_background_is_missed() -> None:
    assert not alarms_at(stimuli.looming(background_grey=175.0, object_grey=160.0))


def test_a_very_slow_approach_is_missed() -> None:
    assert not alarms_at(stimuli.looming(l_over_v_ms=2000.0))


def test_five_pictures_a_second_are_too_few() -> None:
    assert not alarms_at(stimuli.looming(rate_hz=5.0))


def test_an_approach_at_an_angle_comes_late_or_not_at_all() -> None:
    head_on, aside = stimuli.looming(scene="arena"), stimuli.angular(scene="arena", angle_deg=-45.0)
    assert _lead_s(aside) < _lead_s(head_on)


def test_a_camera_that_tilts_alarms() -> None:
    """A wall of soft blobs moves upwards, 2 px a frame, after 0.7 s of stillness."""
    rng = np.random.default_rng(0)
    wall = rng.standard_normal((320, 99))
    for axis in (0, 1):  # three box means make a soft blob
        for _ in range(3):
            wall = sum(np.roll(wall, shift, axis) for shift in range(-2, 3)) / 5
    wall = np.clip(128 + 40 * wall / wall.std(), 0, 255).astype(np.uint8)
    rows = 2 * np.maximum(0, np.arange(90) - 20)
    images = np.stack([wall[row : row + 72] for row in rows])
    assert alarms(images, np.arange(90) / 30)


def _lead_s(movie: Movie) -> float:
    trace = lobula.Network().run(movie.images, movie.times_s)
    times_s = trace["time_s"][trace["collision"]]
    assert movie.contact_s is not None
    return movie.contact_s - float(times_s[0]) if len(times_s) else 0.0
