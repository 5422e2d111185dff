"""What is said of memory is what a C compiler makes of it, and what is said to fit is the largest that does."""

import subprocess

import pytest

from lobula.errors import ParameterError
from lobula.export import STACK, c_folder, largest_size, require_ram, state_bytes
from lobula.model.presets import preset
from lobula.params import with_settings

SETTINGS = {
    "paper": preset("paper"),
    "published": preset("published"),
    "lobula": preset("lobula"),
    "no DoG, no FDSR": with_settings(
        preset(), {"lamina": {"dog": {"enabled": False}, "fdsr": {"enabled": False}}}, "test"),
    "both layers": with_settings(
        preset("published"), {"lgmd2": {"reads": "lamina", "neighbour_px": 3}, "decision": {"window_ms": 1000.0},
                              "clock": {"period_ms": 5.0}}, "test"),
    "large kernels": with_settings(
        preset(), {"lamina": {"dog": {"radius_px": 9, "surround": 4}}, "lgmd1": {"neighbour_px": 32},
                   "lptc": {"emd": {"spans_px": [64], "delays_ms": [40.0]}}}, "test"),
}  # fmt: skip
SIZES = [(32, 24), (61, 47), (99, 72), (160, 120)]


@pytest.mark.parametrize("name", SETTINGS)
def test_a_compiler_finds_the_same_size(name, compiler, tmp_path):
    (tmp_path / "size.c").write_text(
        '#include <stdio.h>\n#include "lobula.h"\n'
        'int main(void) { printf("%lu", (unsigned long)sizeof(lobula_state)); return 0; }\n'
    )
    for width, height in SIZES:
        for file, text in c_folder(SETTINGS[name], "default", width, height, "lobula export c").items():
            if file.endswith(".h"):
                (tmp_path / file).write_text(text, encoding="utf-8")
        subprocess.run([compiler, "-std=c99", "size.c", "-o", "size"], cwd=tmp_path, check=True)
        printed = subprocess.run([tmp_path / "size"], capture_output=True, text=True, check=True).stdout
        assert int(printed) == state_bytes(SETTINGS[name], width, height), (width, height)


def test_the_papers_picture_fits_the_papers_robot():
    for name in ("paper", "published", "lobula"):
        require_ram(preset(name), 99, 72, 192)  # of its 256 KB


def test_the_stack_counts():
    bytes_alone = state_bytes(preset(), 99, 72)
    require_ram(preset(), 99, 72, (bytes_alone + STACK) / 1024)
    with pytest.raises(ParameterError, match=r"99 x 72 px need .* settings, 2\.5 KiB of stack among it: "):
        require_ram(preset(), 99, 72, (bytes_alone + STACK - 1) / 1024)


@pytest.mark.parametrize("shape", [(320, 240), (99, 72), (400, 100), (64, 64)])
@pytest.mark.parametrize("ram_kib", [60, 100.5, 192, 1000])
def test_the_largest_that_fits_fits_and_the_next_does_not(shape, ram_kib):
    params, ratio = preset(), shape[1] / shape[0]
    found = largest_size(params, *shape, ram_kib)
    width, height = found or (31, 0)
    if found:
        assert height == round(width * ratio) >= 24
        assert state_bytes(params, width, height) + STACK <= 1024 * ram_kib
    wider = next(w for w in range(width + 1, 1000) if round(w * ratio) >= 24)
    assert wider > shape[0] or state_bytes(params, wider, round(wider * ratio)) + STACK > 1024 * ram_kib


def test_no_size_of_a_shape_that_is_too_flat():
    with pytest.raises(
        ParameterError, match=r"none of this shape fits; the least there is, 32 x 24, needs \d+\.\d KiB$"
    ):
        require_ram(preset(), 2000, 24, 30)
