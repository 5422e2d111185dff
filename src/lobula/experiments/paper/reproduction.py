"""Runs figures of the paper and writes what was found into a folder.

For each one: FIGURE.png and FIGURE.svg (one more pair for every further preset), FIGURE.csv with every trial, FIGURE.md
for people, FIGURE.json for programs; and paper.md, which gathers all that lies in the folder.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ...errors import ParameterError
from ...landing import whole_file, writing
from ...report.plots import save_figure
from . import fig4, fig5, fig6
from .claims import judged
from .figure import PaperFigure, Plan, run
from .pages import Document, as_text, document, figure_page, gathered_page
from .trials import as_csv

FIGURES: Mapping[str, PaperFigure] = {figure.name: figure for figure in (fig4.FIGURE, fig5.FIGURE, fig6.FIGURE)}
"""What can be reproduced, in the order of the paper."""

ORDER = (*FIGURES, "table1")
"""The order of ``paper.md``."""

FIRST_SEED = 201
"""Seeds below were used while set-ups and rules were chosen, or are left to calibration."""


def seeds(count: int) -> range:
    """Return the seeds of ``count`` repeats.

    Raises
    ------
    ParameterError : not 1 to 500
    """
    if not 1 <= count <= 500:
        raise ParameterError(f"--seeds {count}: must be 1 to 500")
    return range(FIRST_SEED, FIRST_SEED + count)


def reproduce(
    figure: PaperFigure, plan: Plan, folder: Path, advance: Callable[[], None] | None = None
) -> dict[str, Any]:
    """Run ``figure``, write its files into ``folder`` and return its document; ``advance`` is called film by film.

    Raises
    ------
    OutputError : a file cannot be written
    """
    trials = run(figure, plan, advance)
    _write(folder / f"{figure.name}.csv", as_csv(trials))
    found = document(figure, plan, list(judged(figure.claims, trials)), trials[0].scene_hash)
    _write(folder / f"{figure.name}.json", json.dumps(found, indent=1, allow_nan=False) + "\n")
    pictures = {}
    for number, preset in enumerate(plan.presets):
        drawing = figure.draw(plan, trials, preset)
        name = f"{figure.name}-{preset}" if number else figure.name
        for suffix in (".svg", ".png"):
            save_figure(drawing, folder / f"{name}{suffix}")
        pictures[preset] = f"{name}.png"
    _write(folder / f"{figure.name}.md", as_text(figure_page(figure, plan, trials, found, pictures)))
    gather(folder)
    return found


def gather(folder: Path) -> None:
    """Write ``paper.md`` from all the documents in ``folder``."""
    _write(folder / "paper.md", as_text(gathered_page(documents(folder))))


def documents(folder: Path) -> list[Document]:
    """Return what lies in ``folder`` of the figures and tables, in the order of the paper."""
    paths = (folder / f"{name}.json" for name in ORDER)
    return [json.loads(path.read_text(encoding="utf-8")) for path in paths if path.exists()]


def publish(folder: Path, docs: Path) -> None:
    """Put what lies in ``folder`` into ``docs``: ``paper.md``, and the pages and PNGs below ``docs/paper``."""
    found = documents(folder)
    details = docs / "paper"
    with writing(details):
        details.mkdir(parents=True, exist_ok=True)
        for one in found:
            for path in (folder / f"{one['figure']}.md", *sorted(folder.glob(f"{one['figure']}*.png"))):
                shutil.copyfile(path, details / path.name)
    _write(docs / "paper.md", as_text(gathered_page(found, "paper/")))


def _write(path: Path, text: str) -> None:
    with whole_file(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
