"""docs/cli.md and the verbs name the same options, and no page names a verb or an option that is not there."""

from __future__ import annotations

import json
import re
from importlib import import_module
from typing import Any

import pytest
import typer

from lobula.cli import VERBS
from lobula.model.presets import preset
from lobula.params import with_settings
from lobula.runtime.ndjson import HEADER_KEYS
from lobula.types import TRACE_DTYPE

from .pages import PAGES, ROOT, blocks, sections

PAGE = ROOT / "docs" / "cli.md"
SHARED = "Settings of the network"


def command(verb: str) -> Any:
    return typer.main.get_command(import_module(f"lobula.cli.{verb}").app)


def options(verb: str) -> set[str]:
    top = command(verb)
    commands = [top, *getattr(top, "commands", {}).values()]
    return {name for c in commands for p in c.params for name in p.opts if name.startswith("--")} - {"--help"}


@pytest.mark.parametrize("verb", VERBS)
def test_the_section_of_a_verb_names_all_its_options_and_no_others(verb: str) -> None:
    parts = sections(PAGE)
    own = set(re.findall(r"--[a-z][a-z-]*", parts[f"lobula {verb}"]))
    shared = set(re.findall(r"--[a-z][a-z-]*", parts[SHARED]))
    assert options(verb) <= own | shared
    assert own <= options(verb)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_on_the_pages_exist(page: Any) -> None:
    for verb, rest in re.findall(r"(?:^|[`\s])lobula ([a-z]+)((?: [^`\n#]*)?)(?=[`\n#])", _code(page)):
        assert verb in VERBS, f"lobula {verb}"
        given = set(re.findall(r"(?<!\S)--[a-z][a-z-]*", rest))
        assert given <= options(verb) | {"--help"}, f"lobula {verb}{rest}"


def _code(page: Any) -> str:
    """Everything on the page that is set as code."""
    text = page.read_text(encoding="utf-8")
    fenced = "\n".join(re.findall(r"^```[a-z]*\n(.*?)^```$", text, re.MULTILINE | re.DOTALL))
    inline = re.findall(r"`[^`\n]+`", re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL))
    return fenced + "\n" + "\n".join(inline) + "\n"


def test_the_example_records_have_the_fields_that_are_written() -> None:
    (text,) = blocks(PAGE, "json")
    records = [json.loads(line) for line in text.splitlines()]
    assert tuple(records[0]) == HEADER_KEYS
    table = sections(PAGE)["lobula run"]
    for record in records:
        assert not [name for name in record if name != "type" and not re.search(rf"`{name}`|{name}", table)]


def test_the_columns_are_those_of_a_trace() -> None:
    assert ",".join(TRACE_DTYPE.names or ()) in PAGE.read_text(encoding="utf-8")


def test_the_settings_file_on_the_page_is_valid() -> None:
    import tomllib

    (text,) = blocks(PAGE, "toml")
    settings = tomllib.loads(text)
    with_settings(preset(settings.pop("preset")), settings, "page")
