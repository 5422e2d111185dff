"""Every setting is in the header once, with its value, unit and origin, and a C compiler reads the same numbers."""

import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lobula.export.config_header import config_header
from lobula.model.presets import NAMES, preset
from lobula.params import settings_hash, walk, with_settings

DEFINE = re.compile(r"^#define (LOBULA_\w+) (.+?)(?: /\* (.*) \*/)?$", re.MULTILINE)
NOT_IN_C = {"decision.turning_deg_s"}


def macros(header: str) -> dict[str, tuple[str, str]]:
    """Name -> what it stands for and its comment, as text."""
    found = DEFINE.findall(header)
    assert len({name for name, *_ in found}) == len(found)
    return {name: (value, comment) for name, value, comment in found}


def settings(params: Any) -> dict[str, Any]:
    return {path: getattr(owner, name) for path, owner, name in walk(params) if path not in NOT_IN_C}


def macro(path: str) -> str:
    return "LOBULA_" + path.replace(".", "_").upper()


def as_c(value: Any, choices: tuple[str, ...] | None) -> str:
    if choices:
        return str(choices.index(value))
    if isinstance(value, tuple):
        return "{" + ", ".join(as_c(item, None) for item in value) + "}"
    return f"{value}f" if isinstance(value, float) else str(int(value))


@pytest.mark.parametrize("name", NAMES)
def test_every_setting_is_there_with_its_value_meaning_and_origin(name):
    params = preset(name)
    found = macros(config_header(params, name, 99, 72))
    for path, owner, field in walk(params):
        if path in NOT_IN_C:
            assert macro(path) not in found
            continue
        about = type(owner).__dataclass_fields__[field].metadata
        value, comment = found.pop(macro(path))
        assert value == as_c(getattr(owner, field), about["choices"]), path
        for word in (about["doc"], about["unit"], f"({owner.source_of(field)})"):
            assert word in comment, path
    assert {name: value for name, (value, _) in found.items() if name != "LOBULA_VERSION"} == {
        "LOBULA_PRESET": f'"{name}"', "LOBULA_SETTINGS_HASH": f'"{settings_hash(params)}"', "LOBULA_WIDTH": "99",
        "LOBULA_HEIGHT": "72", "LOBULA_LPTC_EMD_SPANS": "4", "LOBULA_LPTC_EMD_WIDEST_PX": "4",
    }  # fmt: skip


def test_the_numbers_that_the_papers_and_their_code_print():
    """By hand: T_sp, K_sp from the paper; W and delays of LGMD-2, K_hs and delays of the EMDs from published code."""
    found = {
        name: value for name, (value, _) in macros(config_header(preset("published"), "published", 99, 72)).items()
    }
    assert found["LOBULA_LGMD1_SPIKING_THRESHOLD"] == found["LOBULA_LGMD2_SPIKING_THRESHOLD"] == "0.7f"
    assert found["LOBULA_LPTC_SPIKING_THRESHOLD"] == "0.2f"
    assert found["LOBULA_LPTC_SPIKING_GAIN"] == "4.0f"
    assert [found[f"LOBULA_LGMD2_ON_{ring}_WEIGHT"] for ring in ("CENTRE", "NEAREST", "DIAGONAL")] == [
        "2.0f", "0.5f", "0.25f"]  # fmt: skip
    assert [found[f"LOBULA_LGMD2_OFF_{ring}_MS"] for ring in ("CENTRE", "NEAREST", "DIAGONAL")] == [
        "60.0f", "120.0f", "180.0f"]  # fmt: skip
    assert found["LOBULA_LGMD2_CHANGE_MS"] == "90.0f"
    assert found["LOBULA_LPTC_SIGMOID_GREY2"] == "0.01f"
    assert found["LOBULA_LPTC_EMD_DELAYS_MS"] == "{40.0f, 30.0f, 20.0f, 10.0f}"
    assert (found["LOBULA_LGMD1_READS"], found["LOBULA_DECISION_NEURONS"]) == ("0", "0")


