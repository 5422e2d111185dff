"""docs/presets.md holds what the presets hold, and docs/sources.md explains every origin in it."""

from __future__ import annotations

import re
import runpy

from lobula.model.presets import NEURONS, PRESETS, preset
from lobula.params import walk

from .pages import ROOT


def test_the_table_is_current() -> None:
    page = runpy.run_path(str(ROOT / "docs" / "make_presets.py"))["page"]
    assert page(_page("presets")) == _page("presets"), "run python docs/make_presets.py"


def test_the_table_has_every_setting_once() -> None:
    rows = re.findall(r"^\| `([a-z0-9_.]+\.[a-z0-9_]+)` \|", _page("presets"), re.MULTILINE)
    assert sorted(rows) == sorted(path for path, _, _ in walk(preset()))


def test_the_page_names_every_preset_and_every_choice_of_neurons() -> None:
    assert all(f"- **`{name}`**: " in _page("presets") for name in PRESETS)
    assert all(f"`{name}`" in _page("presets") for name in NEURONS)


def test_the_table_has_a_column_for_every_preset() -> None:
    (head,) = re.findall(r"^\| setting \|(.*)\|$", _page("presets"), re.MULTILINE)
    assert {title.split("`")[1] for title in head.split("|")[: len(PRESETS)]} == set(PRESETS)


def test_the_table_says_who_hears_the_patches_and_where_the_change_saturates() -> None:
    (patches,) = re.findall(r"^\| \*\*Coarse patches.*$", _page("presets"), re.MULTILINE)
    (limit,) = re.findall(r"^\| \*\*Retina: saturation.*$", _page("presets"), re.MULTILINE)
    assert patches.count("**off**") == limit.count("**off**") == 2  # the paper's two presets
    assert "**on, heard by LGMD-2**" in patches
    assert limit.count("**on**") == 1


def test_every_origin_is_explained() -> None:
    origins = {owner.source_of(name) for base in PRESETS for _, owner, name in walk(preset(base))}
    for origin in origins:
        kind, _, rest = origin.partition(":")
        if kind in ("published code", "re-implementation"):
            assert f"`{rest.split(',')[0].strip()}`" in _page("sources"), origin
        else:
            assert kind.split()[0] in ("paper", "chosen", "calibrated"), origin


def _page(name: str) -> str:
    return (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")
