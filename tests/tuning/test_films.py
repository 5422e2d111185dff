"""Films are scored as `lobula evaluate` scores clips."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import lobula
from lobula import stimuli
from lobula.errors import OutputError, ParameterError
from lobula.evaluate.clips import score_clips
from lobula.evaluate.labels import Label
from lobula.model.presets import preset
from lobula.report.grey_clip import write_grey_clip
from lobula.tuning.battery_task import battery_label
from lobula.tuning.films import digest_of, save_film, score_films

CONTACT = Label(file="approach.mkv", contact_frame=40, uncertainty_frames=0, kind="crash")


@pytest.fixture(scope="module")
def movie():
    return stimuli.looming(scene="arena", speed_cm_s=12.0, start_cm=18.0)


@pytest.fixture
def film(movie, tmp_path):
    return save_film(tmp_path / "film.raw", CONTACT, movie.frames())


def test_frames_that_do_not_count_are_not_kept(film, movie):
    assert film.shape == (46, 72, 99)  # contact in frame 40, and five more
    assert np.array_equal(film.images, movie.images[:46])
    assert np.array_equal(film.times_s, movie.times_s[:46])
    assert film.length_s == pytest.approx(1.5)


def test_a_clip_gets_the_score_that_evaluate_gives_it(movie, tmp_path):
    clip = tmp_path / "approach.mp4"
    write_grey_clip(clip, movie.images, movie.times_s, movie.rate_hz)
    contact = round(movie.contact_s * 30)
    labels = [
        Label(file="approach.mp4", contact_frame=contact, uncertainty_frames=1, kind="crash"),
        Label(file="approach.mp4", contact_frame=None, uncertainty_frames=0, kind="none"),
    ]
    films = []
    for number, label in enumerate(labels):
        with lobula.open(clip, size=(99, 72), fit="crop") as frames:
            films.append(save_film(tmp_path / f"{number}.raw", label, frames))
    params = preset("paper")
    wanted = list(score_clips(labels, tmp_path, lambda: lobula.Network(params), size=(99, 72), fit="crop"))
    assert score_films(params, films) == wanted
    assert wanted[0].hit
    assert wanted[1].false_alarms == 1


def test_a_quiet_film_has_the_footage_and_no_alarm(film):
    quiet = film.quiet
    assert (quiet.alarms, quiet.hit, quiet.false_alarms) == ((), False, 0)
    assert quiet.window_s == pytest.approx(38 / 30)  # from the first frame to two before contact


def test_the_digest_changes_with_all_that_matters(film, movie, tmp_path):
    pictures = list(movie.frames())
    other = dataclasses.replace(pictures[3], image=pictures[3].image + np.uint8(1))
    later = dataclasses.replace(pictures[45], time_s=pictures[45].time_s + 0.001)
    changed = [
        save_film(tmp_path / "a", CONTACT, [*pictures[:3], other, *pictures[4:]]),
        save_film(tmp_path / "b", CONTACT, [*pictures[:45], later]),
        save_film(tmp_path / "c", dataclasses.replace(CONTACT, contact_frame=41), pictures),
    ]
    assert len({film.digest, *(one.digest for one in changed)}) == 4
    assert save_film(tmp_path / "d", CONTACT, pictures).digest == film.digest
    assert digest_of([film, changed[0]]) != digest_of([changed[0], film])


def test_contact_of_a_movie_is_in_the_frame_before_it():
    case = next(stimuli.battery())
    assert battery_label(case, 1.0).contact_frame == 30
    assert battery_label(case, 1.03).contact_frame == 30
    assert battery_label(case, None).contact_frame is None


def test_a_film_without_pictures(tmp_path):
    with pytest.raises(ParameterError, match=r"approach\.mkv: no frame that counts"):
        save_film(tmp_path / "x", CONTACT, [])


def test_a_full_disk(movie, tmp_path):
    (tmp_path / "full").symlink_to("/dev/full")
    with pytest.raises(OutputError, match="the disk is full"):
        save_film(tmp_path / "full", CONTACT, movie.frames())
