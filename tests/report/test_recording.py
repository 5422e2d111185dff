"""The recording: the pictures as they were, at their times, whatever their size."""

from pathlib import Path

import av
import numpy as np
import pytest

from lobula.errors import OutputError, ParameterError
from lobula.report.recording import EvenPictures, Recording

from .approach import FRAMES, HEADER, SUMMARY, play, reading


def decoded(path):
    with av.open(str(path)) as container:
        frames = list(container.decode(video=0))
    return [f.time for f in frames], [f.to_ndarray(format="rgb24").astype(int) for f in frames]


def record(path, pictures):
    sink = Recording(path)
    sink.open(HEADER)
    for index, picture in enumerate(pictures):
        sink.frame(index, reading(0)._replace(time_s=index / 10), lambda p=picture: p)
    sink.close(SUMMARY)
    return decoded(path)


def test_every_frame_at_its_time(tmp_path: Path):
    play(Recording(tmp_path / "r.mp4"))
    times_s, pictures = decoded(tmp_path / "r.mp4")
    assert times_s == pytest.approx([i / 10 for i in range(FRAMES)])
    assert pictures[0].shape == (48, 64, 3)
    assert list(tmp_path.iterdir()) == [tmp_path / "r.mp4"]


def test_colours_are_those_of_the_source(tmp_path):
    colours = [(200, 40, 40), (40, 200, 40), (40, 40, 200), (128, 128, 128)]
    _, pictures = record(tmp_path / "r.mp4", [np.full((48, 64, 3), c, np.uint8) for c in colours])
    for picture, colour in zip(pictures, colours, strict=True):
        assert np.abs(picture[24, 32] - colour).max() <= 6


def test_an_odd_row_and_column_are_cut_off_and_not_scaled():
    picture = np.arange(49 * 65 * 3, dtype=np.uint64).reshape(49, 65, 3).astype(np.uint8)
    np.testing.assert_array_equal(EvenPictures()(picture), picture[:48, :64])


def test_a_source_that_changes_its_size_is_scaled_to_the_first(tmp_path):
    white = [np.full(shape, 250, np.uint8) for shape in ((48, 64, 3), (96, 128, 3), (48, 32, 3))]
    _, pictures = record(tmp_path / "r.mp4", white)
    assert {p.shape for p in pictures} == {(48, 64, 3)}
    assert pictures[1].min() > 235
    assert pictures[2][24, 32].min() > 235  # half as wide: in the middle, black beside it
    assert pictures[2][24, 4].max() < 20


def test_wide_pictures_are_made_smaller_on_request():
    shown = EvenPictures(most=640)(np.full((1080, 1920, 3), 90, np.uint8))
    assert shown.shape == (360, 640, 3)
    assert (shown == 90).all()


def test_no_frames_no_file(tmp_path):
    play(Recording(tmp_path / "r.mp4"), frames=0)
    assert list(tmp_path.iterdir()) == []


def test_only_mp4(tmp_path):
    with pytest.raises(ParameterError, match=r"r\.avi: must end in \.mp4"):
        Recording(tmp_path / "r.avi")


def test_missing_folder_is_said_before_the_first_frame(tmp_path):
    sink = Recording(tmp_path / "none" / "r.mp4")
    with pytest.raises(OutputError, match="no such folder"):
        sink.open(HEADER)
    sink.close(SUMMARY)
