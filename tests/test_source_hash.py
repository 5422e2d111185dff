"""The hash of the code changes with the parts it is asked about, and with nothing else."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import lobula
from lobula import source_hash as module


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A copy of the package's files that the hash is made of."""
    root = Path(lobula.__file__).parent
    for name in ("params.py", "types.py", "model/clock.py", "frames/clock.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(root / name, tmp_path / name)
    monkeypatch.setattr(module, "__file__", str(tmp_path / "source_hash.py"))
    return tmp_path


def hash_of(*parts):
    module.source_hash.cache_clear()
    try:
        return module.source_hash(*parts)
    finally:
        module.source_hash.cache_clear()


@pytest.mark.parametrize("touched", ["model/clock.py", "params.py", "types.py"])
def test_it_changes_with_a_part_and_with_what_all_rest_on(package, touched):
    before = hash_of("model")
    (package / touched).write_text("x = 1\n")
    assert hash_of("model") != before


def test_it_changes_with_nothing_else(package):
    before = hash_of("model")
    (package / "frames" / "clock.py").write_text("x = 1\n")
    (package / "model" / "notes.txt").write_text("x")
    assert hash_of("model") == before
    assert hash_of("model", "frames") != before
    assert len(before) == 12
