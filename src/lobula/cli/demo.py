"""``lobula demo``: an approach, a passing and a receding object, who spiked when, and a picture of it."""

from __future__ import annotations

import statistics
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from . import options as o
from .call import new_app

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ..engine.network import Network
    from ..model.network import NetworkParams
    from ..stimuli import Movie

app = new_app()

SHOWN = {"looming": ("approach", True), "translating_right": ("passing by", False), "receding": ("going away", False)}
"""Kind of movie -> what it is called here, and whether a collision must be seen in it."""

UNEXPECTED = 1


class Shown(NamedTuple):
    """One movie, the network's trace of it, and whether the decision is as it must be."""

    title: str
    movie: Movie
    trace: NDArray[np.void]
    alarms_s: list[float]
    as_expected: bool


@app.command()
def demo(
    out: Annotated[Path, typer.Option(metavar="FILE.png", help="where the picture goes")] = Path("lobula-demo.png"),
    json: o.Json = False,
    preset: o.Preset = None,
    neurons: o.Neurons = None,
    config: o.Config = None,
    settings: o.Settings = None,
    sensitivity: o.Sensitivity = None,
    engine: o.Engine = "auto",
) -> int:
    """Show the network three movies: an object that comes, one that passes by, one that goes away.

    Only the first must raise an alarm; the exit code is 1 if that is not so.
    """
    from ..engine.network import Network
    from ..report.plots import FIGURE_SUFFIXES
    from ..stimuli import CATALOGUE
    from .destinations import check_ending, check_files
    from .print_json import print_json
    from .progress import say
    from .settings import choose

    check_ending("--out", out, FIGURE_SUFFIXES)
    check_files({"--out": out}, {"settings file": config})
    params = choose(preset, neurons, config, settings or (), sensitivity).params
    network = Network(params, engine=engine)
    durations_s: list[float] = []
    shown = [
        _show(network, title, CATALOGUE[kind](scene="arena"), wanted, durations_s)
        for kind, (title, wanted) in SHOWN.items()
    ]
    ms_per_frame = 1000 * statistics.median(durations_s)
    _draw(shown, params, out)
    fine = all(s.as_expected for s in shown)
    if json:
        print_json(
            {
                "engine": network.engine,
                "ms_per_frame": round(ms_per_frame, 4),
                "as_expected": fine,
                "picture": str(out),
                "movies": [_document(s) for s in shown],
            }
        )
    else:
        print(_text(shown))
        say(f"\n{ms_per_frame:.3f} ms a frame, engine {network.engine}; picture: {out}")
    return 0 if fine else UNEXPECTED


def _show(network: Network, title: str, movie: Movie, wanted: bool, durations_s: list[float]) -> Shown:
    import numpy as np

    from ..report.trace import trace_row
    from ..runtime.events import collisions_of
    from ..types import TRACE_DTYPE

    network.reset()
    rows = []
    for frame in movie.frames():
        begun = time.perf_counter()
        reading = network.step(frame)
        durations_s.append(time.perf_counter() - begun)
        rows.append(trace_row(frame.index, reading))
    trace = np.array(rows, TRACE_DTYPE)
    alarms_s = [c.start_s for c in collisions_of(trace)]
    in_time = all(movie.contact_s is not None and t < movie.contact_s for t in alarms_s)
    return Shown(title, movie, trace, alarms_s, bool(alarms_s) == wanted and in_time)


def _first_spikes(s: Shown) -> dict[str, dict[str, Any]]:
    """For each neuron: how many spikes, and when the first and the last came."""
    from ..types import NEURONS

    found: dict[str, dict[str, Any]] = {}
    for neuron in NEURONS:
        counts = s.trace[f"spikes_{neuron}"]
        times_s = s.trace["time_s"][counts > 0]
        first, last = (float(times_s[0]), float(times_s[-1])) if len(times_s) else (None, None)
        found[neuron] = {"spikes": int(counts.sum()), "first_s": first, "last_s": last}
    return found


def _document(s: Shown) -> dict[str, Any]:
    return {
        "movie": s.movie.kind,
        "contact_s": s.movie.contact_s,
        "collisions_s": s.alarms_s,
        "as_expected": s.as_expected,
        "neurons": _first_spikes(s),
    }


def _text(shown: list[Shown]) -> str:
    from ..report.palette import LABELS
    from ..types import NEURONS
    from .table import table

    rows = []
    for s in shown:
        cells = [
            f"{f['spikes']}, {f['first_s']:.2f}..{f['last_s']:.2f} s" if f["spikes"] else "-"
            for f in _first_spikes(s).values()
        ]
        rows.append((s.title, *cells, f"at {s.alarms_s[0]:.2f} s" if s.alarms_s else "no"))
    heading = ("object", *(LABELS[n] for n in NEURONS), "collision")
    return "spikes, first..last\n" + table(heading, rows) + "\n\n" + "\n".join(map(_sentence, shown))


def _sentence(s: Shown) -> str:
    contact_s = s.movie.contact_s
    if s.alarms_s and contact_s is not None:
        says = (
            f"collision seen at {s.alarms_s[0]:.2f} s, {contact_s - s.alarms_s[0]:.2f} s before contact "
            f"at {contact_s:.2f} s"
        )
    elif s.alarms_s:
        says = f"collision seen at {s.alarms_s[0]:.2f} s, though nothing comes"
    else:
        says = "no collision" if contact_s is None else f"no collision seen, though contact is at {contact_s:.2f} s"
    return f"{s.title}: {says}{'' if s.as_expected else '  <- NOT AS EXPECTED'}"


def _short(s: Shown) -> str:
    if not s.alarms_s:
        return f"{s.title}: no collision"
    ahead = "" if s.movie.contact_s is None else f" {s.movie.contact_s - s.alarms_s[0]:.2f} s before contact"
    return f"{s.title}: collision seen{ahead}"


def _draw(shown: list[Shown], params: NetworkParams, out: Path) -> None:
    """Draw with matplotlib where it is, else with lobula's own pen, which knows PNG alone."""
    from ..errors import MissingExtraError
    from ..report.plots import Scene, plot_scenes, save_figure
    from ..report.png import write_png
    from ..report.sheet import scene_sheet
    from ..runtime.header import thresholds

    scenes = [Scene(_short(s), list(s.movie.frames()), s.trace) for s in shown]
    about = {"thresholds": thresholds(params)}
    try:
        save_figure(plot_scenes(scenes, about), out)
    except MissingExtraError:
        if out.suffix.lower() != ".png":
            raise
        write_png(out, scene_sheet(scenes, about))
