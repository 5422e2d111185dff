"""``lobula export c`` writes the folder, and refuses in one line, before anything is written."""

import errno
import re
from pathlib import Path

import pytest

from lobula.model.presets import preset
from lobula.params import settings_hash, with_settings


def test_a_new_folder(call, tmp_path):
    done = call("export", "c", "--preset", "published", "--size", "80x60", "--out", "robots/one")
    assert done.code == 0
    folder = tmp_path / "robots" / "one"
    assert {"lobula.h", "lobula_config.h", "main.c", "motor.c", "README.md", "LICENSE"} < {
        p.name for p in folder.iterdir()
    }
    assert "#define LOBULA_WIDTH 80\n" in (folder / "lobula_config.h").read_text()
    files = len(list(folder.iterdir()))
    assert re.fullmatch(
        rf"robots/one: {files} files, preset published, 80 x 60 px, [\d.]+ KiB of memory; "
        r"start with robots/one/README.md\n", done.err,
    )  # fmt: skip
    assert done.out == ""


def test_records_for_programs(call, tmp_path):
    document = call("export", "c", "--out", "robot", "--json").document
    assert document["files"] == sorted(path.name for path in (tmp_path / "robot").iterdir())
    assert (document["folder"], document["width"], document["height"]) == ("robot", 99, 72)
    assert document["settings_hash"] == settings_hash(preset())
    assert document["preset"] == "default"
    assert 50_000 < document["state_bytes"] <= 192 * 1024  # of the robot's 256 KB, by the issue


def test_settings_as_run_takes_them(call, tmp_path):
    (tmp_path / "my.toml").write_text('preset = "published"\n[lgmd1]\nsigmoid_grey = 2.5\n')
    asked = ("--config", "my.toml", "--set", "clock.period_ms=40", "--neurons", "lgmds", "--size", "64x48")
    document = call("export", "c", *asked, "--out", "robot", "--json").document
    wanted = with_settings(
        preset("published", neurons="lgmds"), {"lgmd1": {"sigmoid_grey": 2.5}, "clock": {"period_ms": 40}}, "test"
    )
    assert (document["preset"], document["settings_hash"]) == ("published", settings_hash(wanted))
    header = (tmp_path / "robot" / "lobula_config.h").read_text()
    assert re.search(r"#define LOBULA_LGMD1_SIGMOID_GREY 2.5f /\* .* \(file my.toml\) \*/", header)
    assert re.search(r"#define LOBULA_CLOCK_PERIOD_MS 40.0f /\* .* \(command line\) \*/", header)
    assert re.search(r"#define LOBULA_DECISION_NEURONS 1 /\* lgmds; .* \(command line\) \*/", header)
    command = (
        "lobula export c --out DIR --size 64x48 --preset published --neurons lgmds --config my.toml --set "
        "clock.period_ms=40\n"
    )
    assert command in (tmp_path / "robot" / "README.md").read_text()


def test_sensitivity_is_written_down(call, tmp_path):
    assert call("export", "c", "--sensitivity", "0.8", "--ram", "200.5", "--out", "robot").code == 0
    assert " --sensitivity 0.8 --ram 200.5\n" in (tmp_path / "robot" / "README.md").read_text()


def test_an_empty_folder_is_filled(call, tmp_path):
    (tmp_path / "robot").mkdir()
    assert call("export", "c", "--out", "robot").code == 0


def test_a_folder_with_files_is_kept(call, tmp_path):
    kept = tmp_path / "robot" / "thesis.txt"
    kept.parent.mkdir()
    kept.write_text("years")
    done = call("export", "c", "--out", "robot")
    assert (done.code, done.err) == (
        2, "lobula: --out robot: holds files: must be a new or empty folder; --force writes into it\n")  # fmt: skip
    assert [path.name for path in kept.parent.iterdir()] == ["thesis.txt"]


