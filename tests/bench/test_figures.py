import json

import pytest
from figures.figure import Figure

import lobula.bench.figures as bench
from lobula.bench.network import frame_by_frame, in_blocks, network, streams_in_blocks
from lobula.bench.scenes import scenes


@pytest.fixture(scope="module")
def found():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bench, "SIZES", ((99, 72),))
        patch.setattr(bench, "FRAMES", {(99, 72): 6})
        patch.setattr(bench, "STREAMS", 3)
        patch.setattr(bench, "CLIP_FRAMES", 6)
        yield bench.measure(rounds=1)


def test_measure_says_what_it_measured_and_where(found):
    assert json.loads(json.dumps(found)) == found
    assert found["machine"]["processor"]
    assert found["machine"]["cores"] >= 1
    assert found["step_us"]["99x72"]["best"] > 0
    assert found["reference_step_us"]["99x72"]["median"] > 0
    assert found["streams"]["streams"] == 3
    if found["engine"] == "core":
        assert found["machine"]["isa"] in found["machine"]["isas"]
        assert found["block_us"].keys() == {"99x72"}


def test_video_is_measured_where_there_is_an_encoder(found):
    av = pytest.importorskip("av", reason="PyAV is not installed")
    if "libx264" not in av.codecs_available:
        pytest.skip("this PyAV has no H.264 encoder")
    assert set(found["video"]) == {"clip", "decode_us", "to_decision_us"}


def test_passes_count_their_frames():
    movies = list(scenes(40, 30, 6).values())
    assert frame_by_frame(lambda: network("reference").step, movies)() == 3 * 6
    assert frame_by_frame(lambda: network("reference").step, movies, 4)() == 3 * 4
    assert in_blocks(lambda: network("reference"), movies)() == 3 * 6
    work = streams_in_blocks(lambda: network("reference"), movies, streams=4, threads=2)
    assert work() == work() == 4 * 6


@pytest.mark.parametrize(
    ("better", "value", "reached"),
    [("more", 30.0, True), ("more", 29.9, False), ("less", 30.0, True), ("less", 30.1, False)],
)
def test_a_figure_is_reached_at_its_limit(better, value, reached):
    figure = Figure("x", value, "x", must=30, aim=None, better=better)
    assert figure.reaches(figure.must) is reached
    assert figure.reaches(figure.aim) is None
    assert figure.as_dict()["must_reached"] is reached
