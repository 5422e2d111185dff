"""Results as Markdown: the machine, the figures, and the times they were made of.

    python benchmarks/report.py results.json [--into docs/performance.md]

With ``--into``, the text takes the place of what stands between the two marks of that page.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

BEGIN, END = "<!-- figures: begin -->", "<!-- figures: end -->"
MARKS = {True: "yes", False: "**no**", None: ""}
TIMES = {
    "numpy_us": "NumPy+SciPy", "opencv_us": "tuned OpenCV", "opencv folded_us": "OpenCV, the core's algebra",
    "flow_us": "DIS ultrafast flow", "step_us": "core, step", "blocks_us": "core, blocks",
    "noise_us": "core, step, strong noise", "scaled_us": "core, step, scaled kernels",
    "preset paper_us": "core, step, preset paper",
}  # fmt: skip


def markdown(document: Mapping[str, Any]) -> str:
    """Return all three tables."""
    about = ", ".join(f"{key} {_plain(value)}" for key, value in document["machine"].items())
    parts = [
        f"Measured on: {about}; {document['rounds']} rounds{', quick' if document['quick'] else ''}.",
        figures_table(document["figures"]),
    ]
    if times := times_table(document["figures"]):
        parts += ["Microseconds a frame, processor time of one thread, median (best):", times]
    return "\n\n".join(parts) + "\n"


def figures_table(figures: list[Mapping[str, Any]]) -> str:
    """Return one row for each figure, with what it must be and what it aims at."""
    rows = ["| figure | measured | must | reached | aim | reached |", "|---|--:|--:|---|--:|---|"]
    for f in figures:
        limits = ("" if f[limit] is None else f"{f[limit]:g}" for limit in ("must", "aim"))
        must, aim = limits
        rows.append(f"| {f['name']} | {f['value']:.3g} {f['unit']} | {must} | {MARKS[f['must_reached']]} | {aim} | "
                    f"{MARKS[f['aim_reached']]} |")  # fmt: skip
    return "\n".join(rows)


def times_table(figures: list[Mapping[str, Any]]) -> str:
    """Return the time of each contender at each size; empty where no steps were timed."""
    times: dict[str, dict[str, Mapping[str, float]]] = {}
    for f in figures:
        if f["size"]:
            for key in TIMES.keys() & f["details"].keys():
                times.setdefault(key, {})[f["size"]] = f["details"][key]
    sizes = list(dict.fromkeys(size for by_size in times.values() for size in by_size))
    if not sizes:
        return ""
    rows = ["| | " + " | ".join(sizes) + " |", "|---|" + "--:|" * len(sizes)]
    for key, name in TIMES.items():
        cells = (times.get(key, {}).get(size) for size in sizes)
        rows.append(f"| {name} | " + " | ".join(_us(cell) for cell in cells) + " |")
    return "\n".join(rows)


def put_into(page: Path, text: str) -> None:
    """Replace what stands between the marks of ``page``.

    Raises
    ------
    ValueError : the marks are not there
    """
    before, begin, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise ValueError(f"{page}: must hold {BEGIN} and {END}")
    page.write_text(f"{before}{BEGIN}\n\n{text}\n{END}{after}", encoding="utf-8")


def _plain(value: Any) -> str:
    return " ".join(map(str, value)) if isinstance(value, list) else str(value)


def _us(time: Mapping[str, float] | None) -> str:
    if time is None:
        return ""
    median, best = (f"{time[key]:,.0f}" if time[key] >= 100 else f"{time[key]:.1f}" for key in ("median", "best"))
    return f"{median} ({best})"


def main() -> None:
    """Print the tables, or put them into a page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=Path)
    parser.add_argument("--into", type=Path)
    options = parser.parse_args()
    text = markdown(json.loads(options.results.read_text(encoding="utf-8")))
    if options.into:
        put_into(options.into, text)
    else:
        print(text)


if __name__ == "__main__":
    main()
