"""``lobula plot``: a saved trace as a figure."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from . import options as o
from .call import new_app

app = new_app()


@app.command()
def plot(
    trace: Annotated[Path, typer.Argument(metavar="TRACE", help="a .csv, .jsonl, .npz or .parquet trace")],
    out: Annotated[Path | None, typer.Option(
        metavar="FILE", help=".png, .svg or .pdf; beside the trace as .png if left out")] = None,
    json: o.Json = False,
) -> None:
    """Draw the four potentials, their thresholds and spikes, the collisions and the states of TRACE."""
    from ..report.plots import plot_trace, save_figure
    from ..report.trace_file import read_about, read_trace
    from ..runtime.events import collisions_of
    from .print_json import print_json
    from .progress import say

    rows = read_trace(trace)
    figure = plot_trace(rows, {"source": trace.name, **read_about(trace)})
    path = save_figure(figure, out or trace.with_suffix(".png"))
    collisions = [{"id": c.id, "frame": c.start_frame, "time_s": c.start_s} for c in collisions_of(rows)]
    if json:
        print_json({"trace": str(trace), "figure": str(path), "frames": len(rows), "collisions": collisions})
    else:
        say(f"{path}: {len(rows)} frames, {len(collisions)} collisions")
