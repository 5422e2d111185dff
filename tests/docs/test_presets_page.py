"""docs/presets.md holds what the presets hold, and docs/sources.md explains every origin in it."""

from __future__ import annotations

import re
import runpy

from lobula.model.presets import BASES, NEURONS, preset
from lobula.params import walk

from .pages import ROOT


def test_the_table_is_current() -> None:
    page = runpy.run_path(str(ROOT / "docs" / "make_presets.py"))["page"]
    assert page(_page("presets")) == _page("presets"), "run python docs/make_presets.py"


def test_the_table_has_every_setting_once() -> None:
    rows = re.findall(r"^\| `([a-z0-9_.]+\.[a-z0-9_]+)` \|", _page("presets"), re.MULTILINE)
    assert sorted(rows) == sorted(path for path, _, _ in walk(preset()))


def test_the_page_names_every_base_and_every_choice_of_neurons() -> None:
    assert all(f"`{name}`" in _page("presets") for name in (*BASES, *NEURONS))


def test_every_origin_is_explained() -> None:
    origins = {owner.source_of(name) for base in BASES for _, owner, name in walk(preset(base))}
    for origin in origins:
        kind, _, rest = origin.partition(":")
        if kind in ("published code", "re-implementation"):
            assert f"`{rest.split(',')[0].strip()}`" in _page("sources"), origin
        else:
            assert kind.split()[0] in ("paper", "chosen", "calibrated"), origin


def _page(name: str) -> str:
    return (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")
