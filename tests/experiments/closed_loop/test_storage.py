"""Float against 16-bit planes in the arena: the same worlds and seeds, told side by side."""

from __future__ import annotations

import pytest

from lobula.experiments.closed_loop.storage import jobs, lines, main
from lobula.model.presets import preset

from .hand_made import done

SHORT = ("--minutes", "0.05", "--robots", "2", "--workers", "1")


def test_a_rate_inside_the_other_ones_interval_and_one_outside():
    # SR1 = AP / (AP + CP): 90 of 100 with Wilson's interval 0.826 to 0.945, against 88 and 40 of 100
    # SR2 = AA / (AA + AT + CR): 50 of 100 with 0.404 to 0.596, against 60 and 59 of 100
    first = done(AP=90, CP=10, AA=50, AT=30, CR=20).score
    for other, inside in (
        (done(AP=88, CP=12, AA=60, CR=40).score, "yes no"),
        (done(AP=40, CP=60, AA=59, AT=41).score, "no yes"),
    ):
        told = list(lines({(4, "float"): first, (4, "compact"): other}))
        assert [line.split()[-1] for line in told[1:]] == inside.split()
    assert told[1].split()[:5] == ["4", "SR1", "0.900", "(0.826", "to"]
    assert "0.500 (0.404 to 0.596)" in told[2]


def test_nothing_to_count_is_said():
    told = list(lines({(7, "float"): done(AP=1).score, (7, "compact"): done().score}))
    assert [line.endswith("nothing to count") for line in told] == [False, True, True]


def test_both_run_in_the_same_worlds_and_only_their_storage_differs():
    one, other = jobs(preset("paper"), [4], [9], 1.0)
    a, b = (job.identity("code") for job in (one, other))
    assert {name for name in a if a[name] != b[name]} == {"storage"}
    assert [job.controller().storage for job in (one, other)] == ["float", "compact"]


def test_the_command_says_both_and_keeps_what_is_finished(tmp_path, capsys):
    arguments = ["--out", str(tmp_path), "--seeds", "1", *SHORT]
    assert main(arguments) == 0
    told = capsys.readouterr().out
    assert [line.split()[:2] for line in told.splitlines()] == [["robots", "rate"], ["2", "SR1"], ["2", "SR2"]]
    before = {path.name: path.stat().st_mtime_ns for path in tmp_path.iterdir()}
    assert set(before) == {"float-2-121.npz", "compact-2-121.npz"}
    assert main(arguments) == 0
    assert capsys.readouterr().out == told
    assert {path.name: path.stat().st_mtime_ns for path in tmp_path.iterdir()} == before


@pytest.mark.parametrize(
    ("given", "says"), [(["--seeds", "0"], "--seeds 0: must be 1 or more"), (["--preset", "x"], "preset")]
)
def test_what_is_refused(given, says, tmp_path, capsys):
    assert main(["--out", str(tmp_path / "no"), *SHORT, *given]) == 2
    assert says in capsys.readouterr().err
    assert not (tmp_path / "no").exists()
