"""``lobula config``: every setting and where it comes from; settings files made and checked."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import OutputError, ParameterError
from . import options as o
from .call import new_app

app = new_app("Show every setting and its origin; make or check a settings file.")


@app.command()
def show(
    json: o.Json = False,
    toml: Annotated[bool, typer.Option("--toml", help="a settings file, on standard output")] = False,
    preset: o.Preset = None,
    neurons: o.Neurons = None,
    config: o.Config = None,
    settings: o.Settings = None,
    sensitivity: o.Sensitivity = None,
) -> None:
    """Print every setting: value, unit, allowed range, meaning and origin."""
    from ..params import settings_hash
    from ..runtime.header import setting_rows
    from .print_json import print_json
    from .settings import choose
    from .settings_file import allowed_values, settings_toml, toml_value
    from .table import table

    if json and toml:
        raise ParameterError("--json and --toml: only one of them may be given")
    chosen = choose(preset, neurons, config, settings or (), sensitivity)
    rows = setting_rows(chosen.params)
    if json:
        print_json({"preset": chosen.preset, "settings_hash": settings_hash(chosen.params), "settings": rows})
    elif toml:
        print(settings_toml(rows, chosen.preset), end="")
    else:
        cells = [(r["path"], toml_value(r["value"]), allowed_values(r), r["meaning"], r["source"]) for r in rows]
        print(table(("setting", "value", "allowed", "meaning", "source"), cells, right="value"))
        print(f"\npreset {chosen.preset}, settings {settings_hash(chosen.params)}")


@app.command()
def init(
    file: Annotated[Path, typer.Argument(metavar="[FILE]", help="what to write")] = Path("lobula.toml"),
    force: Annotated[bool, typer.Option("--force", help="replace a file that is there")] = False,
    preset: o.Preset = None,
    json: o.Json = False,
) -> None:
    """Write a settings file with every setting of a preset, its unit, range, meaning and origin beside it."""
    from ..params import settings_hash
    from ..runtime.header import setting_rows
    from .destinations import check_files
    from .print_json import print_json
    from .progress import say
    from .settings import choose
    from .settings_file import settings_toml

    chosen = choose(preset)
    text = settings_toml(setting_rows(chosen.params), chosen.preset)
    if file.suffix.lower() != ".toml":
        raise ParameterError(f"settings file {file}: must end in .toml")
    check_files({"settings file": file})
    try:
        with file.open("w" if force else "x", encoding="utf-8") as out:
            out.write(text)
    except FileExistsError as error:
        raise ParameterError(f"settings file {file}: is there already; --force replaces it") from error
    except OSError as error:
        raise OutputError(f"cannot write {file}: {error.strerror}") from error
    if json:
        print_json({"file": str(file), "preset": chosen.preset, "settings_hash": settings_hash(chosen.params)})
    else:
        say(f"{file}: preset {chosen.preset}, settings {settings_hash(chosen.params)}")


@app.command()
def validate(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="settings file to check")],
    json: o.Json = False,
) -> None:
    """Check a settings file: unknown names, wrong kinds and values out of range are refused with one line."""
    from ..params import settings_hash, walk
    from .print_json import print_json
    from .progress import say
    from .settings import choose

    chosen = choose(config=file)
    plain = choose(chosen.preset)
    was = {path: getattr(owner, name) for path, owner, name in walk(plain.params)}
    now = {path: getattr(owner, name) for path, owner, name in walk(chosen.params)}
    changed = {path: value for path, value in now.items() if value != was[path]}
    if json:
        print_json(
            {
                "file": str(file),
                "valid": True,
                "preset": chosen.preset,
                "settings_hash": settings_hash(chosen.params),
                "changed": changed,
            }
        )
        return
    say(f"{file}: valid; preset {chosen.preset}, settings {settings_hash(chosen.params)}")
    for path, value in changed.items():
        say(f"  {path} = {value} (preset: {was[path]})")
