"""``lobula batch``: many clips on all cores."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import ParameterError
from . import options as o
from .call import new_app

if TYPE_CHECKING:
    from ..batch import Request, Row
    from ..batch.run import Hands

app = new_app()

DONE, FAILED, SOME_FAILED = 0, 3, 4
TRACES = {"csv": ".csv", "npz": ".npz", "parquet": ".parquet", "none": None}


@app.command()
def batch(
    sources: Annotated[
        list[str],
        typer.Argument(
            metavar="DIR|GLOB|LIST.txt...",
            help="folder with videos in it and below, pattern, list of clips one a line, or the clips themselves",
        ),
    ],
    out: Annotated[Path, typer.Option(metavar="OUT", help="folder for traces, events, manifest; made if not there")],
    workers: Annotated[int | None, typer.Option(metavar="N", help="processes; one a core if left out")] = None,
    trace: Annotated[str, typer.Option(metavar="csv|npz|parquet|none", help="each frame's reading")] = "csv",
    annotate: Annotated[
        bool, typer.Option("--annotate", help="a video of each clip with traces and decisions")
    ] = False,
    cluster: Annotated[
        str | None,
        typer.Option(metavar="dask|ADDRESS", help="spread over a Dask cluster: one made here, or tcp://HOST:PORT"),
    ] = None,
    json: o.Json = False,
    preset: o.Preset = None,
    neurons: o.Neurons = None,
    config: o.Config = None,
    settings: o.Settings = None,
    sensitivity: o.Sensitivity = None,
    engine: o.Engine = "auto",
    scale_kernels: o.ScaleKernels = False,
    size: o.Size = "99x72",
    fit: o.Fit = "crop",
    roi: o.Roi = None,
    mask: o.Mask = None,
    flip: o.Flip = None,
    rotate: o.Rotate = 0,
    start: o.Start = None,
    end: o.End = None,
    stride: o.Stride = 1,
    max_frames: o.MaxFrames = None,
    rate: o.Rate = None,
) -> int:
    """Look at many clips, each once: what is done already, by content and settings, is not done again.

    Give the same command again to go on after an interruption, or to take up new clips.
    """
    from ..batch import find_clips, make_request, run_batch
    from ..model.scaling import scaled
    from ..runtime.interrupts import Interrupted
    from .batch_text import as_text, document, failure
    from .destinations import check_folder, make_folder
    from .print_json import print_json
    from .progress import say, screen
    from .settings import choose

    if trace not in TRACES:
        raise ParameterError(f"--trace {trace}: must be one of {', '.join(TRACES)}")
    chosen = choose(preset, neurons, config, settings or (), sensitivity)
    view = o.view(size, fit, roi, mask, flip, rotate)
    asked = make_request(
        out, scaled(chosen.params, view["size"][0]) if scale_kernels else chosen.params, preset=chosen.preset,
        engine=engine, trace=TRACES[trace], annotate=annotate, **view,
        start_s=start, end_s=end, stride=stride, max_frames=max_frames, rate_hz=rate,
    )  # fmt: skip
    check_folder("--out", out)
    clips = find_clips(sources, out)
    hands = _hands(asked, workers, cluster)
    make_folder("--out", out)
    with screen(len(clips), "clips") as here:

        def tell(row: Row) -> None:
            if row.status == "failed":
                here.say(f"lobula: {failure(row)}")
            if here.advance is not None:
                here.advance()

        ended = run_batch(clips, asked, hands, tell)
    if json:
        print_json(document(ended))
    else:
        print(as_text(ended))
    if isinstance(ended.stop, Interrupted):
        say(f"lobula: interrupted ({ended.stop}): the same command goes on from here")
        return ended.stop.exit_code
    if ended.stop is not None:
        say(f"lobula: {ended.stop}")
        return FAILED
    return SOME_FAILED if ended.summary.failed else DONE


def _hands(asked: Request, workers: int | None, cluster: str | None) -> Hands:
    """Return who does the work: processes of this machine, or a Dask cluster."""
    from ..batch.crew import Crew
    from ..workers import cores

    if cluster is None:
        return Crew(asked, cores() if workers is None else workers)
    from ..batch.cluster import LOCAL, Cluster

    if cluster != LOCAL and workers is not None:
        raise ParameterError(f"--workers {workers} with --cluster {cluster}: the cluster has as many as it has")
    return Cluster(asked, cores() if workers is None else workers, cluster)
