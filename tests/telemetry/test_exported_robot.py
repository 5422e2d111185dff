"""A robot as it is exported, with the program of docs/telemetry.md: what it sends is what the laptop computes."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import lobula
from lobula.export import c_folder
from lobula.params import settings_hash
from lobula.telemetry import Decoder

COMPILER = shlex.split(os.environ.get("CC", "cc"))
PAGE = Path(__file__).parents[2] / "docs" / "telemetry.md"

pytestmark = pytest.mark.skipif(shutil.which(COMPILER[0]) is None, reason="no C compiler on this machine")

MAIN = """
#include <stdio.h>

int main(void) {
    static lobula_state state;
    static uint8_t luma[LOBULA_WIDTH * LOBULA_HEIGHT];
    lobula_reading reading;
    lobula_motor motor;
    int byte;
    lobula_motor_init(&motor, 1);
    lobula_telemetry_init(&line, &about);
    if (lobula_init(&state) != 0) return 1;
    for (uint32_t frame = 0; fread(luma, 1, sizeof luma, stdin) == sizeof luma; frame++) {
        if (lobula_step(&state, luma, 1000.0f / 30.0f, &reading) < 0) return 2;
        tell(frame, frame * 100 / 3, &reading, &motor, 0);
        while ((byte = lobula_telemetry_next(&line)) >= 0) putchar(byte);
    }
    return 0;
}
"""


def test_it_says_what_the_laptop_computes(tmp_path):
    params, movie = lobula.preset("default"), lobula.stimuli.looming(scene="arena")
    folder = tmp_path / "robot"
    folder.mkdir()
    for name, text in c_folder(params, "default", 99, 72, "a test").items():
        (folder / name).write_text(text, encoding="utf-8")
    (program,) = re.findall(r"^```c\n(#include.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    (folder / "main.c").write_text(program + MAIN)
    strict = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only"]
    subprocess.run([*COMPILER, *strict, str(folder / "main.c")], check=True)
    sources = sorted(map(str, folder.glob("*.c")))
    subprocess.run([*COMPILER, "-std=c99", "-O1", "-o", str(tmp_path / "run"), *sources, "-lm"], check=True)
    images = np.ascontiguousarray(movie.images, np.uint8)
    sent = subprocess.run([str(tmp_path / "run")], input=images.tobytes(), stdout=subprocess.PIPE, check=True).stdout

    decoder = Decoder()
    found = decoder.feed(sent)
    hello, readings = found[0], [message for message in found if hasattr(message, "frame")]
    assert (hello.preset, hello.settings_hash, hello.version) == ("default", settings_hash(params), lobula.__version__)
    assert hello.thresholds == pytest.approx((0.7, 0.7, 0.2, -0.2))
    assert [told.frame for told in readings] == list(range(len(images)))
    assert decoder.damaged == 0
    laptop = lobula.Network(params, storage="compact").run(images, np.arange(len(images)) / 30)
    for number, name in enumerate(("lgmd1", "lgmd2", "lptc_r", "lptc_l")):
        np.testing.assert_allclose([told.potentials[number] for told in readings], laptop[name], atol=1e-4)
    assert [told.collision for told in readings] == laptop["collision"].tolist()
    assert [told.state for told in readings] == laptop["state"].tolist()
