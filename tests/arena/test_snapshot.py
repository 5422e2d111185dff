"""A state goes through a file unchanged, or an error says why not; a failed write leaves the file that was there."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lobula.arena.snapshot import load_snapshot, save_snapshot
from lobula.errors import OutputError, ParameterError


def test_everything_comes_back_as_it_was(tmp_path: Path) -> None:
    tree = {
        "none": None, "yes": True, "whole": 2**127 + 1, "number": 0.1 + 0.2, "missing": math.nan, "text": "naïve",
        "pair": (1, (2.5, "x")), "list": [1, [None, {"deep": np.arange(3, dtype=np.uint64)}]], "empty": {},
        "complex": np.array([1 + 2j]), "bits": np.array([[True], [False]]), "scalar": np.float32(0.1),
        "table": np.array([(1, "AA")], dtype=[("tick", np.int64), ("kind", "U2")]),
    }  # fmt: skip
    save_snapshot(tmp_path / "state", tree)
    back = load_snapshot(tmp_path / "state")
    assert list(back) == list(tree)
    assert math.isnan(back.pop("missing"))
    for name in ("none", "yes", "whole", "number", "text", "pair", "empty", "scalar"):
        assert back[name] == tree[name]
        assert type(back[name]) is type(tree[name]) or name == "scalar"
    np.testing.assert_array_equal(back["list"][1][1]["deep"], np.arange(3, dtype=np.uint64))
    assert back["list"][1][1]["deep"].dtype == np.uint64
    for name in ("complex", "bits", "table"):
        np.testing.assert_array_equal(back[name], tree[name])


@pytest.mark.parametrize("value", [object(), {1: 2}, {1, 2}, np.array([object()]), {"#array": 0}])
def test_what_cannot_be_stored_is_named(tmp_path: Path, value: Any) -> None:
    with pytest.raises(ParameterError, match=r"snapshot\.a\[1\]: is a .*: must be numbers"):
        save_snapshot(tmp_path / "state", {"a": [0, value]})
    assert not list(tmp_path.iterdir())


def test_a_failed_write_leaves_what_was_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    save_snapshot(tmp_path / "state", {"a": 1})

    def full(*args: Any, **kwargs: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez", full)
    with pytest.raises(OutputError, match=r"cannot write .*state: the disk is full"):
        save_snapshot(tmp_path / "state", {"a": 2})
    assert load_snapshot(tmp_path / "state") == {"a": 1}
    assert [path.name for path in tmp_path.iterdir()] == ["state"]


def test_no_such_folder(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"cannot write .*no/state: no such folder"):
        save_snapshot(tmp_path / "no" / "state", {})


def test_files_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="cannot be read: No such file"):
        load_snapshot(tmp_path / "missing")
    for name, data in (("text", b"hello"), ("empty", b""), ("zip", b"PK\x03\x04broken")):
        (tmp_path / name).write_bytes(data)
        with pytest.raises(ParameterError, match="is no snapshot of lobula, or a damaged one"):
            load_snapshot(tmp_path / name)
    np.savez(tmp_path / "other.npz", a=np.arange(3))
    with pytest.raises(ParameterError, match="is no snapshot"):
        load_snapshot(tmp_path / "other.npz")


def test_a_cut_file_is_damaged(tmp_path: Path) -> None:
    save_snapshot(tmp_path / "state", {"a": np.arange(1000)})
    data = (tmp_path / "state").read_bytes()
    (tmp_path / "state").write_bytes(data[: len(data) // 2])
    with pytest.raises(ParameterError, match="damaged"):
        load_snapshot(tmp_path / "state")
