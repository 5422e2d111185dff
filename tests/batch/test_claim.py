"""One at a time, and a claim ends with its process."""

from __future__ import annotations

import subprocess
import sys
import threading

import pytest

from lobula.batch.claim import claimed, sweep
from lobula.errors import OutputError

HOLDER = """
import sys
from pathlib import Path
from lobula.batch.claim import claimed
with claimed(Path(sys.argv[1]), "k") as scratch:
    (scratch / "half").write_text("x")
    print("mine", flush=True)
    sys.stdin.read()
"""


@pytest.fixture
def holder(tmp_path):
    """Another process that has claimed ``k``."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLDER, tmp_path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        env={"PYTHONPATH": ":".join(sys.path)},
    )  # fmt: skip
    assert process.stdout.readline() == "mine\n"
    yield process
    process.kill()
    process.communicate()


def test_nothing_is_left(tmp_path):
    with claimed(tmp_path, "k") as scratch:
        (scratch / "file").write_text("x")
    assert list(tmp_path.iterdir()) == []


def test_the_second_gets_nothing_until_the_first_is_done(tmp_path):
    with claimed(tmp_path, "k"), claimed(tmp_path, "k") as second, claimed(tmp_path, "other") as other:
        assert second is None
        assert other.is_dir()
    with claimed(tmp_path, "k") as again:
        assert list(again.iterdir()) == []


def test_another_process_has_it_until_it_is_killed(holder, tmp_path):
    sweep(tmp_path)
    with claimed(tmp_path, "k") as scratch:
        assert scratch is None
    assert (tmp_path / "k" / "half").exists()
    holder.kill()
    holder.wait()
    with claimed(tmp_path, "k") as scratch:
        assert list(scratch.iterdir()) == []


def test_what_a_killed_process_left_is_swept(holder, tmp_path):
    holder.kill()
    holder.wait()
    sweep(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_only_one_of_many(tmp_path):
    inside, most, turns = 0, 0, 0
    guard = threading.Lock()

    def work():
        nonlocal inside, most, turns
        for _ in range(100):
            with claimed(tmp_path, "k") as scratch:
                if scratch is not None:
                    with guard:
                        inside += 1
                        most = max(most, inside)
                        turns += 1
                    with guard:
                        inside -= 1

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most == 1
    assert turns > 0


def test_a_folder_that_is_not_there(tmp_path):
    with pytest.raises(OutputError, match=r"^cannot write .*: no such folder"), claimed(tmp_path / "none", "k"):
        pass
