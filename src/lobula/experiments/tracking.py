"""How well robots are found from above: the numbers and the picture of docs/track.md.

    python -m lobula.experiments.tracking docs

Arenas of the paper's size are driven by robots that turn by chance, drawn as an overhead camera sees them, encoded as
H.264 or not, tracked, and compared with where the robots were. Then two runs of the network are filmed and scored from
the film, and compared with what the simulation itself wrote down.
"""

from __future__ import annotations

import argparse
import math
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arena.controls import RandomTurn
from ..arena.network_controller import NetworkController
from ..arena.scorer import Scorer
from ..arena.simulation import Simulation
from ..arena.world import RobotParams, World
from ..overhead import Reference, Room, TopCameraParams, TopView, Tracks, track
from ..report.mp4 import Mp4Writer
from ..report.png import write_png
from .tracked import score_tracks

ROOM = Room()
ROBOTS, SECONDS, SEED = 7, 4.0, 3
_RATE_HZ = 30.0
BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


class Condition(NamedTuple):
    """What the camera is like, how its picture is tied to the room, and what happens to the film."""

    name: str
    camera: TopCameraParams
    reference: str = "corners"
    encoded: bool = True
    exposure_s: float = 0.0


_HIGH = TopCameraParams(height_cm=120.0, margin_cm=8.0, blur_px=0.7, noise_grey=3.0)
_TILTED = replace(_HIGH, tilt_deg=15.0)
CONDITIONS = (
    Condition("ideal camera, 11 px/cm, pictures as they are", TopCameraParams(), encoded=False),
    Condition("ideal camera, 11 px/cm, H.264", TopCameraParams()),
    Condition("blur 1 px, noise 5 grey levels", TopCameraParams(blur_px=1.0, noise_grey=5.0), encoded=False),
    Condition("the same, H.264", TopCameraParams(blur_px=1.0, noise_grey=5.0)),
    Condition("1.2 m up, blur 0.7 px, noise 3, H.264", _HIGH),
    Condition("the same, tilted by 15 degrees", _TILTED),
    Condition("the same, corners rounded to whole pixels", _TILTED, "whole"),
    Condition("the same, corner markers instead", _TILTED, "ids"),
    Condition("wide lens (barrel, 10 %), 20 known points clicked to the pixel", replace(_HIGH, lens_k1=-0.1), "points"),
    Condition("exposure of 1/60 s: robots smear", _HIGH, exposure_s=1 / 60),
    Condition("8 px/cm", replace(_HIGH, px_per_cm=8.0)),
    Condition("6 px/cm", replace(_HIGH, px_per_cm=6.0)),
)  # fmt: skip


class Found(NamedTuple):
    """Share of poses found, errors against the truth (root mean square and largest), and the errors it names itself."""

    share: float
    rms_mm: float
    most_mm: float
    rms_deg: float
    most_deg: float
    said_mm: float
    said_deg: float


def main() -> None:
    """Write the numbers into track.md and the picture beside it, below the folder given on the command line."""
    parser = argparse.ArgumentParser(prog="python -m lobula.experiments.tracking", description=__doc__)
    parser.add_argument("folder", type=Path, help="where track.md and images/track.png are")
    folder: Path = parser.parse_args().folder
    with tempfile.TemporaryDirectory() as scratch:
        draw(folder / "images" / "track.png", Path(scratch))
        lines = [*accuracy_table(Path(scratch)), "", *score_table(Path(scratch))]
    page = folder / "track.md"
    before, _, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    after = rest.partition(END)[2]
    page.write_text(f"{before}{BEGIN}\n" + "\n".join(lines) + f"\n{END}{after}", encoding="utf-8")


def accuracy_table(scratch: Path) -> Iterator[str]:
    """Yield a table of what is found under each condition."""
    yield f"{ROBOTS} robots, {SECONDS:g} s, room {ROOM} cm; errors against the truth, bridged poses included, and"
    yield "those it names itself."
    yield ""
    yield "| camera and film | found | mm, rms | mm, most | deg, rms | deg, most | named: mm | deg |"
    yield "|---|--:|--:|--:|--:|--:|--:|--:|"
    truth = driven(SECONDS)
    for condition in CONDITIONS:
        found = compared(tracked(condition, truth, scratch), truth)
        share = f"{found.share:.2%}" if found.share < 1 else "100 %"
        numbers = " | ".join(f"{value:.3f}" for value in found[1:])
        yield f"| {condition.name} | {share} | {numbers} |"


def driven(seconds: float) -> NDArray[np.float64]:
    """Return where robots that turn by chance are, (T, R, 3)."""
    simulation = Simulation(World(robots=RobotParams(count=ROBOTS)), RandomTurn(20.0), SEED)
    poses = []
    for _ in range(round(seconds * _RATE_HZ)):
        poses.append(simulation.pose.copy())
        simulation.tick()
    return np.array(poses)


def tracked(condition: Condition, truth: NDArray[np.float64], scratch: Path) -> Tracks:
    """Film the robots and find them again."""
    camera = condition.camera
    view = TopView(ROOM, camera=camera, corner_ids=(46, 47, 48, 49) if condition.reference == "ids" else None)
    if condition.encoded:
        film(scratch / "film.mp4", view, truth, condition.exposure_s)
        return track(scratch / "film.mp4", ROOM, _reference(condition, view))
    images = np.stack([_exposed(view, truth, k, condition.exposure_s) for k in range(len(truth))])
    return track(images, ROOM, _reference(condition, view), rate_hz=_RATE_HZ)


