"""Pictures from above in, tracks out, against where the robots truly were."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from lobula.errors import FrameSourceError, ParameterError
from lobula.overhead import MarkerParams, Reference, Room, TopCameraParams, TopView, TrackParams, frame_count, track
from lobula.report.mp4 import Mp4Writer
from lobula.runtime.interrupts import Interrupted

from .scenes import ROOM, by_corners, drives, errors

pytest.importorskip("cv2")

AIM_MM, AIM_DEG = 1.0, 1.0
SEVEN = tuple(range(7))


def film(view: TopView, poses: np.ndarray, ids=None) -> np.ndarray:
    return np.stack([view.picture(frame, ids, noise_key=k) for k, frame in enumerate(poses)])


def encoded(path, images: np.ndarray) -> str:
    """The pictures as lossy H.264, 4:2:0, at the quality of lobula's own videos."""
    writer = Mp4Writer(path, images.shape[2], images.shape[1])
    for k, image in enumerate(images):
        writer.write(np.repeat(image[..., None], 3, axis=2), k / 30)
    writer.finish()
    return str(path)


@pytest.fixture(scope="module")
def truth():
    return drives()


@pytest.fixture(scope="module")
def plain():
    """Camera, view and pictures without noise, and their reference."""
    camera = TopCameraParams(px_per_cm=10.0)
    view = TopView(ROOM, camera=camera, samples=3)
    return view, film(view, drives()), by_corners(view, camera)


CAMERAS = {
    "sharp": TopCameraParams(px_per_cm=10.0),
    "noise and blur": TopCameraParams(px_per_cm=10.0, blur_px=1.0, noise_grey=6.0),
    "perspective": TopCameraParams(px_per_cm=11.0, margin_cm=6.0, height_cm=80.0, tilt_deg=15.0, noise_grey=2.0),
    "coarse": TopCameraParams(px_per_cm=7.0, blur_px=0.5, noise_grey=2.0),
}


@pytest.fixture(scope="module", params=CAMERAS.values(), ids=CAMERAS)
def seen(request, truth):
    """A camera, its view and what it films."""
    view = TopView(ROOM, camera=request.param, samples=3)
    return request.param, view, film(view, truth)


@pytest.mark.parametrize("compressed", [False, True], ids=["pictures", "H.264"])
def test_within_a_millimetre_and_a_degree(seen, compressed, truth, tmp_path):
    camera, view, images = seen
    source = encoded(tmp_path / "clip.mp4", images) if compressed else images
    tracks = track(source, ROOM, by_corners(view, camera), **({} if compressed else {"rate_hz": 30.0}))
    assert tracks.ids == SEVEN
    assert tracks.times_s == pytest.approx(np.arange(len(truth)) / 30, abs=1e-3)
    assert tracks.rows["found"].mean() > 0.98
    place_mm, turn_deg = errors(tracks, truth)
    assert np.nanmax(place_mm) < AIM_MM
    assert np.nanmax(turn_deg) < AIM_DEG
    # what it says of its own error is of the right size: the bulk of the errors lies within a few of it
    said = tracks.summary()
    assert np.sqrt(np.nanmean(place_mm**2)) < 3 * said["error_mm"] + 0.01
    assert np.sqrt(np.nanmean(turn_deg**2)) < 3 * said["error_deg"] + 0.05


def test_corner_patterns_are_found_by_themselves(truth):
    camera = TopCameraParams(px_per_cm=11.0, margin_cm=6.0, height_cm=80.0, tilt_deg=12.0)
    view = TopView(ROOM, camera=camera, samples=3, corner_ids=(46, 47, 48, 49))
    tracks = track(film(view, truth[:3]), ROOM, Reference(corner_ids=(46, 47, 48, 49)), rate_hz=30.0)
    assert tracks.ids == SEVEN
    assert max(np.nanmax(part) for part in errors(tracks, truth[:3])) < 0.5
    assert tracks.notes == ()


def test_known_points_undo_the_lens(truth):
    camera = TopCameraParams(px_per_cm=11.0, margin_cm=4.0, height_cm=80.0, lens_k1=-0.1)
    view = TopView(ROOM, camera=camera, samples=3)
    cm = np.stack(np.meshgrid(np.linspace(0, 36, 5), np.linspace(0, 28, 4)), axis=-1).reshape(-1, 2)
    px = view.camera.to_px(np.column_stack([cm, np.zeros(len(cm))]))
    images = film(view, truth[:3])
    tracks = track(images, ROOM, Reference(points=(px, cm), camera_cm=80.0), rate_hz=30.0)
    assert max(np.nanmax(part) for part in errors(tracks, truth[:3])) < 0.5
    assert tracks.calibration_error_cm < 0.01
    bent = track(images, ROOM, by_corners(view, camera), rate_hz=30.0)  # corners alone know nothing of the lens
    assert np.nanmax(errors(bent, truth[:3])[0]) > 2


