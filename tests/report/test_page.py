"""The report page: well-formed, self-contained, and deaf to hostile names."""

import base64
from html.parser import HTMLParser
from io import BytesIO
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest

from lobula.errors import OutputError
from lobula.report.page import ReportPage
from lobula.report.trace_file import read_trace
from lobula.report.video import AnnotatedVideo

from .approach import GREY, HEADER, SUMMARY, events, picture, play, reading, table

VOID = {"meta", "img", "br", "hr", "link", "input"}


class Page(HTMLParser):
    """Reads a page, checks that its tags nest, and keeps tags, text and attributes."""

    def __init__(self, path: Path) -> None:
        super().__init__(convert_charrefs=True)
        self.open_tags: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(path.read_text(encoding="utf-8"))
        self.close()
        assert self.open_tags == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open_tags.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open_tags.pop() == tag

    def handle_data(self, data: str) -> None:
        if not self.open_tags or self.open_tags[-1] not in ("style", "script"):
            self.text += data

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.tags if name == tag]


def test_page_tells_what_happened(tmp_path: Path) -> None:
    play(ReportPage(tmp_path / "out"))
    page = Page(tmp_path / "out" / "index.html")
    for words in (
        "clip.mp4",
        "1collision",
        "30frames",
        "3.0 s",
        "0.31 ms",
        "Collision 1",
        "1.800 s to 2.400 s, 0.600 s long",
        "frame 18, peak at frame 20",
        "Warming up",
        "0.000 s to 0.300 s",
        "99 x 72 px",
        "0123456789ab",
        "lamina.dog.sigma_px",
        "width of the inner field",
        "published code",
        "LGMD-1 0.90",
        "12 spikes",
    ):
        assert words in page.text, words
    assert np.array_equal(read_trace(tmp_path / "out" / "trace.csv"), table())
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"index.html", "trace.csv"}


def test_page_needs_nothing_else(tmp_path: Path) -> None:
    play(ReportPage(tmp_path))
    page = Page(tmp_path / "index.html")
    outside = [
        value
        for _, attributes in page.tags
        for name, value in attributes.items()
        if name in ("src", "href", "srcset", "data", "poster") and not str(value).startswith("data:image/jpeg")
    ]
    assert outside == ["trace.csv"]
    text = (tmp_path / "index.html").read_text()
    assert "url(" not in text
    assert "@import" not in text
    assert "http" not in text
    assert not page.all("script")


def test_curves_pass_where_the_potentials_do(tmp_path: Path) -> None:
    play(ReportPage(tmp_path))
    lgmd1, *_, lptc_l = [
        [tuple(map(float, point.split(","))) for point in str(line["points"]).split()]
        for line in Page(tmp_path / "index.html").all("polyline")
    ]
    # 30 frames of 0.1 s over 1000 units; 3 units of margin, 94 for the range.
    assert lgmd1[20] == pytest.approx((20 / 30 * 1000, 3 + 94 * (1 - 0.9) / 0.5), abs=0.06)
    assert lptc_l[27] == pytest.approx((900, 3 + 94 * 0.6), abs=0.06)


def test_hostile_names_are_only_text(tmp_path: Path) -> None:
    evil = '<script>alert("1")</script><img src=x onerror=alert(1)>&"\'.mp4'
    header = {
        **HEADER,
        "source": evil,
        "preset": evil,
        "settings": [{"path": evil, "value": evil, "unit": evil, "meaning": evil, "source": evil}],
    }
    sink = ReportPage(tmp_path)
    sink.open(header)
    sink.frame(0, reading(0), picture)
    sink.event({"type": "state", "state": evil, "phase": "start", "frame": 0, "time_s": 0.0})
    sink.close({"status": evil, "problems": [evil], "frames": evil})
    page = Page(tmp_path / "index.html")
    assert not page.all("script")
    assert not [a for _, attributes in page.tags for a in attributes if a.startswith("on")]
    assert all(str(a["src"]).startswith("data:") for a in page.all("img"))
    assert page.text.count(evil) >= 9


def test_each_event_has_the_picture_of_its_frame(tmp_path: Path) -> None:
    play(ReportPage(tmp_path))
    pictures = [str(a["src"]).partition(",")[2] for a in Page(tmp_path / "index.html").all("img")]
    assert len(pictures) == 2
    for data in pictures:
        with av.open(BytesIO(base64.b64decode(data))) as container:
            frame = next(container.decode(video=0))
        assert (frame.height, frame.width) == (48, 64)
        assert np.abs(frame.to_ndarray(format="rgb24").astype(int) - GREY).max() < 8


@pytest.mark.parametrize("event_first", [True, False])
def test_event_may_come_before_or_after_its_frame(tmp_path: Path, event_first: bool) -> None:
    sink = ReportPage(tmp_path)
    sink.open(HEADER)
    sink.frame(17, reading(17), lambda: np.zeros((48, 64, 3), np.uint8))
    calls: list[Any] = [lambda: sink.event(events(18)[0]), lambda: sink.frame(18, reading(18), picture)]
    for call in calls if event_first else reversed(calls):
        call()
    sink.close(SUMMARY)
    assert len(Page(tmp_path / "index.html").all("img")) == 1


def test_video_in_the_folder_is_shown(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    video = folder / "my video.mp4"
    page = ReportPage(folder, video)
    play(AnnotatedVideo(video), page)
    written = Page(folder / "index.html")
    assert [a["src"] for a in written.all("video")] == ["my%20video.mp4"]
    assert [a["data-seek"] for a in written.all("button")] == ["0.000000", "1.800000"]


def test_video_elsewhere_or_unfinished_is_left_out(tmp_path: Path) -> None:
    play(AnnotatedVideo(tmp_path / "v.mp4"), ReportPage(tmp_path / "out", tmp_path / "v.mp4"))
    assert not Page(tmp_path / "out" / "index.html").all("video")
    play(ReportPage(tmp_path / "two", tmp_path / "two" / "never.mp4"))
    assert not Page(tmp_path / "two" / "index.html").all("video")


def test_run_that_failed_says_so(tmp_path: Path) -> None:
    sink = ReportPage(tmp_path)
    play(sink, frames=20, finish=False)
    sink.close({"type": "summary", "status": "source_failed", "frames": 20, "problems": ["clip.mp4: torn"]})
    page = Page(tmp_path / "index.html")
    assert "This run was not completed: source failed. clip.mp4: torn" in page.text
    assert "to the end of the run" in page.text
    sink.close({})  # a second call changes nothing


def test_run_without_frames_or_facts(tmp_path: Path) -> None:
    play(ReportPage(tmp_path), frames=0, header={})
    page = Page(tmp_path / "index.html")
    assert "The source gave no frames." in page.text
    assert "No collision" in page.text


def test_folder_that_cannot_be(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match="is not a folder"):
        ReportPage(tmp_path / "file" / "out")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_full_disk(tmp_path: Path) -> None:
    (tmp_path / "trace.csv").symlink_to("/dev/full")
    sink = ReportPage(tmp_path)
    with pytest.raises(OutputError, match="the disk is full"):
        sink.open(HEADER)
    sink.close(SUMMARY)
