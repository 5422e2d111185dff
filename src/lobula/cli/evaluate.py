"""``lobula evaluate``: labelled clips scored."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .._version import __version__
from ..errors import ParameterError
from . import options as o
from .call import new_app

if TYPE_CHECKING:
    from ..evaluate.clips import Failure
    from ..evaluate.scoring import ClipScore

app = new_app()

CLIPS_VARIABLE = "LOBULA_CLIPS"
DEFAULT_CLIPS = "../shared/clips"
SOME_FAILED = 4


@app.command()
def evaluate(
    labels: Annotated[Path, typer.Argument(metavar="LABELS.csv", help="what happens in each clip, and when")],
    clips: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help=f"folder of the clips; else ${CLIPS_VARIABLE}, else {DEFAULT_CLIPS}"),
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
) -> int:
    """Run every clip that LABELS.csv names and score the alarms: hits, lead times, misses, false alarms a minute."""
    from ..engine.network import Network
    from ..evaluate.clips import Failure, score_clips
    from ..evaluate.document import document
    from ..evaluate.labels import read_labels
    from ..evaluate.summary import summarise
    from ..model.scaling import scaled
    from ..params import settings_hash
    from .evaluate_text import as_text
    from .print_json import print_json
    from .progress import say, screen
    from .settings import choose

    chosen = choose(preset, neurons, config, settings or (), sensitivity)
    working = o.parse_size(size, "--size")
    params = scaled(chosen.params, working[0]) if scale_kernels else chosen.params
    rows = read_labels(labels)
    folder = clips_folder(clips)
    network = Network(params, engine=engine)

    def fresh() -> Network:
        network.reset()
        return network

    scores: list[ClipScore] = []
    failures: list[Failure] = []
    with screen(len(rows), "clips") as here:
        for result in score_clips(rows, folder, fresh, size=working, fit=fit):
            if here.advance is not None:
                here.advance()
            if isinstance(result, Failure):
                failures.append(result)
            else:
                scores.append(result)
    for failure in failures:
        say(f"lobula: {failure.message}")
    if not scores:
        raise ParameterError(f"{folder}: none of the clips that {labels} names could be scored")
    summary = summarise(scores)
    if json:
        about = {
            "labels": str(labels),
            "clips_folder": str(folder),
            "preset": chosen.preset,
            "neurons": params.decision.neurons,
            "settings_hash": settings_hash(params),
            "engine": network.engine,
        }
        print_json({"version": __version__, **about, **document(scores, failures, summary)})
    else:
        print(as_text(scores, failures, summary))
    return SOME_FAILED if failures else 0


def clips_folder(given: Path | None) -> Path:
    """Return the folder of the clips: as given, as the environment says, or ``../shared/clips``.

    Raises
    ------
    ParameterError : there is no such folder
    """
    named = given or os.environ.get(CLIPS_VARIABLE)
    folder = Path(named or DEFAULT_CLIPS)
    if not folder.is_dir():
        where = "--clips" if given else f"${CLIPS_VARIABLE}" if named else "no --clips, no $" + CLIPS_VARIABLE + ", and"
        raise ParameterError(f"{where} {folder}: no such folder: must hold the clips that the labels name")
    return folder
