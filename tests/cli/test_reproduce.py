"""``lobula reproduce`` as a user calls it."""

from __future__ import annotations

import sys

import pytest


class TestReproduce:
    @pytest.fixture(autouse=True)
    def _nothing_drawn(self, monkeypatch):
        """The drawing has its own tests; it takes longer than all the rest."""
        pytest.importorskip("matplotlib")
        monkeypatch.setattr("lobula.experiments.paper.reproduction.save_figure", lambda drawing, path: path.touch())
        monkeypatch.setattr("lobula.experiments.paper.fig4.plot_courses", lambda *_: None)

    def test_a_figure(self, call, tmp_path):
        done = call("reproduce", "fig4", "--out", "made/here", "--seeds", "1", "--preset", "published", "--json")
        assert done.code == 0
        (found,) = done.document["figures"]
        assert (found["figure"], list(found["presets"])) == ("fig4", ["published"])
        assert {path.name for path in (tmp_path / "made/here").iterdir()} == {
            "fig4.csv", "fig4.json", "fig4.md", "fig4.png", "fig4.svg", "paper.md"
        }  # fmt: skip

    def test_people_get_a_table(self, call):
        done = call("reproduce", "fig4", "--out", "out", "--quick", "--preset", "paper")
        assert done.code == 0
        lines = done.out.splitlines()
        assert lines[0] == "fig4: Membrane potentials for four motions"
        assert lines[1].split()[:2] == ["claim", "paper"]
        assert [line.split()[0] for line in lines[2:]] == [f"4.{n}" for n in range(1, 8)]
        assert "2/2" in done.out  # two repeats
        assert "paper.md" in done.err


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("fig9", "--out", "o"), "reproduce fig9: did you mean fig"),
        (("movie", "--out", "o"), "known here are fig4, fig5, fig6"),
        (("fig4", "--out", "o", "--seeds", "0"), "--seeds 0: must be 1 to 500"),
        (("fig4", "--out", "o", "--preset", "papper"), "--preset papper: must be one of paper, published"),
        (("fig4", "--out", "o", "--minutes", "3"), "--minutes 3.0: goes with table1 or all, not with fig4"),
        (("fig5", "--out", "o", "--workers", "2"), "--workers 2: goes with table1 or all, not with fig5"),
        (("fig4",), "--out"),
        (("fig4", "--out", "file/below"), "--out file/below: file is a file, must be a folder"),
    ],
)
def test_a_wrong_request_is_one_line(call, tmp_path, arguments, says):
    (tmp_path / "file").write_text("")
    done = call("reproduce", *arguments)
    assert done.code == 2
    assert says in done.err
    assert len(done.err.splitlines()) == 1
    assert not (tmp_path / "o").exists()


def test_a_folder_without_permission_is_told_before_the_work(call, tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.setattr("os.access", lambda *_: False)  # whoever runs the tests may be allowed everything
    done = call("reproduce", "all", "--out", "o")
    assert done.code == 3
    assert done.err == "lobula: cannot write o: no permission\n"


def test_without_matplotlib_it_says_what_to_install(call, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    done = call("reproduce", "all", "--out", "o")
    assert done.code == 2
    assert 'pip install "lobula[plot]"' in done.err
