"""The folder is complete, compiles anywhere without a word, and its numbers are those of the Python engine."""

import csv
import io
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import lobula
from lobula.export import c_folder
from lobula.model.presets import preset
from lobula.params import with_settings
from lobula.types import NEURONS

ROOT = Path(__file__).parents[2]
STRICT = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror")
MADE = {"lobula_config.h", "main.c", "README.md"}
ALLOWED = {"memcpy", "memset", "memmove", "expf", "powf", "floorf", "fabsf"}
"""What the sources may want of a C library."""

SETTINGS = {
    "paper": preset("paper"),
    "published": preset("published"),
    "lobula": preset("lobula"),
    "odd": with_settings(
        preset("published", neurons="lgmds"),
        {"lamina": {"dog": {"radius_px": 1}, "fdsr": {"enabled": False}}, "lgmd2": {"neighbour_px": 2},
         "lptc": {"emd": {"spans_px": [1, 5], "delays_ms": [20, 30]}}, "flash": {"enabled": False}},
        "test",
    ),
}  # fmt: skip
SIZES = {"odd": (61, 47)}


@pytest.fixture(scope="session")
def folders(tmp_path_factory, compiler):
    """Name of the settings -> a folder with its compiled example; each is made once."""
    made = {}

    def folder(name):
        if name not in made:
            made[name] = tmp_path_factory.mktemp(name)
            width, height = SIZES.get(name, (99, 72))
            for file, text in c_folder(SETTINGS[name], name, width, height, "lobula export c").items():
                (made[name] / file).write_text(text, encoding="utf-8")
            compile_with(compiler, made[name], "-O1", "-o", "robot")
        return made[name]

    return folder