def film(path: Path, view: TopView, poses: NDArray[np.float64], exposure_s: float = 0.0) -> None:
    """Write what ``view`` shows of ``poses`` (T, R, 3) as H.264."""
    writer = Mp4Writer(path, view.camera.width, view.camera.height, _RATE_HZ)
    for k in range(len(poses)):
        writer.write(np.repeat(_exposed(view, poses, k, exposure_s)[..., None], 3, axis=2), k / _RATE_HZ)
    writer.finish()


def _exposed(view: TopView, poses: NDArray[np.float64], k: int, exposure_s: float) -> NDArray[np.uint8]:
    """One picture; with an exposure the mean of five, spread over it around its frame's time."""
    if not exposure_s:
        return view.picture(poses[k], noise_key=k)
    shares = np.linspace(-0.4, 0.4, 5) * exposure_s * _RATE_HZ
    pictures = []
    for n, share in enumerate(shares):
        other = poses[min(max(k + (1 if share > 0 else -1), 0), len(poses) - 1)]
        way = other - poses[k]
        way[:, 2] = (way[:, 2] + math.pi) % (2 * math.pi) - math.pi
        pictures.append(view.picture(poses[k] + abs(share) * way, noise_key=[k, n]))
    return np.asarray(np.rint(np.mean(pictures, axis=0)).astype(np.uint8))


def _reference(condition: Condition, view: TopView) -> Reference:
    camera = condition.camera
    lens_cm = camera.height_cm * math.cos(math.radians(camera.tilt_deg))
    above = lens_cm if math.isfinite(lens_cm) else None
    if condition.reference == "ids":
        return Reference(corner_ids=(46, 47, 48, 49))
    if condition.reference == "points":
        cm = np.stack(np.meshgrid(np.linspace(0, 70, 5), np.linspace(0, 55, 4)), axis=-1).reshape(-1, 2)
        px = view.camera.to_px(np.insert(cm, 2, 0.0, axis=1))
        return Reference(points=(np.rint(px), cm), camera_cm=above)  # as one clicks them
    corners = view.camera.to_px(np.insert(ROOM.corners_cm, 2, 0.0, axis=1))
    return Reference(corners_px=np.rint(corners) if condition.reference == "whole" else corners, camera_cm=above)


def compared(tracks: Tracks, truth: NDArray[np.float64]) -> Found:
    """Compare tracks with where the robots were, (T, R, 3)."""
    poses, said = tracks.poses(), tracks.summary()
    mm = 10 * np.hypot(poses["x_cm"] - truth[..., 0], poses["y_cm"] - truth[..., 1])
    turned = (poses["heading_rad"] - truth[..., 2] + math.pi) % (2 * math.pi) - math.pi
    deg = np.degrees(np.abs(turned))
    return Found(
        said["found_share"],
        math.sqrt(float(np.nanmean(mm**2))),
        float(np.nanmax(mm)),
        math.sqrt(float(np.nanmean(deg**2))),
        float(np.nanmax(deg)),
        said["error_mm"],
        said["error_deg"],
    )


def score_table(scratch: Path, minutes: float = 1.0) -> Iterator[str]:
    """Yield a table of runs of the network, counted by the simulation and from the film."""
    yield f"Runs of the default network, {minutes:g} min each: events by the geometric rule as the simulation wrote"
    yield "them down, and as they were counted from an H.264 film of it (1.2 m up, tilted by 15 degrees)."
    yield ""
    yield "| robots | counted by | CR | CP | AA | AT | AP | spurious | SR1 | SR2 |"
    yield "|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|"
    for robots in (4, 7):
        for name, tally in filmed_run(robots, minutes, scratch).items():
            kinds = " | ".join(str(tally[kind]) for kind in ("CR", "CP", "AA", "AT", "AP", "spurious"))
            rates = " | ".join("" if tally[rate] is None else f"{tally[rate]:.1%}" for rate in ("SR1", "SR2"))
            yield f"| {robots} | {name} | {kinds} | {rates} |"


def filmed_run(robots: int, minutes: float, scratch: Path) -> dict[str, dict[str, Any]]:
    """Return the tally of a run by the simulation, and that from its film."""
    simulation = Simulation(World(robots=RobotParams(count=robots)), NetworkController(), SEED)
    referee, poses = Scorer(simulation), []
    for _ in range(round(minutes * 60 * _RATE_HZ)):
        poses.append(simulation.pose.copy())
        referee.tick(simulation.tick())
    condition = Condition("", _TILTED)
    watched = score_tracks(tracked(condition, np.array(poses), scratch))
    return {"the simulation": referee.score().geometric.as_dict(), "the film": watched.score.as_dict()}


def draw(path: Path, scratch: Path) -> None:
    """Draw the picture of the page: a frame through a wide, tilted lens, with what was found drawn in."""
    camera = replace(_TILTED, margin_cm=9.0, lens_k1=-0.06, noise_grey=0.0)  # noise makes a large file
    condition = Condition("", camera, "points", encoded=False)
    tracks = tracked(condition, driven(0.2), scratch)
    if tracks.draw is not None:
        write_png(path, tracks.draw())


if __name__ == "__main__":
    main()