def test_larger_discs_of_another_height(truth):
    """Robots of 6 cm; a scale is reference enough for a camera far above."""
    marker = MarkerParams(disc_cm=6.0, height_cm=5.0)
    view = TopView(Room(60.0, 50.0), camera=TopCameraParams(px_per_cm=6.0), marker=marker, samples=3)
    poses = np.array([[[20.0, 20.0, 1.0], [40.0, 33.0, -2.0]]])
    tracks = track(film(view, poses), Room(60.0, 50.0), Reference(px_per_cm=6.0), marker=marker, rate_hz=30.0)
    place_mm, turn_deg = errors(tracks, poses)
    assert place_mm.max() < 0.5
    assert turn_deg.max() < 0.5


class TestMisses:
    def test_a_hidden_robot_is_bridged_and_marked(self, plain, truth):
        view, images, reference = plain
        images = images.copy()
        for k in (4, 5, 6):  # a hand over robot 4
            column, row = view.camera.to_px(np.append(truth[k, 4, :2], 3.0)).astype(int)
            images[k, row - 15 : row + 15, column - 15 : column + 15] = 90
        tracks = track(images, ROOM, reference, rate_hz=30.0)
        own = tracks.rows[tracks.rows["id"] == 4]
        assert own["found"].tolist() == [k not in (4, 5, 6) for k in range(12)]
        assert np.nanmax(errors(tracks, truth)[0]) < AIM_MM  # it drove straight on
        summary = next(robot for robot in tracks.summary()["robots"] if robot["id"] == 4)
        assert (summary["found_share"], summary["bridged_share"]) == (0.75, 0.25)
        short = track(images, ROOM, reference, params=TrackParams(max_gap_s=0.1), rate_hz=30.0)
        assert np.count_nonzero(short.rows["id"] == 4) == 9

    def test_only_the_ids_asked_for(self, plain):
        _, images, reference = plain
        tracks = track(images[:2], ROOM, reference, ids=(1, 3, 30), rate_hz=30.0)
        assert tracks.ids == (1, 3)
        assert tracks.left_out == {"id not asked for": 10}
        assert "ids never seen: 30" in tracks.notes

    def test_a_pattern_of_another_size_is_no_robot(self, truth):
        """A sheet with a pattern of 8 cm lies beside the robots."""
        view = TopView(ROOM, camera=TopCameraParams(px_per_cm=10.0), samples=3)
        big = TopView(ROOM, camera=TopCameraParams(px_per_cm=10.0), marker=MarkerParams(disc_cm=8.0), samples=3)
        images = film(view, truth[:2, :3])
        poster = big.picture(np.array([[28.0, 18.0, 0.3]]), [20])
        rows, columns = slice(60, 220), slice(250, 400)
        images[:, rows, columns] = poster[rows, columns]
        tracks = track(images, ROOM, by_corners(view, TopCameraParams()), rate_hz=30.0)
        assert tracks.ids == (0, 1, 2)
        assert tracks.left_out == {"wrong size": 2}

    def test_an_id_that_is_hardly_ever_seen_is_no_robot(self, plain, truth):
        view, images, reference = plain
        once = view.picture(truth[-1], [0, 1, 2, 3, 4, 5, 33])
        tracks = track(np.concatenate([images, once[None]]), ROOM, reference, rate_hz=30.0,
                       params=TrackParams(least_share=0.1))  # fmt: skip
        assert tracks.ids == SEVEN
        assert tracks.left_out == {"rare id": 1}
        assert "ids seen in too few frames to be robots: 33" in tracks.notes


