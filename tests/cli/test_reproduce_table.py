"""``lobula reproduce table1``, called as a user calls it."""

from __future__ import annotations

import os
import signal
import time

import pytest

from lobula.experiments.closed_loop import table1

pytest.importorskip("matplotlib")

SHORT = ("reproduce", "table1", "--out", "t", "--quick", "--seeds", "1", "--first-seed", "41")


def test_it_tells_the_claims_and_writes_the_page(call, tmp_path, monkeypatch):
    monkeypatch.setattr(table1, "DRAWINGS", {"table1": table1.DRAWINGS["table1"]})  # one will do
    done = call(*SHORT, "--minutes", "0.01", "--workers", "1", "--json")
    assert done.code == 0
    (found,) = done.document["figures"]
    assert (found["figure"], found["seeds"], found["minutes"]) == ("table1", [41], 0.01)
    assert [claim["number"] for claim in found["claims"]] == [f"T.{n}" for n in range(1, 12)]
    assert "table1" in (tmp_path / "t" / "paper.md").read_text()
    other = call(*SHORT, "--minutes", "0.03", "--workers", "1")
    assert (other.code, "was made with minutes 0.01, not 0.03" in other.err) == (2, True)


def test_ctrl_c_stops_all_workers_and_nothing_is_lost(spawn, tmp_path):
    process = spawn(*SHORT, "--minutes", "5", "--workers", "2", start_new_session=True)
    deadline_s = time.monotonic() + 60
    while len(list((tmp_path / "t").glob("table1-jobs/*.checkpoint"))) < 2:
        assert process.poll() is None
        assert time.monotonic() < deadline_s
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal sends it: to the workers too
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "the same command goes on from there" in err
    assert "Traceback" not in err
    assert len(list((tmp_path / "t").glob("table1-jobs/*.checkpoint"))) == 2


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--minutes", "0"), "--minutes 0: must be above 0"),
        (("--seeds", "0"), "--seeds 0: must be 1 to 500"),
        (("--first-seed", "-1"), "--first-seed -1: must be 0 or more"),
        (("--preset", "papre"), "papre"),
        (("--first-seed", "7001"), "--quick with seeds 7001 to 7002: must not use 7000 to 7999"),
        (("--workers", "0"), "--workers 0: must be 1 to 256"),
    ],
)
def test_a_request_that_cannot_be_met(call, tmp_path, arguments, words):
    done = call("reproduce", "table1", "--out", "t", "--quick", *arguments)
    assert done.code == 2
    assert words in done.err
    assert len(done.err.splitlines()) == 1
    assert not (tmp_path / "t").exists()
