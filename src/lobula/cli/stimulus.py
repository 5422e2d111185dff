"""``lobula stimulus``: a synthetic movie written as a clip, its truth beside it."""

from __future__ import annotations

import json as js
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import OutputError, ParameterError
from . import options as o
from .call import new_app

if TYPE_CHECKING:
    from ..stimuli import Movie

app = new_app()


@app.command()
def stimulus(
    name: Annotated[str | None, typer.Argument(metavar="NAME", help="kind of movie, see --list")] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help=".mp4 or .mkv (H.264 without loss), .npz, or a folder for .png; NAME.mp4 if left out"
        ),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="NAME=VALUE", help="one setting of the movie, such as speed_cm_s=8; may be repeated"
        ),
    ] = None,
    show_list: Annotated[bool, typer.Option("--list", help="the kinds of movie, or the settings of NAME")] = False,
    json: o.Json = False,
) -> None:
    """Write a synthetic movie as a clip, and beside it a .json with what is true of it: kind, contact, settings."""
    from ..stimuli import CATALOGUE, keywords
    from .counted import counted
    from .print_json import print_json
    from .progress import say
    from .table import table

    if show_list and name is None:
        kinds = {kind: _first_line(make) for kind, make in CATALOGUE.items()}
        print_json(kinds) if json else print(table(("name", "what it is"), list(kinds.items())))
        return
    if name is None:
        raise ParameterError(f"stimulus: no name: must be one of {', '.join(CATALOGUE)}")
    known = keywords(name)
    if show_list:
        rows = [(keyword, "" if value is None else js.dumps(value)) for keyword, value in known.items()]
        print_json(_finite(known)) if json else print(table(("setting", "default"), rows))
        return
    path = out or Path(f"{name}.mp4")
    _check_out(path)
    movie = CATALOGUE[name](**_chosen(settings or (), known, name))
    truth_path = _write(movie, path)
    if json:
        print_json({"clip": str(path), "truth": str(truth_path), **_truth(movie)})
    else:
        contact = "nothing comes" if movie.contact_s is None else f"contact at {movie.contact_s:.3f} s"
        frames = counted(len(movie), "frame")
        say(f"{path}: {movie.kind}, {frames} at {movie.rate_hz:g} Hz, {contact}; truth in {truth_path}")


def _check_out(path: Path) -> None:
    from .destinations import check_files, check_folder

    if path.suffix:
        check_files({"--out": path, "the truth of --out": path.with_suffix(".json")})
    else:
        check_folder("--out", path)


def _first_line(make: Any) -> str:
    """The first sentence of a movie's docstring; a kind made by fixing a keyword is described by its function's."""
    line = (getattr(make, "func", make).__doc__ or "").partition("\n")[0]
    return line.partition(". ")[0].removeprefix("Return ").rstrip(".").replace("``", "")


def _chosen(settings: Any, known: dict[str, Any], name: str) -> dict[str, Any]:
    from ..params import nearest

    chosen = {}
    for text in settings:
        keyword, equals, raw = text.partition("=")
        if not equals or not raw:
            raise ParameterError(f"--set {text!r}: must be NAME=VALUE, such as speed_cm_s=8")
        if keyword not in known:
            raise ParameterError(f"stimulus {name}: unknown setting {keyword}{nearest(keyword, known)}")
        try:
            chosen[keyword] = js.loads(raw)
        except js.JSONDecodeError:
            chosen[keyword] = raw
    return chosen


def _write(movie: Movie, path: Path) -> Path:
    """Write the movie and its truth; return where the truth is."""
    kind = path.suffix.lower()
    if kind in (".mp4", ".mkv"):
        from ..report.grey_clip import write_grey_clip

        write_grey_clip(path, movie.images, movie.times_s.tolist(), movie.rate_hz, js.dumps(_truth(movie)))
    elif kind == ".npz":
        _write_npz(movie, path)
    elif kind == "":
        _write_folder(movie, path)
    else:
        raise ParameterError(f"--out {path}: must end in .mp4, .mkv or .npz, or be a folder")
    truth_path = path / "truth.json" if kind == "" else path.with_suffix(".json")
    _write_text(truth_path, js.dumps(_truth(movie), indent=2) + "\n")
    return truth_path


def _write_npz(movie: Movie, path: Path) -> None:
    import numpy as np

    from ..landing import whole_file

    with whole_file(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, images=movie.images, times_s=movie.times_s, truth=np.array(js.dumps(_truth(movie))))


def _write_folder(movie: Movie, folder: Path) -> None:
    """Write one PNG for each picture, and ``times.csv``, which gives ``lobula run`` their stamps."""
    import numpy as np

    from ..landing import writing
    from ..report.png import write_png

    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    lines = ["file,time_s"]
    for index, (image, time_s) in enumerate(zip(movie.images, movie.times_s.tolist(), strict=True)):
        write_png(folder / f"frame{index:05d}.png", np.rint(image).astype(np.uint8))
        lines.append(f"frame{index:05d}.png,{time_s!r}")
    _write_text(folder / "times.csv", "\n".join(lines) + "\n")


def _write_text(path: Path, text: str) -> None:
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise OutputError(f"cannot write {path}: {error.strerror}") from error


def _truth(movie: Movie) -> dict[str, Any]:
    height, width = movie.images.shape[1:]
    contact_frame = None if movie.contact_s is None else round(movie.contact_s * movie.rate_hz)
    return {
        "kind": movie.kind,
        "contact_s": movie.contact_s,
        "contact_frame": contact_frame,
        "rate_hz": movie.rate_hz,
        "frames": len(movie),
        "width": width,
        "height": height,
        "settings": _finite(movie.settings),
    }


def _finite(settings: Any) -> dict[str, Any]:
    """Copy settings for JSON, which knows no infinity: "for ever" becomes null."""
    return {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in settings.items()}
