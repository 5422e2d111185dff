"""``lobula export``: settings as a folder of C for a robot."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated, Any

import typer

from ..errors import ParameterError
from . import options as o
from .call import new_app

app = new_app("Settings as a folder of C for a robot.")


@app.callback()
def export() -> None:
    """Settings as a folder of C for a robot."""


@app.command()
def c(
    out: Annotated[Path, typer.Option(metavar="DIR", help="a new or empty folder")],
    size: o.Size = "99x72",
    ram: Annotated[float | None, typer.Option(metavar="KIB", help="refuse what needs more memory than this")] = None,
    preset: o.Preset = None,
    neurons: o.Neurons = None,
    config: o.Config = None,
    settings: o.Settings = None,
    sensitivity: o.Sensitivity = None,
    force: Annotated[
        bool, typer.Option("--force", help="write into a folder that holds files; a main.c in it stays as it is")
    ] = False,
    json: o.Json = False,
) -> None:
    """Write a folder that any C99 compiler takes: the core, its settings, an example, a README.

    No heap, no operating system; the size of the picture and all settings are compiled in.
    """
    from ..export import EXAMPLE, c_folder, in_kib, require_ram, state_bytes
    from ..params import settings_hash
    from .print_json import print_json
    from .progress import say
    from .settings import choose

    chosen = choose(preset, neurons, config, settings or (), sensitivity)
    width, height = o.parse_size(size, "--size")
    command = ["lobula", "export", "c", "--out", "DIR", "--size", f"{width}x{height}", "--preset", chosen.preset]
    given = {"--neurons": neurons, "--config": config, "--sensitivity": sensitivity, "--ram": ram}
    command += [word for option, value in given.items() if value is not None for word in (option, _short(value))]
    command += [word for text in settings or () for word in ("--set", text)]
    files = c_folder(chosen.params, chosen.preset, width, height, command=shlex.join(command))
    if ram is not None:
        require_ram(chosen.params, width, height, ram)
    _check_out(out, force)
    kept = (out / EXAMPLE).exists()
    if kept:
        del files[EXAMPLE]
    _write(out, files)
    others = sorted(p.name for p in out.iterdir() if p.suffix in (".c", ".h") and p.name not in (*files, EXAMPLE))
    needed = state_bytes(chosen.params, width, height)
    if json:
        print_json({
            "folder": str(out), "files": sorted(files), "preset": chosen.preset,
            "settings_hash": settings_hash(chosen.params), "width": width, "height": height, "state_bytes": needed,
            "other_sources": others,
        })  # fmt: skip
    else:
        say(
            f"{out}: {len(files)} files, preset {chosen.preset}, {width} x {height} px, {in_kib(needed)} of memory; "
            + (f"{EXAMPLE} is as it was" if kept else f"start with {out / 'README.md'}")
        )
        for name in others:
            say(f"{out / name}: not of this export, left as it is: yours, or of an older lobula and to be removed")


def _short(value: Any) -> str:
    """An option's value as it may be typed; of a file its name."""
    return value.name if isinstance(value, Path) else f"{value:g}" if isinstance(value, float) else str(value)


def _check_out(out: Path, force: bool) -> None:
    from .destinations import check_folder

    check_folder("--out", out)
    if out.is_dir() and any(out.iterdir()) and not force:
        raise ParameterError(f"--out {out}: holds files: must be a new or empty folder; --force writes into it")


def _write(out: Path, files: dict[str, str]) -> None:
    from ..landing import whole_file
    from .destinations import make_folder

    make_folder("--out", out)
    for name, text in files.items():
        with whole_file(out / name) as temporary:
            temporary.write_text(text, encoding="utf-8")
