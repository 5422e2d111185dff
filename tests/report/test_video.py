"""The annotated video: every frame, at its time, with the collision impossible to miss."""

from pathlib import Path

import av
import numpy as np
import pytest
from numpy.typing import NDArray

from lobula.errors import OutputError, ParameterError
from lobula.report.canvas import rgb
from lobula.report.palette import DARK
from lobula.report.strip import STRIP_HEIGHT
from lobula.report.video import WIDTH_PX, AnnotatedVideo

from .approach import COLLISION, FRAMES, GREY, HEADER, SUMMARY, play, reading

RED = np.array(rgb(DARK.collision))


def decoded(path: Path) -> tuple[list[float], list[NDArray[np.int_]]]:
    with av.open(str(path)) as container:
        frames = list(container.decode(video=0))
    return [f.time for f in frames], [f.to_ndarray(format="rgb24").astype(int) for f in frames]


def test_every_frame_at_its_time_with_a_red_border_in_a_collision_only(tmp_path: Path) -> None:
    play(AnnotatedVideo(tmp_path / "out.mp4"))
    times_s, pictures = decoded(tmp_path / "out.mp4")
    assert times_s == pytest.approx([i / 10 for i in range(FRAMES)], abs=1e-4)
    assert pictures[0].shape == (480 + STRIP_HEIGHT, WIDTH_PX, 3)  # 64 x 48 scaled to 640 x 480
    for index, picture in enumerate(pictures):
        edges = np.array([picture[470, 3], picture[240, 3], picture[240, 636], picture[3, 600]])
        if index in COLLISION:
            assert np.abs(edges - RED).max() < 40, index
        else:
            assert np.abs(edges - GREY).max() < 12, index
        assert np.abs(picture[240, 320] - GREY).max() < 12  # the picture itself is left alone
    assert list(tmp_path.iterdir()) == [tmp_path / "out.mp4"]


def test_states_are_written_on_the_picture(tmp_path: Path) -> None:
    play(AnnotatedVideo(tmp_path / "out.mp4"))
    _, pictures = decoded(tmp_path / "out.mp4")
    label = pictures[1][8:30, 8:100]  # warming up
    assert np.abs(label - np.array(rgb(DARK.states["warming_up"]))).max(axis=2).min() < 12
    assert np.abs(pictures[10][8:30, 8:100] - GREY).max() < 12  # ok says nothing


@pytest.mark.parametrize(
    ("height", "width", "rows"),
    [(240, 320, 480), (360, 640, 360), (72, 99, 466), (1080, 1920, 360), (1280, 720, 480), (32, 641, 32)],
)
def test_picture_is_scaled_to_fit(tmp_path: Path, height: int, width: int, rows: int) -> None:
    sink = AnnotatedVideo(tmp_path / "out.mp4")
    sink.open(HEADER)
    sink.frame(0, reading(10), lambda: np.full((height, width, 3), 200, np.uint8))
    sink.close(SUMMARY)
    picture = decoded(tmp_path / "out.mp4")[1][0]
    assert picture.shape == (rows + STRIP_HEIGHT, WIDTH_PX, 3)
    assert np.abs(picture[rows // 2, 320] - 200).max() < 12


def test_runs_without_pictures_or_thresholds_or_fps(tmp_path: Path) -> None:
    sink = AnnotatedVideo(tmp_path / "out.mp4")
    sink.open({"source": "-", "fps": None})
    sink.frame(0, reading(0), None)
    sink.close({})
    assert len(decoded(tmp_path / "out.mp4")[1]) == 1


def test_no_frames_no_file(tmp_path: Path) -> None:
    play(AnnotatedVideo(tmp_path / "out.mp4"), frames=0)
    assert list(tmp_path.iterdir()) == []


def test_only_mp4(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"out\.avi: must end in \.mp4"):
        AnnotatedVideo(tmp_path / "out.avi")


def test_missing_folder_is_said_before_the_first_frame(tmp_path: Path) -> None:
    sink = AnnotatedVideo(tmp_path / "none" / "out.mp4")
    with pytest.raises(OutputError, match="no such folder"):
        sink.open(HEADER)
    sink.close(SUMMARY)
