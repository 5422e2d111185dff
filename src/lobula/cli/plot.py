"""``lobula plot``: a saved trace as a figure."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import ParameterError
from . import options as o
from .call import new_app

app = new_app()


@app.command()
def plot(
    trace: Annotated[Path, typer.Argument(metavar="TRACE", help="a .csv, .jsonl, .npz or .parquet trace")],
    out: Annotated[
        Path | None, typer.Option(metavar="FILE", help=".png, .svg or .pdf; beside the trace as .png if left out")
    ] = None,
    json: o.Json = False,
) -> None:
    """Draw the four potentials, their thresholds and spikes, the collisions and the states of TRACE."""
    from ..report.plots import plot_trace, save_figure
    from ..report.trace_file import read_about, read_trace
    from ..runtime.events import collisions_of
    from .counted import counted
    from .destinations import check_files
    from .print_json import print_json
    from .progress import say

    if trace.is_dir():
        raise ParameterError(f"trace {trace}: is a folder, must be a file")
    figure_path = out or trace.with_suffix(".png")
    check_files({"--out": figure_path}, {"trace": trace})
    rows = read_trace(trace)
    if len(rows) == 0:
        raise ParameterError(f"trace {trace}: has no rows: nothing to draw")
    figure = plot_trace(rows, {"source": trace.name, **read_about(trace)})
    path = save_figure(figure, figure_path)
    collisions = [{"id": c.id, "frame": c.start_frame, "time_s": c.start_s} for c in collisions_of(rows)]
    if json:
        print_json({"trace": str(trace), "figure": str(path), "frames": len(rows), "collisions": collisions})
    else:
        say(f"{path}: {counted(len(rows), 'frame')}, {counted(len(collisions), 'collision')}")