def compile_with(compiler, folder, *flags):
    sources = sorted(path.name for path in folder.glob("*.c"))
    done = subprocess.run(
        [compiler, *STRICT, *flags, *sources, *(() if "-c" in flags else ("-lm",))], cwd=folder,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")


def run(folder, images):
    """What the example prints for a movie, as columns."""
    done = subprocess.run([folder / "robot"], input=images.tobytes(), capture_output=True, check=True)
    rows = list(csv.DictReader(io.StringIO(done.stdout.decode())))
    return {name: [row[name] for row in rows] for name in rows[0]}


def test_the_sources_are_our_own_byte_for_byte():
    files = c_folder(preset(), "default", 99, 72, "lobula export c")
    ours = {path.name: path for folder in ("core/src", "core/robot") for path in (ROOT / folder).glob("*.[ch]")}
    ours |= {"LICENSE": ROOT / "LICENSE", "lobula_types.h": ROOT / "core/include/lobula_types.h"}
    assert {"lobula.h", "lobula.c", "motor.h", "motor.c", *MADE} < set(files)
    for name in set(files) - MADE:
        assert files[name] == ours[name].read_text(encoding="utf-8"), name


def test_the_readme_tells_what_was_made():
    text = c_folder(preset("published"), "published", 80, 60, "lobula export c --size 80x60 --out DIR")["README.md"]
    for word in (
        "80 x 60",
        "preset published",
        "lobula export c --size 80x60 --out DIR",
        "scale=80:60:",
        "--set width=80 --set height=60",
        lobula.__version__,
    ):
        assert word in text
    assert "$" not in text


@pytest.mark.parametrize("name", SETTINGS)
def test_it_compiles_without_a_word(name, folders):
    assert (folders(name) / "robot").exists()


@pytest.mark.parametrize("other", ["clang", "arm-none-eabi-gcc"])
def test_other_compilers_take_it_too(other, folders, tmp_path):
    if shutil.which(other) is None:
        pytest.skip(f"no {other}")
    folder = shutil.copytree(folders("paper"), tmp_path / "robot")
    board = ("-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard") if other.startswith("arm") else ()
    compile_with(other, folder, "-c", "-O1", *board)


def test_it_wants_nothing_of_a_c_library_but_copies_and_a_few_functions(folders, compiler, tmp_path):
    if shutil.which("nm") is None:
        pytest.skip("no nm")
    folder = shutil.copytree(folders("paper"), tmp_path / "robot")
    (folder / "main.c").unlink()
    compile_with(compiler, folder, "-c", "-O2", "-fno-stack-protector")
    listed = subprocess.run(["nm", *map(str, folder.glob("*.o"))], capture_output=True, text=True, check=True).stdout
    symbols = [line.split()[-2:] for line in listed.splitlines() if line.strip() and not line.endswith(":")]
    defined = {name for kind, name in symbols if kind != "U"}
    wanted = {name for kind, name in symbols if kind == "U"} - defined
    assert wanted <= ALLOWED | {"_GLOBAL_OFFSET_TABLE_"}


def expected(name, movie):
    """What a robot with the Python engine and the arena's motor queue would see and do, frame by frame."""
    network, left, rows = lobula.Network(SETTINGS[name]), 0, []
    for frame, image in enumerate(movie.images):
        left = max(0, left - 1)
        reading = network.step(image, frame / 30.0, turning=left > 0)
        if reading.collision and left == 0:
            left = 30  # 0.2 s of standing, 0.8 s of turning
        action = "forward" if left == 0 else "stop" if left > 24 else "turn"
        rows.append((reading, action))
    return rows


MOVIES = {
    "looming": lambda size: lobula.stimuli.looming(scene="arena", speed_cm_s=12.0, **size),
    "translating": lambda size: lobula.stimuli.translating(scene="arena", speed_cm_s=12.0, **size),
}


@pytest.mark.parametrize("kind", MOVIES)
@pytest.mark.parametrize("name", SETTINGS)
def test_the_example_says_what_the_python_engine_says(name, kind, folders):
    width, height = SIZES.get(name, (99, 72))
    movie = MOVIES[kind]({"width": width, "height": height})
    rows = expected(name, movie)
    said = run(folders(name), movie.images)
    assert len(said["frame"]) == len(rows) == len(movie)
    for neuron in NEURONS:
        theirs = np.array([getattr(reading, neuron) for reading, _ in rows])
        assert np.array(said[neuron], float) == pytest.approx(theirs, abs=2e-3), neuron
        spikes = np.array([getattr(reading.spikes, neuron) for reading, _ in rows])
        assert (np.array(said[f"spikes_{neuron}"], int) != spikes).mean() <= 0.02, neuron
    assert said["collision"] == [str(int(reading.collision)) for reading, _ in rows]
    assert [action.split()[0] for action in said["action"]] == [action for _, action in rows]
    assert any(reading.spikes.lgmd1 or reading.spikes.lptc_r or reading.spikes.lgmd2 for reading, _ in rows)


def test_the_wheels_follow_the_actions(folders):
    said = run(folders("paper"), MOVIES["looming"]({}).images)
    assert {"forward", "stop"} < set(said["action"])
    for action, left, right in zip(said["action"], map(float, said["left"]), map(float, said["right"]), strict=True):
        if action == "forward":
            assert (left, right) == (8, 8)
        elif action == "stop":
            assert (left, right) == (0, 0)
        else:  # 120 to 180 degrees in 0.8 s, on wheels 4.8 cm apart
            spin_deg_s = np.degrees((right - left) / 4.8)
            assert (spin_deg_s > 0) == (action == "turn left")
            assert 120 / 0.8 - 0.5 <= abs(spin_deg_s) <= 180 / 0.8 + 0.5
            assert left == -right


@pytest.mark.parametrize("missing", [1, 99, 99 * 72 - 1])
def test_a_picture_that_is_cut_off_is_told(missing, folders):
    images = np.zeros((3, 72, 99), np.uint8)
    data = images.tobytes()[:-missing]
    done = subprocess.run([folders("paper") / "robot"], input=data, capture_output=True, check=False)
    assert done.returncode == 1
    assert done.stderr == b"the last picture is cut off: pictures must be of 99 x 72 bytes\n"
    assert done.stdout.count(b"\n") == 1 + 2  # the heading, and the two that are whole
