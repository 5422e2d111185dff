"""A whole figure in small, into a folder: the files, and what they gather."""

from __future__ import annotations

import csv
import json
from dataclasses import replace

import pytest

import lobula
from lobula.errors import OutputError, ParameterError
from lobula.experiments.paper.figure import Plan, run
from lobula.experiments.paper.reproduction import FIGURES, FIRST_SEED, publish, reproduce, seeds
from lobula.experiments.paper.trials import as_csv

pytest.importorskip("matplotlib")

PLAN = Plan(presets={name: lobula.preset(name) for name in ("paper", "published")}, seeds=seeds(1))
VERDICT = {"status": "holds", "ours": "9 of 10", "reason": ""}
TABLE = {
    "figure": "table1", "title": "Closed loop", "command": "c", "seeds": [7001], "presets": {"paper": "h"},
    "claims": [{"number": "T.1", "paper": "More.", "verdicts": {"paper": VERDICT}}],
}  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Fig. 4 with one seed, beside a table that somebody else has made."""
    out = tmp_path_factory.mktemp("out")
    (out / "table1.json").write_text(json.dumps(TABLE))
    (out / "table1.md").write_text("# Table 1\n")
    (out / "table1.png").write_bytes(b"\x89PNG")
    films = []
    reproduce(FIGURES["fig4"], PLAN, out, lambda: films.append(1))
    assert len(films) == 4
    return out


def test_the_files(folder) -> None:
    names = {path.name for path in folder.iterdir()}
    pictures = {f"fig4{preset}.{kind}" for preset in ("", "-published") for kind in ("png", "svg")}
    assert names == pictures | {
        "fig4.csv",
        "fig4.json",
        "fig4.md",
        "paper.md",
        "table1.json",
        "table1.md",
        "table1.png",
    }
    assert (folder / "fig4.png").read_bytes().startswith(b"\x89PNG")
    assert b"<svg" in (folder / "fig4.svg").read_bytes()
    rows = list(csv.DictReader((folder / "fig4.csv").open()))
    assert len(rows) == 4 * 2
    assert {row["seed"] for row in rows} == {str(FIRST_SEED)}
    hashes = json.loads((folder / "fig4.json").read_text())["presets"]
    assert {(row["preset"], row["settings_hash"]) for row in rows} == set(hashes.items())


def test_what_every_account_of_the_model_says_is_seen(folder) -> None:
    """Signs and silences do not hang on the seed: recession, and the direction of translation."""
    claims = {claim["number"]: claim for claim in json.loads((folder / "fig4.json").read_text())["claims"]}
    for number in ("4.2", "4.3", "4.5", "4.6", "4.7"):
        assert {of["status"] for of in claims[number]["verdicts"].values()} == {"holds"}, number


def test_the_gathered_page_keeps_what_was_there_before(folder) -> None:
    text = (folder / "paper.md").read_text()
    assert text.index("## Fig. 4") < text.index("## Table 1")


def test_published_into_the_docs(folder, tmp_path) -> None:
    publish(folder, tmp_path)
    assert {p.name for p in (tmp_path / "paper").iterdir()} == {
        "fig4.md", "fig4.png", "fig4-published.png", "table1.md", "table1.png"
    }  # fmt: skip
    text = (tmp_path / "paper.md").read_text()
    for link in ("paper/fig4.png", "paper/fig4.md"):
        assert f"]({link})" in text


def test_the_same_seeds_make_the_same_trials(folder) -> None:
    assert as_csv(run(FIGURES["fig4"], PLAN)) == (folder / "fig4.csv").read_text()


def test_a_file_that_cannot_be_written_is_named(tmp_path) -> None:
    (tmp_path / "fig4.csv").mkdir()
    with pytest.raises(OutputError, match=r"cannot write .*fig4\.csv"):
        reproduce(FIGURES["fig4"], replace(PLAN, presets={"paper": lobula.preset("paper")}), tmp_path)


@pytest.mark.parametrize("count", [0, -1, 501])
def test_seeds_out_of_range(count) -> None:
    with pytest.raises(ParameterError, match=f"--seeds {count}: must be 1 to 500"):
        seeds(count)
