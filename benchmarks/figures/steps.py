"""One step: the core against the same model in NumPy and on OpenCV, against optical flow, and against the machine."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any
from unittest.mock import patch

import cv2
import roofline
from baselines.flow import DisFlow
from baselines.numpy_scipy import NumpyScipyNetwork
from baselines.opencv import OpencvNetwork
from baselines.opencv_folded import FoldedOpencvNetwork

from lobula.bench.network import Step, frame_by_frame, in_blocks, network
from lobula.bench.scenes import Images, pure_noise, scenes
from lobula.bench.timing import Pass, Timing, interleaved, ratio
from lobula.engine import library
from lobula.engine.core import Workspace
from lobula.engine.network import Network
from lobula.model.presets import preset

from .contenders import paper, published, scaled
from .figure import Figure

FRAMES = 64
SLOW_FRAMES = {(99, 72): 20, (320, 240): 8, (640, 480): 2, (1280, 720): 2}
"""Pictures of each movie that a slow contender takes in a turn."""
QUICK_SIZES = 2
AGAINST_NUMPY = {(99, 72): ("step", 30, 50), (320, 240): ("step", 25, 40), (640, 480): ("blocks", 20, 35),
                 (1280, 720): ("blocks", 20, 35)}  # fmt: skip
AGAINST_OPENCV = {(99, 72): (10, 14)}
FROM_ROOFLINE = {(99, 72): (4, 2.2)}


def figures(rounds: int, quick: bool) -> list[Figure]:
    """Time every contender at every size; the numbers come in the order of the issue's table, others follow."""
    cv2.setNumThreads(1)
    sizes = roofline.SIZES[:QUICK_SIZES] if quick else roofline.SIZES
    peaks = [roofline.measure_peaks(library.isa())]
    timings = {size: _time(size, rounds) for size in sizes}
    peaks.append(roofline.measure_peaks(library.isa()))
    best = roofline.better(*peaks)
    return [
        *(_against_numpy(size, t) for size, t in timings.items()),
        *(_against_opencv(size, t) for size, t in timings.items()),
        *(_from_roofline(size, t, best) for size, t in timings.items()),
        *(_against_flow(size, t) for size, t in timings.items()),
        *(figure for size, t in timings.items() for figure in _beside(size, t)),
    ]  # fmt: skip


def _time(size: tuple[int, int], rounds: int) -> dict[str, Timing]:
    width, height = size
    named = scenes(width, height, FRAMES)
    movies = list(named.values())
    shape, p = (height, width), preset("published")

    def core(movies: list[Images] = movies, make: Callable[[], Network] = published) -> Pass:
        return frame_by_frame(lambda: make().step, movies)

    def slow(make: Callable[[], Step]) -> Pass:
        return frame_by_frame(make, movies, SLOW_FRAMES[size])

    contenders = {
        "step": core(),
        "blocks": in_blocks(published, movies),
        "numpy": slow(lambda: NumpyScipyNetwork(p, shape).step),
        "opencv": slow(lambda: OpencvNetwork(p, shape).step),
        "opencv folded": slow(lambda: FoldedOpencvNetwork(p, shape).step),
        "flow": frame_by_frame(lambda: DisFlow().step, movies, SLOW_FRAMES[size] * 4),
        "noise": core([pure_noise(width, height, FRAMES)]),
        "scaled": core(make=scaled),
        "preset paper": core(make=paper),
    }
    if size == roofline.SIZES[0]:
        contenders |= {f"on {name}": core([images]) for name, images in named.items()}
        contenders |= {f"isa {name}": _on(name, core) for name in library.isas()[:-1]}
        contenders["reference"] = slow(lambda: network("reference", "published").step)
    return interleaved(contenders, rounds)


def _on(isa: str, core: Callable[[], Pass]) -> Pass:
    """Return a pass of the core on another instruction set."""
    work = core()
    with patch.dict(os.environ, LOBULA_ISA=isa):
        work()  # networks choose at their first picture
    return work


def _name(size: tuple[int, int]) -> str:
    return f"{size[0]}x{size[1]}"


def _told(what: str, size: tuple[int, int], t: dict[str, Timing], slow: str, fast: str, **about: Any) -> Figure:
    """Return how many times longer ``slow`` takes than ``fast`` at one size."""
    details: dict[str, Any] = {f"{name}_us": t[name].as_dict() for name in (slow, fast)}
    details["ratio_of_best"] = round(t[slow].best_us / t[fast].best_us, 3)
    return Figure(f"{what}, {_name(size)}", ratio(t[slow], t[fast]), "x", details=details, size=_name(size), **about)


def _against_numpy(size: tuple[int, int], t: dict[str, Timing]) -> Figure:
    how, must, aim = AGAINST_NUMPY[size]
    return _told(f"{how} against NumPy+SciPy", size, t, "numpy", how, must=must, aim=aim)


def _against_opencv(size: tuple[int, int], t: dict[str, Timing]) -> Figure:
    must, aim = AGAINST_OPENCV.get(size, (None, None))
    return _told("step against tuned OpenCV", size, t, "opencv", "step", must=must, aim=aim)


def _against_flow(size: tuple[int, int], t: dict[str, Timing]) -> Figure:
    return _told("step against DIS ultrafast flow", size, t, "flow", "step", must=1.3, aim=2.0)


def _from_roofline(size: tuple[int, int], t: dict[str, Timing], peaks: roofline.Peaks) -> Figure:
    """Best time over the limit: frame by frame while the state fits the cache, in blocks where it does not."""
    width, height = size
    frames = Workspace(preset("published"), (height, width)).frames
    how = "blocks" if frames > 1 else "step"
    limit = roofline.limit(peaks, width, height, frames)
    one_by_one = roofline.limit(peaks, width, height)
    must, aim = FROM_ROOFLINE.get(size, (None, None))
    details = {
        "best_us": t[how].best_us, "limit_us": limit.us, "limited_by": limit.by, "frames_at_once": frames,
        "step_best_us": t["step"].best_us, "step_limit_us": one_by_one.us, "step_limited_by": one_by_one.by,
        "operations_s": peaks.operations_s, "bytes_s": peaks.bytes_s[roofline.state_bytes(width, height)],
    }  # fmt: skip
    value = t[how].best_us / limit.us
    return Figure(f"{how} from the roofline (best), {_name(size)}", value, "x", must, aim, "less", details, _name(size))


def _beside(size: tuple[int, int], t: dict[str, Timing]) -> list[Figure]:
    told = [
        _told("step against OpenCV with the core's algebra", size, t, "opencv folded", "step"),
        _told("blocks against step", size, t, "step", "blocks"),
        _told("strong noise against the movies", size, t, "noise", "step", better="less"),
        _told("scaled kernels against fixed", size, t, "scaled", "step", better="less"),
    ]
    for name in t:
        if name.startswith(("on ", "isa ", "preset ")):
            told.append(_told(f"step, {name}, against the step", size, t, name, "step", better="less"))
    if "reference" in t:
        told.append(_told("step against the NumPy engine", size, t, "reference", "step"))
    return told