def test_the_settings_that_the_cores_own_tests_use_are_the_papers():
    """core/robot/lobula_config.h is no copy of a file that is written, but must not fall behind it."""
    kept = macros((Path(__file__).parents[2] / "core/robot/lobula_config.h").read_text(encoding="utf-8"))
    made = macros(config_header(preset("paper"), "paper", 99, 72))
    assert set(made) - set(kept) <= {"LOBULA_VERSION", "LOBULA_SETTINGS_HASH"}
    assert {name: value for name, (value, _) in kept.items()} == {name: made[name][0] for name in kept}


def test_what_was_set_by_hand_says_so():
    params = with_settings(
        preset("lobula"), {"lptc": {"emd": {"spans_px": [2, 5], "delays_ms": [33, 1e-1]}},
                           "lgmd1": {"reads": "lamina", "sigmoid_grey": 1e-6}}, "file my.toml",
    )  # fmt: skip
    found = macros(config_header(params, "lobula", 64, 48))
    assert found["LOBULA_LPTC_EMD_SPANS"][0] == "2"
    assert found["LOBULA_LPTC_EMD_WIDEST_PX"][0] == "5"
    assert found["LOBULA_LPTC_EMD_DELAYS_MS"] == ("{33.0f, 0.1f}", "delay of each span, ms (file my.toml)")
    assert found["LOBULA_LGMD1_SIGMOID_GREY"][0] == "1e-06f"
    assert found["LOBULA_LGMD1_READS"][0] == "1"
    assert found["LOBULA_LGMD1_READS"][1].startswith("lamina; ")
    assert found["LOBULA_DECISION_NEURONS"][0] == "2"  # all, lgmds, lgmd2


def test_no_origin_ends_a_comment():
    params = with_settings(preset(), {"lgmd1": {"on_gain": 2.0}}, "file */ #error no\n#define LOBULA_WIDTH 3 /* \\")
    header = config_header(params, "default", 99, 72)
    assert macros(header)["LOBULA_LGMD1_ON_GAIN"][1].endswith("(file * / #error no #define LOBULA_WIDTH 3 / * \\)")
    assert header.count("*/") == header.count("/*")


@pytest.mark.parametrize("name", ["paper", "lobula"])
def test_a_compiler_reads_the_same_numbers(name, compiler, tmp_path):
    params = preset(name)
    (tmp_path / "lobula_config.h").write_text(config_header(params, name, 99, 72))
    numbers = {path: value for path, value in settings(params).items() if not isinstance(value, str | tuple)}
    spans = len(params.lptc.emd.spans_px)
    show = "".join(f'    printf("%.9g\\n", (double){macro(path)});\n' for path in numbers)
    program = f"""#include <stdio.h>
#include "lobula_config.h"
int main(void) {{
    static const int spans[LOBULA_LPTC_EMD_SPANS] = LOBULA_LPTC_EMD_SPANS_PX;
    static const float delays[LOBULA_LPTC_EMD_SPANS] = LOBULA_LPTC_EMD_DELAYS_MS;
{show}    for (int i = 0; i < LOBULA_LPTC_EMD_SPANS; i++) printf("%d\\n%.9g\\n", spans[i], (double)delays[i]);
    return 0;
}}
"""
    (tmp_path / "show.c").write_text(program)
    warnings = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror"]
    subprocess.run([compiler, *warnings, "show.c", "-o", "show"], cwd=tmp_path, check=True)
    printed = subprocess.run([tmp_path / "show"], capture_output=True, text=True, check=True).stdout.split()
    pairs = [x for pair in zip(params.lptc.emd.spans_px, params.lptc.emd.delays_ms, strict=True) for x in pair]
    assert len(pairs) == 2 * spans
    assert [np.float32(text) for text in printed] == [np.float32(value) for value in (*numbers.values(), *pairs)]
