"""``lobula track`` called as a user calls it, on rendered recordings."""

from __future__ import annotations

import csv
import math
import signal
import sys

import numpy as np
import pytest

from lobula.overhead import Room, TopCameraParams, TopView
from lobula.overhead.detection import MarkerFinder
from lobula.report.grey_clip import write_grey_clip

pytest.importorskip("cv2")

ROOM = Room(36.0, 28.0)
CAMERA = TopCameraParams(px_per_cm=10.0, margin_cm=6.0, height_cm=100.0)
IDS = [2, 5]
FRAMES = 33
"""At 15 Hz."""


@pytest.fixture(scope="module")
def truth():
    """2.2 s: robot 2 drives 8 cm along x, stops 7 cm from the wall and turns by 120 degrees; robot 5 stands."""
    frame = np.arange(FRAMES)
    poses = np.tile(np.array([[21.0, 14.0, 0.0], [8.0, 20.0, 1.0]]), (FRAMES, 1, 1))
    poses[:, 0, 0] += 8 / 15 * np.minimum(frame, 15)
    poses[:, 0, 2] += math.radians(120) / 12 * np.clip(frame - 18, 0, 12)
    return poses


@pytest.fixture(scope="module")
def view():
    return TopView(ROOM, camera=CAMERA, samples=2)


@pytest.fixture(scope="module")
def clip(tmp_path_factory, truth, view):
    path = tmp_path_factory.mktemp("tracks") / "above.mp4"
    write_grey_clip(path, (view.picture(poses, IDS) for poses in truth), np.arange(FRAMES) / 15, 15.0)
    return path


@pytest.fixture(scope="module")
def corners(view):
    px = view.camera.to_px(np.column_stack([ROOM.corners_cm, np.zeros(4)]))
    return ",".join(f"{value:.2f}" for value in px.ravel())


def rows_of(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def test_tracks_score_events_and_a_picture(call, clip, corners, truth, tmp_path):
    done = call("track", clip, "--room", "36x28", "--corners", corners, "--camera-height", 100, "--out", "t.csv",
                "--picture", "p.png", "--events", "e.csv", "--json")  # fmt: skip
    assert done.code == 0
    assert done.err == ""
    rows = rows_of(tmp_path / "t.csv")
    assert len(rows) == 2 * FRAMES
    for row in rows[::5]:
        x, y, heading = truth[int(row["frame"]), IDS.index(int(row["id"]))]
        assert math.hypot(float(row["x_cm"]) - x, float(row["y_cm"]) - y) < 0.05
        assert abs(float(row["heading_rad"]) - heading) < math.radians(0.5)
        assert float(row["time_s"]) == pytest.approx(int(row["frame"]) / 15, abs=1e-3)
    document = done.document
    assert (document["tracks"], document["frames"], document["status"]) == ("t.csv", FRAMES, "ok")
    assert [robot["id"] for robot in document["robots"]] == IDS
    assert document["found_share"] == 1.0
    assert document["error_mm"] < 0.2
    assert {k: document["score"][k] for k in ("CR", "CP", "AA", "AT", "AP", "spurious", "SR1")} == {
        "CR": 0, "CP": 0, "AA": 0, "AT": 0, "AP": 1, "spurious": 0, "SR1": 1.0,
    }  # fmt: skip
    (event,) = rows_of(tmp_path / "e.csv")
    assert (event["kind"], event["robot"], event["other"], event["tick"]) == ("AP", "2", "wall", "15")
    assert float(event["distance_cm"]) == pytest.approx(7 - 1.33, abs=0.05)
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")


def test_people_get_a_table(call, clip, corners):
    done = call("track", clip, "--room", "36x28", "--corners", corners, "--score", "--end", 0.39, "--ids", "2,5,9")
    lines = done.out.splitlines()
    assert lines[0].split() == ["robot", "found", "bridged", "distance_cm", "error_mm", "error_deg"]
    assert lines[1].split()[:3] == ["2", "100.0%", "0.0%"]
    assert "2 robots in 6 frames at 15 Hz, room 36x28 cm: 100.0% found" in done.out
    assert "SR1 = AP/(AP+CP): nothing to count" in done.out
    assert "3 cm above the reference: without the height of the camera" in done.err
    assert "ids never seen: 9" in done.err


def test_a_world_gives_room_and_robots(call, clip, corners, tmp_path):
    (tmp_path / "w.toml").write_text("[room]\nwidth_cm = 36\ndepth_cm = 28\n[[obstacles]]\nx_cm = 33\ny_cm = 14\n")
    done = call("track", clip, "--world", "w.toml", "--corners", corners, "--camera-height", 100, "--events", "e.csv")
    assert done.code == 0
    (event,) = rows_of(tmp_path / "e.csv")
    assert (event["kind"], event["other"]) == ("CP", "obstacle 0")  # 29 + 2 + 2.5 is beyond 33


@pytest.mark.parametrize("name", ["ids.pdf", "ids.png"])
def test_patterns_to_print(call, name, tmp_path):
    done = call("track", "--print", name, "--ids", "0-3,46", "--disc", 5, "--json")
    assert done.document == {"sheet": name, "ids": [0, 1, 2, 3, 46], "disc_cm": 5.0, "square_cm": 3.0}
    assert (tmp_path / name).read_bytes()[:4] in (b"%PDF", b"\x89PNG")
    assert "11 ID patterns, discs of 4 cm" in call("track", "--print", name).err


def test_without_opencv_the_extra_is_named(call, clip, corners, monkeypatch):
    monkeypatch.setitem(sys.modules, "cv2", None)
    done = call("track", clip, "--room", "36x28", "--corners", corners)
    assert done.code == 2
    assert 'pip install "lobula[opencv]"' in done.err
    assert call("track", "--print", "ids.pdf").code == 2


GOOD = ["--room", "36x28", "--px-per-cm", "10"]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ([], "no VIDEO"),
        (["CLIP"], "neither --room nor --world given"),
        (["CLIP", "--room", "36"], "room '36': must be WIDTHxDEPTH"),
        (["CLIP", "--room", "36x28"], "nothing ties the picture to the room: must be one of --corners, --corner-ids"),
        (["CLIP", *GOOD, "--corner-ids", "1,2,3,4"], "--corner-ids and --px-per-cm ties"),
        (["CLIP", "--room", "36x28", "--corners", "1,2,3"], "--corners '1,2,3': must be eight numbers"),
        (["CLIP", "--room", "36x28", "--corners", "60,60,420,60,420,340,60,340"], "run clockwise"),
        (
            ["CLIP", "--room", "36x28", "--corner-ids", "46-49", "--end", "0.1"],
            "corner marker 46: was found in no frame",
        ),
        (["CLIP", "--room", "72x56", "--px-per-cm", "5", "--end", "0.1"], "must be 2.40: check the corners"),
        (["CLIP", *GOOD, "--ids", "a"], "--ids 'a': must be numbers and ranges"),
        (["CLIP", *GOOD, "--max-gap", "-1"], "TrackParams.max_gap_s = -1.0"),
        (["CLIP", *GOOD, "--out", "CLIP"], "would overwrite"),
        (["CLIP", *GOOD, "--points", "p.csv"], "--points and --px-per-cm"),
        (["none.mp4", *GOOD], "none.mp4: no such file"),
        (["0", *GOOD], "must be a recording"),
        (["--print", "ids.svg"], "must be .pdf or .png"),
        (["--print", "none/ids.pdf"], "no such folder"),
        (["--print", "ids.pdf", "--ids", "0-49"], "at most 20 fit a sheet"),
    ],
)
def test_wrong_requests(call, clip, arguments, says):
    done = call("track", *(str(clip) if each == "CLIP" else each for each in arguments))
    assert done.code == 2
    assert done.err.startswith("lobula: ")
    assert done.err.count("\n") == 1
    assert says in done.err