def test_force_brings_a_project_up_to_date_and_leaves_its_own_files(call, tmp_path):
    assert call("export", "c", "--out", "robot").code == 0
    folder = tmp_path / "robot"
    (folder / "main.c").write_text("int main(void) { return 0; }\n")
    (folder / "mine.c").write_text("\n")
    (folder / "notes.md").write_text("\n")
    (folder / "lobula.h").write_text("damaged")
    done = call("export", "c", "--out", "robot", "--size", "32x24", "--force")
    assert done.code == 0
    assert done.err.endswith(
        " of memory; main.c is as it was\n"
        "robot/mine.c: not of this export, left as it is: yours, or of an older lobula and to be removed\n"
    )
    done = call("export", "c", "--out", "robot", "--size", "64x48", "--force", "--json")
    assert done.code == 0
    assert not {"main.c", "mine.c"} & set(done.document["files"])
    assert done.document["other_sources"] == ["mine.c"]
    assert (folder / "main.c").read_text() == "int main(void) { return 0; }\n"
    assert "lobula_step" in (folder / "lobula.h").read_text()
    assert "#define LOBULA_WIDTH 64\n" in (folder / "lobula_config.h").read_text()


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (["--preset", "papre"], "preset 'papre': must be one of default, published, paper, lobula"),
        (["--size", "31x24"], "size 31 x 24 px (width x height): must be 32 x 24 to 4096 x 4096"),
        (["--size", "32x23"], "size 32 x 23 px (width x height): must be 32 x 24 to 4096 x 4096"),
        (["--size", "4097x72"], "size 4097 x 72 px (width x height): must be 32 x 24 to 4096 x 4096"),
        (["--size", "99"], "--size '99': must be WIDTHxHEIGHT, such as 99x72"),
        (["--ram", "0"], "--ram 0: must be a number of KiB above 0"),
        (["--ram", "-3"], "--ram -3: must be a number of KiB above 0"),
        (["--ram", "nan"], "--ram nan: must be a number of KiB above 0"),
        (["--set", "lgmd1.sigmoid=1"], "unknown setting lgmd1.sigmoid: did you mean sigmoid_grey?"),
        (["--config", "none.toml"], "settings file none.toml: no such file"),
        (["--neurons", "lgmd3"], "decision.neurons = 'lgmd3': must be str one of all, lgmds, lgmd2"),
    ],
)
def test_what_cannot_be_is_refused_in_a_line(call, tmp_path, asked, words):
    done = call("export", "c", *asked, "--out", "robot")
    assert (done.code, done.err) == (2, f"lobula: {words}\n")
    assert not (tmp_path / "robot").exists()


def test_too_little_memory_is_refused_with_the_numbers(call, tmp_path):
    done = call("export", "c", "--size", "320x240", "--ram", "192", "--out", "robot")
    assert done.code == 2
    found = re.fullmatch(
        r"lobula: --ram 192: 320 x 240 px need ([\d.]+) KiB with these settings, 2.5 KiB of stack among it: "
        r"the largest of this shape that fits is (\d+) x (\d+)\n", done.err,
    )  # fmt: skip
    assert found
    assert float(found[1]) > 192
    width, height = int(found[2]), int(found[3])
    assert abs(width / height - 4 / 3) < 0.02
    assert not (tmp_path / "robot").exists()
    assert call("export", "c", "--size", f"{width}x{height}", "--ram", "192", "--out", "robot").code == 0
    wider = f"{width + 1}x{round((width + 1) * 240 / 320)}"
    assert call("export", "c", "--size", wider, "--ram", "192", "--out", "robot2").code == 2


def test_a_board_that_is_too_small_for_anything(call):
    done = call("export", "c", "--ram", "8", "--out", "robot")
    assert done.code == 2
    assert re.fullmatch(
        r"lobula: --ram 8: 99 x 72 px need [\d.]+ KiB with these settings, 2.5 KiB of stack among it: "
        r"none of this shape fits; "
        r"the least there is, 32 x 24, needs [\d.]+ KiB\n", done.err,
    )  # fmt: skip


def test_a_file_in_the_way(call, tmp_path):
    (tmp_path / "robot").write_text("")
    done = call("export", "c", "--out", "robot")
    assert (done.code, done.err) == (2, "lobula: --out robot: robot is a file, must be a folder\n")


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ([], "Missing command"),
        (["rust"], "No such command 'rust'; must be one of c;"),
        (["c"], "Missing option '--out'"),
    ],
)
def test_a_command_line_that_says_too_little(call, asked, words):
    done = call("export", *asked)
    assert done.code == 2
    assert words in done.err
    assert done.err.count("\n") == 1


def test_a_full_disk(call, monkeypatch):
    def full(*_: object, **__: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    done = call("export", "c", "--out", "robot")
    assert done.code == 3
    assert re.fullmatch(r"lobula: cannot write robot/[\w.]+: the disk is full\n", done.err)
