"""From the command to the first answer: whole processes by the wall clock, caches of compiled Python warm."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from statistics import median

import lobula

from .figure import Figure

FIRST_RESULT = """
import numpy as np
import lobula
net = lobula.Network()
net.step(np.zeros((72, 99), np.uint8), 0.0)
print(net.step(np.full((72, 99), 9, np.uint8), 1 / 30).lgmd1)
"""
TIMES = 3
"""Processes of each kind in a round."""


def figures(rounds: int, quick: bool) -> list[Figure]:
    """Start each kind of process in turns."""
    commands = {
        "numpy": [sys.executable, "-c", "import numpy"],
        "result": [sys.executable, "-c", FIRST_RESULT],
        "help": [*_command(), "--help"],
        "python": [sys.executable, "-c", "pass"],
    }
    seconds: dict[str, list[float]] = {name: [] for name in commands}
    for name in commands:
        _run(commands[name])
    for _ in range(rounds):
        turns: dict[str, list[float]] = {name: [] for name in commands}
        for _ in range(TIMES):
            for name, command in commands.items():
                turns[name].append(_run(command))
        for name, times in turns.items():
            seconds[name].append(median(times))
    above = [a - b for a, b in zip(seconds["result"], seconds["numpy"], strict=True)]
    share = [a / b for a, b in zip(seconds["help"], seconds["numpy"], strict=True)]
    details = {f"{name}_s": round(median(times), 4) for name, times in seconds.items()}
    return [
        Figure("import and first result above import numpy", median(above), "s", 0.1, 0.05, "less", details),
        Figure("lobula --help against import numpy", median(share), "x", 0.7, 0.5, "less", details),
    ]


def _command() -> list[str]:
    """Return the command as installed beside this Python, or the module where it is not."""
    installed = Path(sys.executable).with_name("lobula")
    return [str(installed)] if installed.exists() else [sys.executable, "-m", "lobula"]


def _run(command: list[str]) -> float:
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    # A checkout that is not installed must be found by the processes too.
    paths = [str(Path(lobula.__file__).parents[1]), environment.get("PYTHONPATH", "")]
    environment["PYTHONPATH"] = os.pathsep.join(filter(None, paths))
    start = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=environment)
    return time.perf_counter() - start
