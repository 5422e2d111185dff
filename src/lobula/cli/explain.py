"""``lobula explain``: why it did, or did not, alarm at a given moment."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from . import options as o
from .call import new_app

if TYPE_CHECKING:
    from ..runtime.explanation import Explanation

app = new_app()


@app.command()
def explain(
    source: o.Source,
    at: Annotated[float, typer.Option(metavar="S", help="the moment, s; the frame nearest to it is explained")],
    out: Annotated[Path | None, typer.Option(metavar="FILE.png", help="a picture of every map of that frame")] = None,
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
    yaw: o.Yaw = None,
    start: o.Start = None,
    stride: o.Stride = 1,
    rate: o.Rate = None,
) -> None:
    """Say why the network did, or did not, alarm at a moment of SOURCE: its layers, its sums, its rule."""
    from ..engine.network import Network
    from ..model.scaling import scaled
    from ..runtime.explanation import explain as explain_frame
    from ..runtime.opening import open as open_frames
    from ..runtime.yaw import read_yaw
    from .destinations import check_ending, check_files
    from .print_json import print_json
    from .progress import say
    from .settings import choose

    if out is not None:
        check_ending("--out", out, (".png",))
    check_files({"--out": out}, {"source": source, "mask": mask, "yaw file": yaw, "settings file": config})
    chosen = choose(preset, neurons, config, settings or (), sensitivity)
    view = o.view(size, fit, roi, mask, flip, rotate)
    params = scaled(chosen.params, view["size"][0]) if scale_kernels else chosen.params
    network = Network(params, engine=engine)
    rate_deg_s = None if yaw is None else read_yaw(yaw).at
    with open_frames(source, **view, start_s=start, stride=stride, rate_hz=rate) as frames:
        found = explain_frame(frames, network, at, yaw_rate_deg_s=rate_deg_s)
        about = {
            "source": frames.name,
            "preset": chosen.preset,
            "neurons": params.decision.neurons,
            "engine": network.engine,
        }
    if out is not None:
        _draw(found, out)
        say(f"{out}: every map of frame {found.frame.index}")
    if json:
        print_json({**about, **_document(found)})
    else:
        print(_text(found))


def _document(e: Explanation) -> dict[str, Any]:
    r = e.reading
    return {
        "frame": e.frame.index,
        "time_s": e.frame.time_s,
        "collision": r.collision,
        "state": r.state,
        "verdict": e.verdict,
        "advanced": e.advanced,
        "potentials": {"lgmd1": r.lgmd1, "lgmd2": r.lgmd2, "lptc_r": r.lptc_r, "lptc_l": r.lptc_l},
        "spikes": r.spikes._asdict(),
        "sums": {"lgmd": e.lgmd, "lptc": e.lptc},
        "conditions": [c._asdict() for c in e.conditions],
        "window": [entry._asdict() for entry in e.window],
        "layers": {name: {"mean_abs": layer.mean, "max_abs": layer.peak} for name, layer in e.layers.items()},
    }


def _text(e: Explanation) -> str:
    from ..report.palette import LABELS
    from ..types import NEURONS
    from .table import table

    r = e.reading
    parts = [f"frame {e.frame.index} at {e.frame.time_s:.3f} s, state {r.state.replace('_', ' ')}\n{e.verdict}"]
    if not e.advanced:
        parts.append("this frame repeats the one before, or joins an unfinished tick: it did not move the network on")
    parts.append(
        table(
            ("condition", "holds", "because"), [(c.name, "yes" if c.holds else "NO", c.because) for c in e.conditions]
        )
    )
    potentials = [(LABELS[n], f"{getattr(r, n):.3f}", getattr(r.spikes, n)) for n in NEURONS]
    parts.append(table(("neuron", "potential", "spikes"), potentials, right="potential spikes"))
    spikes = [(f"{w.time_s:.3f}", f"{w.lgmd1:.2f}", f"{w.lgmd2:.2f}", f"{w.lptc:.2f}") for w in e.window]
    spikes.append(("sum", "", f"A = {e.lgmd:.2f}", f"B = {e.lptc:.2f}"))
    parts.append(
        "spikes the decision looks back on, weighted by the length of their step\n"
        + table(("time_s", "LGMD-1", "LGMD-2", "LPTC"), spikes, right="time_s LGMD-1 LGMD-2 LPTC")
        + "\nA speaks for a collision: the spikes of the LGMD that gave fewer, or of LGMD-2 where it decides alone"
        + "\nB speaks for something that passes: the spikes of the LPTCs, in each step of the side that gave more"
    )
    layers = [(name, f"{layer.mean:.4g}", f"{layer.peak:.4g}") for name, layer in e.layers.items()]
    parts.append(table(("layer", "mean", "largest"), layers, right="mean largest"))
    return "\n\n".join(parts)


def _draw(e: Explanation, out: Path) -> None:
    import numpy as np

    from ..report.montage import Tile, map_picture, montage
    from ..report.png import write_png

    picture = np.rint(e.frame.image).astype(np.uint8)
    tiles = [Tile(np.stack([picture] * 3, axis=-1), f"frame {e.frame.index}  {e.frame.time_s:.3f} s")]
    for name, image in e.reading.taps.items():
        tiles.append(Tile(map_picture(image), f"{name}  {e.layers[name].peak:.3g}"))
    write_png(out, montage(tiles, columns=4))
