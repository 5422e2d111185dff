"""One step: the core against the same model in NumPy and on OpenCV, against optical flow, and against the machine."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from unittest.mock import patch

import cv2
import roofline
from baselines.flow import DisFlow
from baselines.numpy_scipy import NumpyScipyNetwork
from baselines.opencv import OpencvNetwork

from lobula.bench.network import Step, frame_by_frame, in_blocks, network
from lobula.bench.scenes import Images, pure_noise, scenes
from lobula.bench.timing import Pass, Timing, interleaved, ratio
from lobula.engine import library
from lobula.engine.core import Workspace
from lobula.model.presets import preset

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
        *(_against(size, t, "opencv", "step against tuned OpenCV", *AGAINST_OPENCV.get(size, (None, None)))
          for size, t in timings.items()),
        *(_from_roofline(size, t, best) for size, t in timings.items()),
        *(_against(size, t, "flow", "step against DIS ultrafast flow", 1.3, 2) for size, t in timings.items()),
        *(figure for size, t in timings.items() for figure in _beside(size, t)),
    ]  # fmt: skip


def _time(size: tuple[int, int], rounds: int) -> dict[str, Timing]:
    width, height = size
    named = scenes(width, height, FRAMES)
    movies = list(named.values())
    shape, p = (height, width), preset("published")

    def core(movies: list[Images] = movies, **how: bool) -> Pass:
        return frame_by_frame(lambda: network("core", **how).step, movies)

    def slow(make: Callable[[], Step]) -> Pass:
        return frame_by_frame(make, movies, SLOW_FRAMES[size])

    contenders = {
        "step": core(),
        "blocks": in_blocks(partial(network, "core"), movies),
        "numpy": slow(lambda: NumpyScipyNetwork(p, shape).step),
        "opencv": slow(lambda: OpencvNetwork(p, shape).step),
        "flow": frame_by_frame(lambda: DisFlow().step, movies, SLOW_FRAMES[size] * 4),
        "noise": core([pure_noise(width, height, FRAMES)]),
        "scaled": core(scale_kernels=True),
    }
    if size == roofline.SIZES[0]:
        contenders |= {f"on {name}": core([images]) for name, images in named.items()}
        contenders |= {f"isa {name}": _on(name, core) for name in library.isas()[:-1]}
        contenders["reference"] = slow(lambda: network("reference").step)
    return interleaved(contenders, rounds)


def _on(isa: str, core: Callable[[], Pass]) -> Pass:
    """Return a pass of the core on another instruction set."""
    work = core()
    with patch.dict(os.environ, LOBULA_ISA=isa):
        work()  # networks choose at their first picture
    return work


def _name(size: tuple[int, int]) -> str:
    return f"{size[0]}x{size[1]}"


def _us(timings: dict[str, Timing], *names: str) -> dict[str, dict[str, float]]:
    return {f"{name}_us": timings[name].as_dict() for name in names}


def _against_numpy(size: tuple[int, int], t: dict[str, Timing]) -> Figure:
    how, must, aim = AGAINST_NUMPY[size]
    return Figure(f"{how} against NumPy+SciPy, {_name(size)}", ratio(t["numpy"], t[how]), "x", must, aim,
                  details=_us(t, "numpy", "step", "blocks"))  # fmt: skip


def _against(size: tuple[int, int], t: dict[str, Timing], other: str, name: str, must: float | None,
             aim: float | None) -> Figure:  # fmt: skip
    return Figure(f"{name}, {_name(size)}", ratio(t[other], t["step"]), "x", must, aim, details=_us(t, other, "step"))


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
    return Figure(f"{how} from the roofline (best), {_name(size)}", t[how].best_us / limit.us, "x", must, aim, "less",
                  details)  # fmt: skip


def _beside(size: tuple[int, int], t: dict[str, Timing]) -> list[Figure]:
    told = [
        Figure(f"pure noise, the worst case, against the movies, {_name(size)}", ratio(t["noise"], t["step"]), "x",
               better="less", details=_us(t, "noise", "step")),
        Figure(f"scaled kernels against fixed, {_name(size)}", ratio(t["scaled"], t["step"]), "x", better="less",
               details=_us(t, "scaled", "step")),
    ]  # fmt: skip
    for name in t:
        if name.startswith(("on ", "isa ")):
            told.append(Figure(f"step {name} against the step, {_name(size)}", ratio(t[name], t["step"]), "x",
                               better="less", details=_us(t, name, "step")))  # fmt: skip
    if "reference" in t:
        told.append(Figure(f"step against the NumPy engine, {_name(size)}", ratio(t["reference"], t["step"]), "x",
                           details=_us(t, "reference", "step")))  # fmt: skip
    return told
