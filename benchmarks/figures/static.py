"""A scene that stops moving: what fades must not slow the processor down."""

from __future__ import annotations

import time
from statistics import median
from typing import Any

from numpy.typing import NDArray

from lobula.bench.scenes import RATE_HZ
from lobula.stimuli import looming

from .contenders import published
from .figure import Figure

MOVING, STILL, WINDOW = 60, 240, 10
PASSES = 5


def figures(rounds: int, quick: bool) -> list[Figure]:
    """Time a step while a robot comes, and then before its standing picture, the slowest of any ten frames apart.

    There is no camera noise: what the filters keep then fades below the smallest normal number.
    """
    movie = looming(scene="arena", noise_sigma=0.0, lead_s=0.0, hold_s=STILL / RATE_HZ, start_cm=12.0, stop_cm=4.0,
                    speed_cm_s=8.0 * RATE_HZ / MOVING)  # fmt: skip
    images = movie.images[: MOVING + STILL]
    whole, worst = [], []
    for _ in range(rounds):
        windows = [_windows(images) for _ in range(PASSES)]
        us = [median(times) for times in zip(*windows, strict=True)]
        moving, still = us[: MOVING // WINDOW], us[MOVING // WINDOW :]
        whole.append(median(still) / median(moving))
        worst.append(max(still) / median(moving))
    details = {"still_over_moving": [round(x, 3) for x in whole], "slowest_ten_frames": [round(x, 3) for x in worst]}
    return [
        Figure("static scene after motion against motion, 99x72", median(whole), "x", 1.1, None, "less", details),
        Figure("the slowest 10 frames of it", median(worst), "x", better="less", details=details),
    ]


def _windows(images: NDArray[Any]) -> list[float]:
    """Return the time of a step, us, for each ten pictures."""
    net = published()
    net.step(images[0], 0.0)
    times = []
    for first in range(0, len(images) - WINDOW + 1, WINDOW):
        start = time.thread_time_ns()
        for i in range(first, first + WINDOW):
            net.step(images[i], (i + 1) / RATE_HZ)
        times.append((time.thread_time_ns() - start) / 1000.0 / WINDOW)
    return times
