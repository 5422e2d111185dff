"""ROS bags as sources, written with the rosbags library: encodings, stamps, what is refused and what is left out."""

from __future__ import annotations

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError, MissingExtraError, ParameterError
from lobula.frames.inputs import kind_of_source

from .clips import HEIGHT, WIDTH, image_bytes, moving_bar

pytest.importorskip("rosbags", reason="needs rosbags (22 MB with what it needs), the extra rosbags")
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore

SIZE = (WIDTH, HEIGHT)
TYPES = get_typestore(Stores.ROS2_HUMBLE)
TYPES1 = get_typestore(Stores.ROS1_NOETIC)
IMAGE, COMPRESSED, TEXT = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage", "std_msgs/msg/String"
T0_NS = 1_700_000_000_123_456_789
STEP_NS = 40_000_000
PACKED = {"mono8": 1, "8UC1": 1, "rgb8": 3, "bgr8": 3, "8UC3": 3, "rgba8": 4, "bgra8": 4}


def header(stamp_ns, types=TYPES):
    stamp = types.types["builtin_interfaces/msg/Time"](sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    more = {"seq": 0} if types is TYPES1 else {}
    return types.types["std_msgs/msg/Header"](stamp=stamp, frame_id="camera", **more)


def image(picture, stamp_ns, encoding="mono8", padding=0, types=TYPES):
    height, width = picture.shape[:2]
    rows = picture.reshape(height, -1)
    rows = np.pad(rows, ((0, 0), (0, padding)), constant_values=255)
    return types.types[IMAGE](
        header=header(stamp_ns, types), height=height, width=width, encoding=encoding, is_bigendian=0,
        step=rows.shape[1], data=rows.ravel(),
    )  # fmt: skip


def compressed(data, stamp_ns, told="jpeg"):
    return TYPES.types[COMPRESSED](header=header(stamp_ns), format=told, data=np.frombuffer(data, np.uint8))


def write(path, topics, *, storage=StoragePlugin.SQLITE3, late_ns=7_000_000):
    """Write a bag of topic -> messages; it was recorded ``late_ns`` after the stamps, unevenly."""
    with Writer2(path, version=8, storage_plugin=storage) as bag:
        for topic, messages in topics.items():
            kind = messages[0].__msgtype__ if messages else IMAGE
            connection = bag.add_connection(topic, kind, typestore=TYPES)
            for i, message in enumerate(messages):
                bag.write(connection, T0_NS + i * STEP_NS + late_ns * (i % 3), TYPES.serialize_cdr(message, kind))
    return path


def stamps(count):
    return [T0_NS + i * STEP_NS for i in range(count)]


def read(source, **options):
    with lobula.frames.open(source, size=SIZE, **options) as frames:
        return list(frames), frames


@pytest.mark.parametrize("storage", StoragePlugin)
def test_every_picture_with_the_stamp_of_its_header(tmp_path, storage):
    pictures = moving_bar(5)
    messages = [image(p, s, padding=8) for p, s in zip(pictures, stamps(5), strict=True)]
    bag = write(tmp_path / "bag", {"/camera/image_raw": messages}, storage=storage)
    for source in (bag, next(bag.glob("bag.*"))):  # the folder, and its file alone
        got, frames = read(source)
        for frame, picture in zip(got, pictures, strict=True):
            np.testing.assert_array_equal(frame.image, picture)
        np.testing.assert_allclose([f.time_s for f in got], np.arange(5) * 0.04, atol=1e-9)
        assert [f.index for f in got] == list(range(5))
        assert (frames.frame_count, frames.live, frames.damaged, frames.notes) == (5, False, 0, [])
        assert frames.fps == pytest.approx(25, rel=0.1)


@pytest.mark.parametrize("encoding", PACKED)
def test_encodings_of_raw_pictures(tmp_path, encoding):
    grey = moving_bar(1)[0]
    depth = PACKED[encoding]
    picture = grey if depth == 1 else np.repeat(grey[:, :, None], depth, axis=2)
    got, _ = read(write(tmp_path / "bag", {"/image": [image(picture, T0_NS, encoding)]}))
    np.testing.assert_allclose(got[0].image, grey, atol=1)


@pytest.mark.parametrize(("encoding", "red"), [("rgb8", 0), ("bgr8", 2), ("8UC3", 2), ("rgba8", 0), ("bgra8", 2)])
def test_red_is_red(tmp_path, encoding, red):
    picture = np.zeros((HEIGHT, WIDTH, PACKED[encoding]), np.uint8)
    picture[:, :, red] = 255
    with lobula.frames.open(write(tmp_path / "bag", {"/image": [image(picture, T0_NS, encoding)]})) as frames:
        next(frames)
        np.testing.assert_array_equal(frames.picture()[5, 5], [255, 0, 0])


@pytest.mark.parametrize(
    ("codec", "pixel_format", "told", "tolerance"),
    [
        ("mjpeg", "yuvj420p", "jpeg", 8),
        ("mjpeg", "yuvj420p", "bgr8; jpeg compressed bgr8", 8),
        ("png", "gray", "mono8; png compressed", 0),
        ("png", "rgb24", "", 1),
    ],
)
def test_compressed_pictures(tmp_path, codec, pixel_format, told, tolerance):
    pictures = moving_bar(3)
    data = [image_bytes(p, codec, pixel_format) for p in pictures]
    messages = [compressed(d, s, told) for d, s in zip(data, stamps(3), strict=True)]
    got, _ = read(write(tmp_path / "bag", {"/image/compressed": messages}))
    for frame, picture in zip(got, pictures, strict=True):
        np.testing.assert_allclose(frame.image, picture.astype(float), atol=tolerance)


def test_a_bag_of_ros_1(tmp_path):
    pictures = moving_bar(3)
    with Writer1(tmp_path / "a.bag") as bag:
        connection = bag.add_connection("/image", IMAGE, typestore=TYPES1)
        for picture, stamp_ns in zip(pictures, stamps(3), strict=True):
            message = image(picture, stamp_ns, types=TYPES1)
            bag.write(connection, stamp_ns, TYPES1.serialize_ros1(message, IMAGE))
    got, _ = read(tmp_path / "a.bag")
    np.testing.assert_array_equal(got[2].image, pictures[2])
    np.testing.assert_allclose([f.time_s for f in got], [0, 0.04, 0.08], atol=1e-9)


def test_a_bag_without_definitions_as_humble_writes_it(tmp_path):
    import sqlite3

    bag = write(tmp_path / "bag", {"/image": [image(moving_bar(1)[0], T0_NS)]})
    with sqlite3.connect(bag / "bag.db3") as database:
        database.executescript(
            "DELETE FROM message_definitions; DROP TABLE message_definitions; UPDATE schema SET schema_version = 3"
        )
    got, _ = read(bag)
    np.testing.assert_array_equal(got[0].image, moving_bar(1)[0])


def test_one_of_several_topics(tmp_path):
    left, right = moving_bar(2)
    bag = write(tmp_path / "bag", {"/right": [image(right, T0_NS)], "/left": [image(left, T0_NS)]})
    np.testing.assert_array_equal(read(bag, topic="/left")[0][0].image, left)
    np.testing.assert_array_equal(read(bag, topic="/right")[0][0].image, right)
    with pytest.raises(FrameSourceError, match=r"several topics: topic \(--topic\) must be one of /left, /right$"):
        read(bag)
    with pytest.raises(FrameSourceError, match=r"topic '/middle' \(--topic\): must be one of /left, /right$"):
        read(bag, topic="/middle")


def test_part_of_a_bag(tmp_path):
    messages = [image(p, s) for p, s in zip(moving_bar(6), stamps(6), strict=True)]
    got, _ = read(write(tmp_path / "bag", {"/image": messages}), start_s=0.08, end_s=0.2)
    assert [f.index for f in got] == [2, 3, 4]


def test_headers_without_stamps(tmp_path):
    bag = write(tmp_path / "bag", {"/image": [image(p, 0) for p in moving_bar(3)]}, late_ns=0)
    got, frames = read(bag)
    np.testing.assert_allclose([f.time_s for f in got], [0, 0.04, 0.08], atol=1e-9)
    assert frames.notes == [f"{bag}: its pictures have no stamps: the times of recording are taken"]


def test_what_is_damaged_or_out_of_order_is_left_out(tmp_path):
    pictures, times_ns = moving_bar(6), stamps(6)
    messages = [image(p, s) for p, s in zip(pictures, times_ns, strict=True)]
    messages[0].data = messages[0].data[:100]
    messages[2].header = header(times_ns[1])
    messages[4].step = 3
    bag = write(tmp_path / "bag", {"/image": messages})
    got, frames = read(bag)
    assert [f.index for f in got] == [1, 3, 5]
    np.testing.assert_allclose([f.time_s for f in got], [0.04, 0.12, 0.2], atol=1e-9)
    assert frames.damaged == 3
    assert frames.notes == [
        f"{bag}: picture at 0.000 s: 100 bytes are no {WIDTH} x {HEIGHT} picture of {WIDTH} bytes a row: left out; "
        "more such are only counted"
    ]


def test_compressed_pictures_that_are_cut_short(tmp_path):
    data = [image_bytes(p, "mjpeg", "yuvj420p") for p in moving_bar(4)]
    data[1], data[2] = data[1][: len(data[1]) // 2], b"no jpeg"
    messages = [compressed(d, s) for d, s in zip(data, stamps(4), strict=True)]
    got, frames = read(write(tmp_path / "bag", {"/image": messages}))
    assert [f.index for f in got] == [0, 3]
    assert frames.damaged == 2


@pytest.mark.parametrize(
    ("message", "says"),
    [
        (image(np.zeros((8, 8, 2), np.uint8), 1, "16UC1"), r"encoding '16UC1': must be mono8, rgb8, bgr8"),
        (image(np.zeros((8, 8), np.uint8), 1, "bayer_rggb8"), "encoding 'bayer_rggb8': must be mono8"),
        (
            compressed(bytes(12) + b"\x89PNG", 1, "16UC1; compressedDepth png"),
            "compressedDepth png': must be jpeg or png",
        ),
        (compressed(b"RIFF", 1, "webp"), "format 'webp': must be jpeg or png"),
        (compressed(b"", 1, "jpeg"), "none of its 1 pictures can be decoded"),
    ],
)
def test_pictures_that_are_not_read(tmp_path, message, says):
    bag = write(tmp_path / "bag", {"/image": [message]})
    with pytest.raises(FrameSourceError, match=says) as refused:
        read(bag)
    assert "\n" not in str(refused.value)


def test_bags_that_hold_nothing_to_see(tmp_path):
    text = TYPES.types[TEXT](data="hello")
    with pytest.raises(FrameSourceError, match="no pictures in it: must hold a topic of sensor_msgs/msg/Image or"):
        read(write(tmp_path / "a", {"/chatter": [text]}))
    with pytest.raises(FrameSourceError, match="topic /image: holds no message"):
        read(write(tmp_path / "b", {"/image": [], "/chatter": [text]}))


def test_files_that_are_no_bag(tmp_path):
    for name in ("a.bag", "a.db3", "a.mcap"):
        (tmp_path / name).write_bytes(b"nothing of the kind" * 100)
        with pytest.raises(FrameSourceError, match=r"a\.\w+: .*: must be a ROS bag that rosbags reads$"):
            read(tmp_path / name)
    (tmp_path / "bag").mkdir()
    (tmp_path / "bag" / "metadata.yaml").write_text("rosbag2_bagfile_information:\n  version: 5\n")
    with pytest.raises(FrameSourceError, match=r"bag: .*: must be a ROS bag"):
        read(tmp_path / "bag")


def test_a_file_that_is_damaged_in_the_middle(tmp_path):
    messages = [image(p, s) for p, s in zip(moving_bar(600), stamps(600), strict=True)]
    bag = write(tmp_path / "bag", {"/image": messages}, storage=StoragePlugin.MCAP)
    file = bag / "bag.mcap"
    data = file.read_bytes()
    middle = len(data) // 2
    file.write_bytes(data[:middle] + bytes(len(data) // 4) + data[middle + len(data) // 4 :])
    with pytest.raises(FrameSourceError, match="bag: damaged or cut off: ") as failed:
        read(bag)
    assert failed.value.on_the_way


def test_a_folder_of_pictures_with_other_metadata_is_no_bag(tmp_path):
    (tmp_path / "metadata.yaml").write_text("who: me\n")
    assert kind_of_source(tmp_path) == ("folder", str(tmp_path))


def test_a_topic_belongs_to_a_bag(tmp_path):
    with pytest.raises(ParameterError, match=r"topic: .* is a folder: may be given only for a bag"):
        lobula.frames.open(tmp_path, topic="/image")


def test_the_library_is_not_there(tmp_path, monkeypatch):
    import sys

    monkeypatch.delitem(sys.modules, "lobula.frames.bag", raising=False)
    monkeypatch.setitem(sys.modules, "rosbags.highlevel", None)
    (tmp_path / "a.bag").write_bytes(b"")
    with pytest.raises(MissingExtraError, match=r'pip install "lobula\[rosbags\]"'):
        lobula.frames.open(tmp_path / "a.bag")
