"""``lobula run`` on a ROS bag: the decision is that of the clip, and its files are never overwritten."""

from __future__ import annotations

import numpy as np
import pytest

import lobula

pytest.importorskip("rosbags", reason="needs rosbags (22 MB with what it needs), the extra rosbags")
from ..frames.test_bag import STEP_NS, T0_NS, StoragePlugin, image, write


@pytest.fixture
def bag(tmp_path):
    """An approach at 25 Hz in the folder ``bag``."""
    movie = lobula.stimuli.looming(scene="arena", rate_hz=25)
    pictures = np.clip(np.rint(movie.images), 0, 255).astype(np.uint8)
    messages = [image(picture, T0_NS + i * STEP_NS) for i, picture in enumerate(pictures)]
    write(tmp_path / "bag", {"/camera/image_raw": messages}, storage=StoragePlugin.MCAP)
    return movie


def test_the_decision_is_that_of_the_pictures(call, bag):
    done = call("run", "bag", "--topic", "/camera/image_raw", "--json")
    assert done.code == 0
    seen = [r["time_s"] for r in done.records if (r["type"], r.get("phase")) == ("collision", "start")]
    readings = lobula.Network().run(bag.images, bag.times_s)
    assert seen == pytest.approx([readings["time_s"][np.argmax(readings["collision"])]], abs=1e-6)


@pytest.mark.parametrize("output", ["mcap:bag/bag.mcap", "ndjson:bag/bag.mcap"])
def test_an_output_that_is_read_is_refused(call, bag, tmp_path, output):
    before = (tmp_path / "bag" / "bag.mcap").read_bytes()
    done = call("run", "bag", "--hook", output)
    assert (done.code, "would overwrite bag/bag.mcap, which is the source itself" in done.err) == (2, True)
    assert (tmp_path / "bag" / "bag.mcap").read_bytes() == before


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["bag", "--topic", "/camera"], "bag: topic '/camera' (--topic): must be one of /camera/image_raw"),
        (["bag", "--rate", "30"], "rate_hz: bag is a bag: may be given only for a file"),
    ],
)
def test_requests_that_cannot_be(call, bag, arguments, says):
    done = call("run", *arguments)
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert says in done.err


def test_a_topic_of_a_clip(call, clip):
    done = call("run", clip, "--topic", "/image")
    assert done.code == 2
    assert "topic: " in done.err
    assert "is a file: may be given only for a bag" in done.err
