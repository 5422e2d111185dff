import pytest
from figures.figure import Figure
from report import BEGIN, END, markdown, put_into

US = {"median": 1234.5, "best": 99.94}


def document(*figures):
    return {"machine": {"processor": "P", "isas": ["a", "b"]}, "rounds": 7, "quick": False,
            "figures": [f.as_dict() for f in figures]}  # fmt: skip


def test_tables_say_what_was_reached_and_what_was_not():
    text = markdown(document(
        Figure("fast, 99x72", 31.0, "x", 30, 50, details={"step_us": US}, size="99x72"),
        Figure("told", 0.5, "s", better="less"),
    ))  # fmt: skip
    assert "| fast, 99x72 | 31 x | 30 | yes | 50 | **no** |" in text
    assert "| told | 0.5 s |  |  |  |  |" in text
    assert "| core, step | 1,234 (99.9) |" in text
    assert "processor P, isas a b; 7 rounds." in text


def test_a_page_keeps_what_stands_around_the_figures(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(f"before\n{BEGIN}\nold\n{END}\nafter\n")
    put_into(page, "new\n")
    put_into(page, "newer\n")
    assert page.read_text() == f"before\n{BEGIN}\n\nnewer\n\n{END}\nafter\n"
    page.write_text("no marks")
    with pytest.raises(ValueError, match="must hold"):
        put_into(page, "new")
