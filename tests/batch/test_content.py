"""The same content is the same clip; what was not touched is not read again."""

from __future__ import annotations

import hashlib
import os
import time

import numpy as np
import pytest

from lobula.batch import content as module
from lobula.batch.content import Contents
from lobula.errors import FrameSourceError
from lobula.report.png import write_png

LONG_AGO_S = time.time() - 1000


@pytest.fixture
def contents(tmp_path):
    return Contents(tmp_path / "contents.ndjson")


@pytest.fixture
def reads(monkeypatch):
    """The files that were read."""
    files = []

    def counted(file):
        files.append(file.name)
        return hashlib.sha256(file.read_bytes()).hexdigest()

    monkeypatch.setattr(module, "sha256", counted)
    monkeypatch.setattr(module, "_SETTLED_S", -1e9)  # as if all files had been written long ago
    return files


def test_a_file_is_its_sha_256(contents, tmp_path):
    (tmp_path / "a.mp4").write_bytes(b"abc")
    # the first test vector of FIPS 180-2
    assert contents.of(tmp_path / "a.mp4") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"


def test_a_folder_is_its_images_and_their_names(contents, tmp_path):
    def walk(name, *greys, first=1):
        (tmp_path / name).mkdir()
        for i, grey in enumerate(greys, first):
            write_png(tmp_path / name / f"{i}.png", np.full((72, 99), grey, np.uint8))
        return contents.of(tmp_path / name)

    one = walk("one", 10, 20)
    assert walk("same", 10, 20) == one
    assert (
        len(
            {
                one,
                walk("other", 10, 30),
                walk("turned", 20, 10),
                walk("later", 10, 20, first=2),
                walk("long", 10, 20, 30),
            }
        )
        == 5
    )
    (tmp_path / "same" / "times.csv").write_text("file,time_s\n1.png,0\n2.png,1\n")
    timed = contents.of(tmp_path / "same")
    (tmp_path / "same" / "times.csv").write_text("file,time_s\n1.png,0\n2.png,2\n")
    assert len({one, timed, contents.of(tmp_path / "same")}) == 3


def test_what_was_not_touched_is_not_read_again_by_anyone(reads, contents, tmp_path):
    (tmp_path / "a.mp4").write_bytes(b"abc")
    first = contents.of(tmp_path / "a.mp4")
    assert contents.of(tmp_path / "a.mp4") == first
    assert Contents(tmp_path / "contents.ndjson").of(tmp_path / "a.mp4") == first
    assert reads == ["a.mp4"]


def test_what_was_changed_is_read_again_even_where_size_and_time_were_put_back(reads, contents, tmp_path):
    path = tmp_path / "a.mp4"
    path.write_bytes(b"abc")
    os.utime(path, (LONG_AGO_S, LONG_AGO_S))
    first = contents.of(path)
    time.sleep(0.02)  # the clock of a file system ticks some hundred times a second
    path.write_bytes(b"abd")
    os.utime(path, (LONG_AGO_S, LONG_AGO_S))
    assert contents.of(path) != first
    assert reads == ["a.mp4", "a.mp4"]


def test_what_was_written_a_moment_ago_is_not_relied_on(monkeypatch, reads, contents, tmp_path):
    monkeypatch.setattr(module, "_SETTLED_S", 2.0)
    (tmp_path / "a.mp4").write_bytes(b"abc")
    contents.of(tmp_path / "a.mp4")
    contents.of(tmp_path / "a.mp4")
    assert reads == ["a.mp4", "a.mp4"]


def test_a_renamed_file_has_the_content_it_had(contents, tmp_path):
    (tmp_path / "a.mp4").write_bytes(b"abc")
    before = contents.of(tmp_path / "a.mp4")
    (tmp_path / "a.mp4").rename(tmp_path / "b.mp4")
    assert contents.of(tmp_path / "b.mp4") == before


def test_a_damaged_record_is_passed_over(contents, tmp_path):
    (tmp_path / "contents.ndjson").write_text('{"stamp":1,"content":"x"}\n[1]\nnothing\n{"content":"x"}\n')
    (tmp_path / "a.mp4").write_bytes(b"")
    assert contents.of(tmp_path / "a.mp4").startswith("e3b0c442")  # SHA-256 of nothing


def test_what_cannot_be_read(contents, tmp_path):
    def problem(path):
        with pytest.raises(FrameSourceError) as caught:
            contents.of(path)
        return str(caught.value).removeprefix(f"{path}: ")

    os.mkfifo(tmp_path / "pipe.mp4")
    (tmp_path / "empty").mkdir()
    (tmp_path / "link.mp4").symlink_to("link.mp4")
    assert problem(tmp_path / "gone.mp4") == "no such file or folder"
    assert problem(tmp_path / "pipe.mp4").startswith("is neither a file nor a folder")
    assert problem(tmp_path / "empty").startswith("no images in it")
    assert "symbolic links" in problem(tmp_path / "link.mp4")


def test_no_permission(contents, tmp_path):
    path = tmp_path / "a.mp4"
    path.write_bytes(b"abc")
    path.chmod(0)
    root = os.geteuid() == 0
    if root:
        os.seteuid(65534)  # root may read everything
    try:
        with pytest.raises(FrameSourceError, match=r": no permission to read it$"):
            contents.of(path)
    finally:
        if root:
            os.seteuid(0)
