"""Files land whole or not at all."""

import os
from pathlib import Path

import pytest

from lobula.errors import OutputError
from lobula.landing import part_of, set_aside, whole_file, writing


def test_part_keeps_the_suffix_or_takes_another() -> None:
    assert part_of(Path("a/clip.mp4")) == Path("a/clip.part.mp4")
    assert part_of(Path("a/t.npz"), ".csv") == Path("a/t.part.csv")


def test_what_an_earlier_run_left_gets_the_next_free_name(tmp_path: Path) -> None:
    part = tmp_path / "clip.part.mp4"
    for number, name in enumerate(("clip.part-2.mp4", "clip.part-3.mp4", "clip.part-4.mp4")):
        part.write_text(f"run {number}")
        assert set_aside(part) == [f"{part} was left by an earlier run: it is {tmp_path / name} now"]
        assert (tmp_path / name).read_text() == f"run {number}"
        assert not part.exists()


def test_nothing_is_set_aside_where_nothing_would_be_lost(tmp_path: Path) -> None:
    part = tmp_path / "t.part.csv"
    assert set_aside(part) == []
    part.touch()
    assert set_aside(part) == []
    assert list(tmp_path.iterdir()) == [part]


def test_what_cannot_be_set_aside_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def denied(self: Path, target: Path) -> None:
        raise PermissionError(13, "")

    part = tmp_path / "t.part.csv"
    part.write_text("rows")
    monkeypatch.setattr(Path, "rename", denied)
    with pytest.raises(OutputError, match=r"^cannot write .*t\.part\.csv: no permission$"):
        set_aside(part)


def test_file_appears_whole(tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    with whole_file(path) as temporary:
        temporary.write_text("new")
        assert not path.exists()
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_failure_leaves_the_old_file_and_no_litter(tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    path.write_text("old")

    def fail() -> None:
        with whole_file(path) as temporary:
            temporary.write_text("half")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (FileNotFoundError(2, ""), "no such folder nowhere"),
        (OSError(28, ""), "the disk is full"),
        (PermissionError(13, ""), "no permission"),
        (IsADirectoryError(21, ""), "it is a folder"),
        (OSError(5, "Input/output error"), "Input/output error"),
    ],
)
def test_errors_become_one_line_that_names_the_file(error: OSError, words: str) -> None:
    with pytest.raises(OutputError) as caught, writing(Path("nowhere/t.csv")):
        raise error
    assert str(caught.value) == f"cannot write nowhere/t.csv: {words}"


def test_a_folder_that_is_there_is_not_said_to_be_missing(tmp_path: Path) -> None:
    with pytest.raises(OutputError) as caught, writing(tmp_path / "t.csv"):
        raise FileNotFoundError(2, "")  # as in /proc, where a folder takes no files
    assert str(caught.value) == f"cannot write {tmp_path / 't.csv'}: no file can be made there"


def test_a_device_or_a_pipe_is_not_replaced(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    said = "pipe: it is no ordinary file, and would be replaced by one"
    with pytest.raises(OutputError, match=said), whole_file(tmp_path / "pipe") as temporary:
        temporary.write_text("new")
    assert (tmp_path / "pipe").is_fifo()
