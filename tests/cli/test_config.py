"""``lobula config``: what is shown can be written, read back and checked."""

from __future__ import annotations

import tomllib

import pytest

import lobula
from lobula.params import settings_hash, to_dict, walk


def test_every_setting_with_unit_range_and_origin(call):
    document = call("config", "show", "--json").document
    rows = {row["path"]: row for row in document["settings"]}
    assert list(rows) == [path for path, _, _ in walk(lobula.preset())]
    assert rows["lptc.spiking.threshold"]["value"] == 0.2
    assert rows["lgmd1.spiking.threshold"] == {
        "path": "lgmd1.spiking.threshold", "value": 0.7, "unit": "", "low": 0.01, "high": 0.99, "choices": None,
        "meaning": "T_sp, of the potential's magnitude", "source": "paper Sec. III",
    }  # fmt: skip
    assert all(row["source"] and row["meaning"] for row in rows.values())
    assert document["settings_hash"] == settings_hash(lobula.preset())


def test_the_table_shows_the_same(call):
    lines = call("config", "show").out.splitlines()
    assert lines[0].split() == ["setting", "value", "allowed", "meaning", "source"]
    assert sum(line.startswith("lamina.dog.") for line in lines) == sum(
        path.startswith("lamina.dog.") for path, _, _ in walk(lobula.preset()))  # fmt: skip


def test_an_override_names_its_origin(call):
    shown = call("config", "show", "--json", "--set", "lamina.dog.sigma_px=2.5", "--sensitivity", "1").document
    origin = {row["path"]: row["source"] for row in shown["settings"]}
    assert origin["lamina.dog.sigma_px"] == "command line"
    assert origin["decision.collision_spikes"] == "sensitivity 1"


@pytest.mark.parametrize("preset", ["default", "paper", "published"])
def test_what_is_printed_as_toml_is_the_preset(call, preset):
    tree = tomllib.loads(call("config", "show", "--toml", "--preset", preset).out)
    assert tree.pop("preset") == preset
    assert tree == to_dict(lobula.preset(preset))


def test_a_file_is_made_and_checked_and_changed(call, tmp_path):
    assert call("config", "init").code == 0
    checked = call("config", "validate", "lobula.toml", "--json").document
    assert (checked["valid"], checked["changed"]) == (True, {})
    file = tmp_path / "lobula.toml"
    file.write_text(file.read_text().replace("sigma_px = 2.0", "sigma_px = 2.5"))
    checked = call("config", "validate", "lobula.toml", "--json").document
    assert checked["changed"] == {"lamina.dog.sigma_px": 2.5}


def test_a_file_that_is_there_is_not_replaced(call, tmp_path):
    (tmp_path / "own.toml").write_text("kept\n")
    done = call("config", "init", "own.toml")
    assert (done.code, done.err) == (2, "lobula: settings file own.toml: is there already; --force replaces it\n")
    assert (tmp_path / "own.toml").read_text() == "kept\n"
    assert call("config", "init", "own.toml", "--force", "--json").document["preset"] == "default"
    assert call("config", "validate", "own.toml").code == 0


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[lamina.dog]\nsigma = 2", "unknown setting lamina.dog.sigma: did you mean sigma_px?"),
        ("[lamina.dog]\nsigma_px = 200.0", "lamina.dog.sigma_px = 200.0: must be float in [0.3, 32] px"),
        ("lamina = 3", "lamina = 3: is a group of settings"),
        ('preset = "papr"', "preset 'papr': must be one of"),
        ("preset = 3", "preset = 3: must be the name of a preset"),
        ("a = = 1", "is not TOML"),
    ],
)
def test_what_is_wrong_with_a_file(call, tmp_path, text, says):
    (tmp_path / "own.toml").write_text(text)
    done = call("config", "validate", "own.toml")
    assert done.code == 2
    assert done.err.count("\n") == 1
    assert says in done.err


def test_other_wrong_requests(call):
    assert "must end in .toml" in call("config", "init", "own.txt").err
    assert "only one of them" in call("config", "show", "--json", "--toml").err
    done = call("config", "init", "no/own.toml")
    assert (done.code, done.err) == (2, "lobula: cannot write no/own.toml: no such folder no\n")
