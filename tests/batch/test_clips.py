"""Which files are clips, and what they are called."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from lobula.batch.clips import Clip, find_clips
from lobula.batch.places import MARK
from lobula.errors import ParameterError


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty folder to work in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def lay(*names):
    for name in names:
        path = Path(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()


def names(*sources, out="out"):
    return [clip.name for clip in find_clips(sources, Path(out))]


def test_a_folder_and_all_below_it_in_natural_order(here):
    lay("d/clip10.mp4", "d/clip2.mp4", "d/b/x.MKV", "d/b/deep/y.avi", "d/notes.txt", "d/poster.jpg")
    assert names("d") == ["d/b/deep/y.avi", "d/b/x.MKV", "d/clip2.mp4", "d/clip10.mp4"]


def test_the_path_is_absolute_and_the_name_is_as_the_user_would_write_it(here):
    lay("d/a.mp4")
    assert find_clips(["d"], Path("out")) == [Clip("d/a.mp4", here / "d" / "a.mp4")]


def test_hidden_files_and_folders_are_left_out(here):
    lay("d/a.mp4", "d/.b.mp4", "d/.trash/c.mp4")
    assert names("d") == ["d/a.mp4"]


def test_outputs_are_no_clips(here):
    lay("a.mp4", "out/123/a.mp4", f"other/{MARK}/x", "other/123/a.mp4")
    assert names(".") == ["a.mp4"]


def test_a_folder_of_images_is_one_clip(here):
    lay("d/walk/1.png", "d/walk/2.png", "d/one/1.png", "d/timed/1.png", "d/timed/times.csv")
    assert names("d") == ["d/timed", "d/walk"]


def test_images_beside_videos_or_folders_are_no_clip(here):
    lay("d/a.mp4", "d/a.jpg", "d/b.jpg", "d/x/1.jpg", "d/x/2.jpg", "d/x/y/c.mp4")
    assert names("d") == ["d/a.mp4", "d/x/y/c.mp4"]


def test_a_folder_of_images_named_itself(here):
    lay("walk/1.png", "walk/2.png")
    assert names("walk") == ["walk"]


def test_links_that_go_round_in_a_circle(here):
    lay("d/a.mp4", "e/b.mp4")
    Path("d/again").symlink_to(here / "d")
    Path("d/e").symlink_to(here / "e")
    assert names("d") == ["d/a.mp4", "d/e/b.mp4"]


def test_a_pattern(here):
    lay("d/a.mp4", "d/b.odd", "d/sub/c.mp4")
    assert names("d/*") == ["d/a.mp4", "d/b.odd", "d/sub/c.mp4"]  # whatever its ending: it was asked for
    assert names("d/**/c.*") == ["d/sub/c.mp4"]


def test_a_name_that_looks_like_a_pattern_is_a_file_if_it_is_there(here):
    lay("d/a[1].mp4")
    assert names("d/a[1].mp4") == ["d/a[1].mp4"]


def test_a_list_is_relative_to_its_own_folder(here):
    lay("d/a.mp4", "d/sub/b.mp4", "d/sub/c.mp4")
    Path("d/list.txt").write_text("# what we need\n\n a.mp4 \nsub\n")
    assert names("d/list.txt") == ["d/a.mp4", "d/sub/b.mp4", "d/sub/c.mp4"]


def test_what_a_list_names_and_is_not_there_is_a_clip_that_fails(here):
    lay("a.mp4")
    Path("list.txt").write_text("a.mp4\nb.mp4\n")
    _, missing = find_clips(["list.txt"], Path("out"))
    assert missing == Clip("b.mp4", here / "b.mp4", "no such file or folder; line 2 of list.txt names it")


def test_a_list_with_names_of_any_bytes(here):
    os.close(os.open(b"d\xff.mp4", os.O_CREAT))
    Path("list.txt").write_bytes(b"d\xff.mp4\n")
    (clip,) = find_clips(["list.txt"], Path("out"))
    assert clip.problem == ""
    assert clip.path.exists()


def test_several_sources_each_clip_once(here):
    lay("d/a.mp4", "e/b.mp4")
    assert names("e", "d/a.mp4", "d", "d/../d/a.mp4") == ["e/b.mp4", "d/a.mp4"]


def test_a_link_to_nothing_is_a_clip_that_will_fail(here):
    Path("gone.mp4").symlink_to("nowhere.mp4")
    assert names(".") == ["gone.mp4"]


def test_a_folder_that_cannot_be_searched_is_named(here, monkeypatch):
    lay("d/a.mp4", "d/secret/b.mp4")
    listed = Path.iterdir

    def closed(path):  # in place of its mode, which root may ignore
        if path.name == "secret":
            raise PermissionError(13, "Permission denied")
        return listed(path)

    monkeypatch.setattr(Path, "iterdir", closed)
    clips = find_clips(["d"], Path("out"))
    assert [(clip.name, clip.problem) for clip in clips] == [
        ("d/a.mp4", ""),
        ("d/secret", "cannot be searched: Permission denied"),
    ]


@pytest.mark.parametrize(
    ("sources", "message"),
    [
        (["gone"], "gone: no such file or folder"),
        (["*.mp4"], r"\*.mp4: nothing matches: must name at least one clip"),
        (["d"], "d: no clip in it: must hold .3gp, .*.y4m files"),
        (["gone.txt"], "list gone.txt: no such file"),
        (["d/empty.txt"], "d/empty.txt: no clip in it"),
        (["d/binary.txt"], "list d/binary.txt: is not text: must name one clip a line"),
        (["0"], "0: no such file or folder"),
        (["rtsp://10.0.0.1/"], "rtsp://10.0.0.1/: no such file or folder"),
        ([], "no clips: must be folders, files, patterns or lists of clips"),
        (["out"], "--out out: is the folder of the clips itself: must be another"),
    ],
)
def test_refused(here, sources, message):
    lay("d/empty.txt", "out/a.mp4")
    Path("d/binary.txt").write_bytes(b"\0\1")
    with pytest.raises(ParameterError, match=f"^{message}"):
        find_clips(sources, Path("out"))
