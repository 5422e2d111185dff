"""What a C compiler makes of an expression, by hand and by a compiler."""

import subprocess

import pytest

from lobula.export.constants import constant

EXPRESSIONS = {
    "7 + 2 * 3 - 1": 12,
    "(7 + 2) * 3 / 2": 13,
    "100 - 7 - 3": 90,
    "24 / 4 / 2": 3,
    "3 > 2 ? 10 : 20": 10,
    "1 == 2 || 3 <= 3": 1,
    "1 && 0 || 0": 0,
    "!0 + !5": 1,
    "(1 > 2) + (3 > 2) * 4": 4,
    "0 ? 1 : 0 ? 2 : 3": 3,
    "(int)200.7f * 10 / (int)33.4f": 60,
    "(int)1e+02f": 100,
    "TWICE(4) + LARGER(2 + 3, TWICE(2)) /* 8 + 5 */": 13,
    "LARGER(WIDE ? 6 : 7, NARROW)": 6,
}
AROUND = """#define TWICE(x) (2 * (x))
#define LARGER(a, b) \\
    ((a) > (b) ? (a) : (b))
#define WIDE 1 /* a comment
over two lines */
#define NARROW (WIDE - 1)
"""


@pytest.mark.parametrize("text", EXPRESSIONS)
def test_by_hand(text):
    assert constant("ASKED", f"{AROUND}#define ASKED {text}\n") == EXPRESSIONS[text]


def test_a_compiler_agrees(compiler, tmp_path):
    asked = "".join(f'    printf("%d\\n", (int)({text}));\n' for text in EXPRESSIONS)
    program = f"#include <stdio.h>\n{AROUND}int main(void) {{\n{asked}    return 0;\n}}\n"
    (tmp_path / "ask.c").write_text(program)
    subprocess.run([compiler, "-w", "-std=c99", "ask.c", "-o", "ask"], cwd=tmp_path, check=True)
    said = subprocess.run([tmp_path / "ask"], capture_output=True, text=True, check=True).stdout.split()
    assert [int(number) for number in said] == list(EXPRESSIONS.values())
