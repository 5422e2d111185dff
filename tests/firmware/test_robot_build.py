"""The robot's build, here: an exported folder, any C99 compiler, and the readings of the laptop's compact network."""

from __future__ import annotations

import os
import shutil
import struct
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lobula
from lobula.engine.network import Network
from lobula.export.folder import c_folder
from lobula.model.network import NetworkParams
from lobula.types import NEURONS, STATES
from tests.engine.engines import changed, needs_core
from tests.engine.films import Film, drifting, filmed, growing, lamps, looming, turned

CC = os.environ.get("CC", "cc")
pytestmark = [needs_core, pytest.mark.skipif(shutil.which(CC) is None, reason=f"no C compiler: {CC}")]

READING = np.dtype(
    [("time_s", "f8"), *((name, "f4") for name in NEURONS), ("spikes", "i4", 4), ("collision", "i4"), ("state", "i4")]
)
OFF: dict[str, Any] = {"enabled": False}
KINDS: dict[str, tuple[str, dict[str, Any]]] = {
    "paper": ("paper", {}),
    "lobula": ("lobula", {}),
    "no-dog-no-fdsr": ("published", {"lamina": {"dog": OFF, "fdsr": OFF}}),
    "no-grouping": ("published", {"lgmd1": {"grouping": OFF}, "lgmd2": {"grouping": OFF}}),
    "reads-mixed": ("paper", {"lgmd2": {"reads": "change", "sigmoid_grey": 1.0, "grouping": {"threshold_grey": 30.0}}}),
    "neighbours-1-3": ("published", {"lgmd1": {"neighbour_px": 1}, "lgmd2": {"neighbour_px": 3}}),
    "products": ("published", {"lgmd1": {"product_gain": 0.01}, "lgmd2": {"on": {"bias": 0.2}}}),
    "radius-3-and-spans": (
        "paper",
        {
            "lamina": {"dog": {"radius_px": 3, "surround": 3}},
            "lptc": {"emd": {"spans_px": (2, 9), "delays_ms": (30.0, 20.0)}},
        },
    ),
}  # fmt: skip


def build(folder: Path, params: NetworkParams, width: int, height: int) -> Path:
    """Export and compile as a stranger would: standard C, nothing but warnings asked for."""
    for name, text in c_folder(params, "test", width, height, "test").items():
        (folder / name).write_text(text, encoding="utf-8")
    sources = [str(path) for path in folder.glob("*.c") if path.name != "main.c"]
    program = folder / "program"
    subprocess.run(
        [CC, "-std=c99", "-pedantic-errors", "-Wall", "-Wextra", "-Werror", "-O0", f"-I{folder}", *sources,
         str(Path(__file__).with_name("on_host.c")), "-o", str(program), "-lm"],
        check=True,
    )  # fmt: skip
    return program


def ask(program: Path, film: Film, by_row: bool) -> np.ndarray:
    """Return the readings (T,)."""
    turning = np.zeros(len(film.images), bool) if film.turning is None else film.turning
    dts_ms = np.diff(film.times_s, prepend=film.times_s[0] - 1.0) * 1000.0
    frames = (struct.pack("=iif", int(by_row), int(turns), dt) + image.tobytes()
              for image, turns, dt in zip(film.images, turning, dts_ms, strict=True))  # fmt: skip
    raw = subprocess.run([program], input=b"".join(frames), stdout=subprocess.PIPE, check=True).stdout
    return np.frombuffer(raw, READING)


@pytest.mark.parametrize("kind", KINDS)
def test_a_robot_says_what_the_compact_network_says(kind: str, tmp_path: Path) -> None:
    base, settings = KINDS[kind]
    params = changed(lobula.preset(base), **settings)
    program = build(tmp_path, params, 52, 36)
    for film in (growing(), turned(growing()), lamps(), filmed(looming(width=52, height=36))):
        said = ask(program, film, by_row=False)
        laptop = Network(params, storage="compact").run(
            film.images, film.times_s - film.times_s[0], turning=film.turning
        )
        for name in NEURONS:
            error = np.abs(said[name] - laptop[name])
            assert np.percentile(error, 90) <= 2e-5, name
            assert error.max() <= 1e-3, name
        assert [STATES[i] for i in said["state"]] == laptop["state"].tolist()
        other = (said["spikes"] != np.stack([laptop[f"spikes_{name}"] for name in NEURONS], axis=1)).any(axis=1)
        assert other.mean() <= 0.01
        assert said["collision"].tolist() == laptop["collision"].tolist()


def test_line_by_line_is_the_same_to_the_last_bit(tmp_path: Path) -> None:
    """Lines wait where the lists of grouped cells grow: what is overwritten too early would show."""
    program = build(tmp_path, lobula.preset("published"), 101, 77)
    film = drifting(77, 101, frames=24)
    film = film._replace(images=film.images.astype(np.uint8))
    whole, by_row = (ask(program, film, by_row=way) for way in (False, True))
    assert whole["spikes"].sum() > 0
    assert whole.tobytes() == by_row.tobytes()
