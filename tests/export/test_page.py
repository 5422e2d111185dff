"""docs/robot.md: its sizes and its refusal are what comes out, and its C compiles and does what is said of it."""

import ctypes
import math
import re
import subprocess

import numpy as np
import pytest

from lobula.export import c_folder, state_bytes
from lobula.model.presets import preset

from ..docs.pages import ROOT, blocks

PAGE = ROOT / "docs" / "robot.md"
WIDTH, HEIGHT = 80, 60

AROUND = """
#include <string.h>
#include "lobula.h"
#include "motor.h"
typedef struct { uint8_t *buf; } camera_fb_t;
camera_fb_t *esp_camera_fb_get(void);
void esp_camera_fb_return(camera_fb_t *);
int64_t esp_timer_get_time(void);
void wait_for_line(uint8_t *);
extern uint8_t luma[LOBULA_WIDTH * LOBULA_HEIGHT], line[LOBULA_WIDTH];
extern lobula_state state;
extern lobula_reading reading;
extern lobula_motor motor;
extern float dt_ms, wheels_cm_s[2];
extern int64_t before_us;
"""


@pytest.fixture(scope="module")
def headers(tmp_path_factory):
    folder = tmp_path_factory.mktemp("page")
    for name, text in c_folder(preset(), "default", WIDTH, HEIGHT, "lobula export c").items():
        if name.endswith(".h"):
            (folder / name).write_text(text, encoding="utf-8")
    return folder


def compiled(compiler, folder, text, *flags):
    (folder / "page.c").write_text(text, encoding="utf-8")
    strict = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror")
    done = subprocess.run(
        [compiler, *strict, *flags, "page.c"], cwd=folder, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")


def definitions():
    return [block for block in blocks(PAGE, "c") if "static void" in block]


def test_its_c_compiles(compiler, headers):
    calls = [block for block in blocks(PAGE, "c") if "static void" not in block]
    assert calls
    assert definitions()
    bodies = [f"void call_{i}(void) {{\n{text}}}\n" for i, text in enumerate(calls)]
    named = "".join(f"void call_{i}(void);\n" for i in range(len(calls)))
    compiled(compiler, headers, AROUND + "".join(definitions()) + named + "".join(bodies), "-c")


def test_two_lines_become_one_by_their_means(compiler, headers):
    """YUYV with loud chroma, and grayscale; oracle: NumPy's mean of 2 x 2 blocks, halves rounded up."""
    notes = "\nuint8_t noted[LOBULA_HEIGHT * LOBULA_WIDTH];\nint lines;\n"
    notes += "int lobula_push_row(lobula_state *s, const uint8_t *row) {\n    (void)s;\n"
    notes += "    memcpy(noted + LOBULA_WIDTH * lines, row, LOBULA_WIDTH);\n    return ++lines;\n}\n"
    way_in = "void a_line(int number, const uint8_t *bytes, int step) { camera_line(0, number, bytes, step); }\n"
    text = AROUND + notes + "".join(definitions()) + "void a_line(int, const uint8_t *, int);\n" + way_in
    compiled(compiler, headers, text, "-shared", "-fPIC", "-o", "page.so")
    library = ctypes.CDLL(str(headers / "page.so"))
    picture = np.random.default_rng(5).integers(0, 256, (2 * HEIGHT, 2 * WIDTH)).astype(np.uint8)
    means = (picture.reshape(HEIGHT, 2, WIDTH, 2).sum(axis=(1, 3), dtype=int) + 2) // 4
    yuyv = np.full((2 * HEIGHT, 2 * WIDTH, 2), 255, np.uint8)
    yuyv[..., 0] = picture
    for source, step in ((picture, 1), (yuyv, 2)):
        ctypes.c_int.in_dll(library, "lines").value = 0
        for number, row in enumerate(source):
            library.a_line(number, row.tobytes(), step)
        assert ctypes.c_int.in_dll(library, "lines").value == HEIGHT
        noted = np.ctypeslib.as_array((ctypes.c_uint8 * (WIDTH * HEIGHT)).in_dll(library, "noted"))
        assert noted.reshape(HEIGHT, WIDTH).tolist() == means.tolist()


def test_the_table_of_sizes():
    text = PAGE.read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+)x(\d+) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", text, re.MULTILINE)
    assert len(rows) >= 4
    for width, height, *said in rows:
        sizes = [state_bytes(preset(name), int(width), int(height)) for name in ("paper", "published", "lobula")]
        assert [float(number) for number in said] == [math.ceil(size / 102.4) / 10 for size in sizes], width


def test_its_refusal_is_what_the_command_says(capsys, monkeypatch, tmp_path):
    from lobula.cli import main

    found = re.search(r"^\$ lobula (export c .*)\n(lobula: .*)$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert found
    monkeypatch.chdir(tmp_path)
    assert main(found[1].split()) == 2
    assert capsys.readouterr().err.strip() == found[2]
