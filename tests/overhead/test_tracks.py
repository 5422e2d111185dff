from __future__ import annotations

import json

import numpy as np
import pytest

from lobula.errors import FrameSourceError
from lobula.overhead import TRACK_DTYPE, Room, Tracks, read_tracks, tracks_csv

ROOM = Room(30.0, 20.0)


@pytest.fixture
def tracks():
    """Robot 2 drives 1 cm a frame, is bridged in frame 12 and lost after frame 13; robot 7 stands, lost in frame 11."""
    nan = np.nan
    rows = [
        (10, 1.0, 2, 1.0, 5.0, 0.5, True, 0.003, 0.001),
        (10, 1.0, 7, 9.0, 9.0, -3.0, True, 0.004, 0.002),
        (11, 1.1, 2, 2.0, 5.0, 0.5, True, 0.003, 0.001),
        (12, 1.2, 2, 3.0, 5.0, 0.5, False, nan, nan),
        (12, 1.2, 7, 9.0, 9.0, -3.0, True, 0.004, 0.002),
        (13, 1.3, 2, 4.0, 5.0, 0.5, True, 0.003, 0.001),
        (13, 1.3, 7, 9.0, 9.0, -3.0, True, 0.004, 0.002),
    ]
    frames = np.array([10, 11, 12, 13, 14])
    return Tracks(rows=np.array(rows, TRACK_DTYPE), frames=frames, times_s=frames / 10, ids=(2, 7), room=ROOM,
                  source="clip.mp4", left_out={"jump": 3}, notes=("a note",))  # fmt: skip


def test_poses_stand_in_a_row_for_each_frame(tracks):
    poses = tracks.poses()
    assert poses.shape == (5, 2)
    assert poses["x_cm"][:, 0].tolist()[:4] == [1.0, 2.0, 3.0, 4.0]
    lost = [(1, 1), (4, 0), (4, 1)]
    assert np.argwhere(np.isnan(poses["heading_rad"])).tolist() == [list(one) for one in lost]


def test_the_summary_by_hand(tracks):
    summary = tracks.summary()
    assert json.loads(json.dumps(summary, allow_nan=False)) == summary
    assert (summary["frames"], summary["rate_hz"], summary["room"]) == (5, 10.0, "30x20")
    assert summary["found_share"] == pytest.approx(6 / 10)
    first, second = summary["robots"]
    assert (first["id"], first["found_share"], first["bridged_share"], first["distance_cm"]) == (2, 0.6, 0.2, 3.0)
    assert (first["error_mm"], second["error_mm"]) == pytest.approx((0.03, 0.04))
    assert summary["error_mm"] == pytest.approx(10 * np.sqrt((0.003**2 + 0.004**2) / 2), abs=1e-5)
    assert (summary["calibration_error_mm"], summary["status"], summary["left_out"]) == (None, "ok", {"jump": 3})


def test_there_and_back_through_csv(tracks, tmp_path):
    path = tmp_path / "tracks.csv"
    path.write_text("".join(tracks_csv(tracks.rows)))
    lines = path.read_text().splitlines()
    assert lines[0] == "frame,time_s,id,x_cm,y_cm,heading_rad,found,error_cm,error_rad"
    assert lines[1] == "10,1.000000,2,1.0000,5.0000,0.50000,1,0.00300,0.001000"
    assert lines[4] == "12,1.200000,2,3.0000,5.0000,0.50000,0,,"
    read = read_tracks(path, ROOM)
    assert read.frames.tolist() == [10, 11, 12, 13]  # none was seen in frame 14
    assert read.ids == (2, 7)
    for name in TRACK_DTYPE.names:
        assert np.array_equal(read.rows[name], tracks.rows[name], equal_nan=name.startswith("error"))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "has no rows"),
        ("frame,time_s,id,x_cm,y_cm,heading_rad,found\n", "has no rows"),
        ("frame,time_s,id,x_cm,y_cm,found\n1,0,1,2,3,1\n", "every row must hold numbers in frame, time_s"),
        ("frame,time_s,id,x_cm,y_cm,heading_rad,found\n1,0,1,2,abc,0,1\n", "every row must hold numbers"),
        ("frame,time_s,id,x_cm,y_cm,heading_rad,found\n1,0,1,2,nan,0,1\n", "every row must hold numbers"),
        ("frame,time_s,id,x_cm,y_cm,heading_rad,found\n1,0,1\n", "every row must hold numbers"),
    ],
)
def test_files_that_hold_no_tracks(text, says, tmp_path):
    path = tmp_path / "tracks.csv"
    path.write_text(text)
    with pytest.raises(FrameSourceError, match=says):
        read_tracks(path, ROOM)


def test_no_such_file(tmp_path):
    with pytest.raises(FrameSourceError, match="cannot be read: No such file"):
        read_tracks(tmp_path / "none.csv", ROOM)