def test_a_video_without_patterns(call, view):
    write_grey_clip("empty.mp4", [view.picture(np.empty((0, 3)))] * 3, [0, 0.1, 0.2], 10.0)
    done = call("track", "empty.mp4", *GOOD)
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert "empty.mp4: no ID pattern in 3 frames" in done.err


@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 143), (signal.SIGINT, 130)])
def test_a_signal_before_there_are_tracks(call, clip, tmp_path, monkeypatch, number, code):
    find = MarkerFinder.find

    def signalled(self, picture, row=0):
        if row == 3:
            signal.raise_signal(number)
        return find(self, picture, row)

    monkeypatch.setattr(MarkerFinder, "find", signalled)
    done = call("track", clip, "--room", "36x28", "--corner-ids", "46-49")
    assert (done.code, done.err) == (code, f"lobula: interrupted ({number.name})\n")
    assert not list(tmp_path.iterdir())


def test_a_torn_video_gives_what_it_holds(call, clip, corners, tmp_path):
    import av

    with av.open(str(clip)) as source, av.open("fast.mp4", "w", options={"movflags": "faststart"}) as target:
        stream = target.add_stream_from_template(source.streams.video[0])
        for packet in source.demux(source.streams.video[0]):
            if packet.size:
                packet.stream = stream
                target.mux(packet)
    data = (tmp_path / "fast.mp4").read_bytes()
    (tmp_path / "cut.mp4").write_bytes(data[: len(data) * 8 // 10])
    done = call("track", "cut.mp4", "--room", "36x28", "--corners", corners, "--json")
    assert done.code == 3
    assert "cut.mp4: damaged or cut off after" in done.err
    assert "cut.mp4: damaged or cut off after" in done.document["status"]
    rows = rows_of(tmp_path / "tracks.csv")
    assert len(rows) == 2 * done.document["frames"] < 2 * FRAMES