class TestWrong:
    def test_no_pattern_at_all(self, plain):
        view, _, reference = plain
        with pytest.raises(FrameSourceError, match="no ID pattern in 2 frames: must show DICT_4X4_50"):
            track(np.stack([view.picture(np.empty((0, 3)))] * 2), ROOM, reference, rate_hz=30.0)

    def test_none_but_corner_patterns(self):
        view = TopView(ROOM, camera=TopCameraParams(px_per_cm=10.0), samples=2, corner_ids=(46, 47, 48, 49))
        images = view.picture(np.empty((0, 3)))[None]
        with pytest.raises(FrameSourceError, match=r"no robot's ID pattern .*only corner markers"):
            track(images, ROOM, Reference(corner_ids=(46, 47, 48, 49)), rate_hz=30.0)

    @pytest.mark.parametrize(
        ("room", "order", "says"),
        [
            (ROOM, (3, 2, 1, 0), "run clockwise"),
            (ROOM, (1, 2, 3, 0), "do not come out square"),  # 36 x 28 cm turned by a right angle
            (Room(18.0, 14.0), (0, 1, 2, 3), r"come out 1\.20 cm wide: must be 2\.40"),
        ],
    )
    def test_corners_that_do_not_fit(self, plain, room, order, says):
        _, images, reference = plain
        with pytest.raises(ParameterError, match=says):
            track(images[:2], room, Reference(corners_px=reference.corners_px[list(order)]), rate_hz=30.0)

    def test_robots_outside_the_corners(self, plain):
        """Corners 40 cm too far to the right, for a room of the right size."""
        _, images, reference = plain
        with pytest.raises(ParameterError, match="14 of 14 ID patterns lie outside the room"):
            track(images[:2], ROOM, Reference(corners_px=reference.corners_px + np.array([400, 0])), rate_hz=30.0)

    @pytest.mark.parametrize("source", ["-", "0", 0, "/dev/video0"])
    def test_what_is_not_recorded(self, source):
        with pytest.raises(ParameterError, match="must be a recording"):
            track(source, ROOM, Reference(px_per_cm=10.0))
        with pytest.raises(ParameterError, match="must be a recording"):
            frame_count(source)

    def test_what_cannot_be_opened(self, tmp_path):
        with pytest.raises(FrameSourceError, match="no such file"):
            track(tmp_path / "none.mp4", ROOM, Reference(px_per_cm=10.0))
        (tmp_path / "text.mp4").write_text("no video")
        with pytest.raises(FrameSourceError, match="not a video"):
            track(tmp_path / "text.mp4", ROOM, Reference(px_per_cm=10.0))


class TestStopped:
    def test_an_interruption_keeps_what_was_read(self, plain):
        _, images, reference = plain
        seen = []

        def advance():
            seen.append(1)
            if len(seen) == 5:
                raise Interrupted(2)

        tracks = track(images, ROOM, reference, rate_hz=30.0, advance=advance)
        assert isinstance(tracks.stopped, Interrupted)
        assert len(tracks.frames) == 5
        assert len(tracks.rows) == 35
        assert tracks.summary()["status"] == "SIGINT"

    def test_an_interruption_is_no_finding(self, plain):
        _, images, _ = plain

        def advance():
            raise Interrupted(15)

        # no marker 46 in the one frame that was read: nobody knows of the others
        with pytest.raises(Interrupted) as stop:
            track(images, ROOM, Reference(corner_ids=[46, 47, 48, 49]), rate_hz=30.0, advance=advance)
        assert stop.value.exit_code == 143
        with pytest.raises(Interrupted):
            track(images, ROOM, Reference(px_per_cm=5.0), rate_hz=30.0, advance=advance)

    def test_a_torn_video_says_so_before_what_is_missing_in_it(self, plain, tmp_path):
        _, images, _ = plain
        path = Path(encoded(tmp_path / "clip.mp4", images))
        path.write_bytes(path.read_bytes()[: path.stat().st_size * 8 // 10])
        with pytest.raises(
            FrameSourceError, match=r"damaged or cut off after .*; until there: corner marker 46"
        ) as torn:
            track(path, ROOM, Reference(corner_ids=[46, 47, 48, 49]))
        assert torn.value.on_the_way

    def test_a_torn_video_keeps_what_was_read(self, plain, tmp_path):
        _, images, reference = plain
        path = Path(encoded(tmp_path / "clip.mp4", images))  # its index comes first
        path.write_bytes(path.read_bytes()[: path.stat().st_size * 8 // 10])
        tracks = track(path, ROOM, reference)
        assert 2 < len(tracks.frames) < len(images)
        assert isinstance(tracks.stopped, FrameSourceError)
        assert tracks.stopped.on_the_way


def test_the_picture_shows_room_and_robots(plain, truth):
    view, images, reference = plain
    tracks = track(images[:1], ROOM, reference, rate_hz=30.0)
    picture = tracks.draw()
    assert picture.shape == (*images.shape[1:], 3)
    column, row = np.rint(view.camera.to_px(np.array([18.0, 0.0, 0.0]))).astype(int)
    assert picture[row, column].tolist() == [60, 200, 90]  # the wall at the bottom
    x, y, heading = truth[0, 5]
    for radius, angle in ((2.0, 0.0), (2.0, 2.0), (2.7, 0.0)):  # rim, rim, the line ahead
        at = np.array([x + radius * math.cos(heading + angle), y + radius * math.sin(heading + angle), 3.0])
        column, row = np.rint(view.camera.to_px(at)).astype(int)
        assert picture[row, column].tolist() == [240, 80, 60]


def test_frame_count(plain, tmp_path):
    assert frame_count(plain[1], rate_hz=30.0) == 12
    assert frame_count(encoded(tmp_path / "clip.mp4", plain[1])) == 12
