"""The stroke font and the canvas."""

import numpy as np
import pytest

from lobula.report.canvas import border, box, label, mix, rgb, text
from lobula.report.font import text_mask

WHITE, BLACK = (255, 255, 255), (0, 0, 0)


def test_a_capital_i_is_one_upright_stroke() -> None:
    mask = text_mask("I", 24.0)  # 4 pixels a grid unit: pen 3.6 wide, from row 4 to row 28
    upright = mask[8:24]
    assert np.allclose(upright, upright[0])
    assert upright[0].sum() == pytest.approx(3.6, abs=0.1)
    inked = np.flatnonzero(mask.max(axis=1) > 0.5)
    assert (inked[0], inked[-1]) == (pytest.approx(2, abs=1), pytest.approx(29, abs=1))


def test_an_l_turns_right_at_the_foot() -> None:
    mask = text_mask("L", 24.0)
    assert mask[6:20, mask.shape[1] // 2 :].max() == 0
    assert mask[28, mask.shape[1] // 2] == 1


def test_ink_is_between_none_and_all() -> None:
    mask = text_mask("The quick brown fox: 0123456789 -+=.,/%()_<>!?'|#~", 11.0)
    assert 0 <= mask.min() < mask.max() <= 1
    assert mask.dtype == np.float32


def test_digits_line_up() -> None:
    assert len({text_mask(digit, 12.0).shape for digit in "0123456789"}) == 1


def test_all_letters_differ() -> None:
    letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-+=.,:/%()_<>!?'|#"
    drawn = {(m.shape, m.tobytes()) for m in (text_mask(letter, 12.0) for letter in letters)}
    assert len(drawn) == len(letters) - 1  # O and 0 are the same letter here


def test_text_is_aligned() -> None:
    for align, columns in (("left", (100, 200)), ("right", (0, 100)), ("middle", (40, 160))):
        canvas = np.zeros((40, 200, 3), np.uint8)
        text(canvas, "WARM", 10, 100, WHITE, BLACK, align=align)
        inked = np.flatnonzero(canvas.any(axis=(0, 2)))
        assert columns[0] <= inked[0] < inked[-1] < columns[1]
        assert set(np.flatnonzero(canvas.any(axis=(1, 2)))) <= set(range(8, 24))


@pytest.mark.parametrize(("row", "column"), [(-5, -20), (36, 190), (500, 500), (0, -500)])
def test_what_falls_outside_is_cut_off(row: int, column: int) -> None:
    canvas = np.zeros((40, 200, 3), np.uint8)
    text(canvas, "WARMING UP", row, column, WHITE, BLACK)
    box(canvas, row, column, 10, 10, WHITE)
    label(canvas, "flash", row, column, BLACK, WHITE)


def test_border_and_mix() -> None:
    canvas = np.zeros((20, 30, 3), np.uint8)
    border(canvas, 3, WHITE)
    assert canvas.all(axis=2).sum() == 20 * 30 - 14 * 24
    assert mix((0, 100, 200), (100, 100, 0), 0.5) == (50, 100, 100)
    assert rgb("#ff8000") == (255, 128, 0)
