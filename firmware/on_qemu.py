"""The firmware on an emulated Cortex-M4F: does it say what the laptop says, and what does it cost?

    make firmware-test                       or, with lobula and its core installed:
    python firmware/on_qemu.py --frames 10000 --presets paper,lobula

A robot drives in the arena under the laptop's float network; its pictures and turns go to the firmware in QEMU, to the
laptop's float network and to its compact one. Printed are the largest differences, and RAM, flash, stack and
instructions for each frame. Exit status 1: spikes or decisions differ in more than 1 frame of 1000, or a limit is
passed.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import lobula
from lobula.arena.network_controller import NetworkController
from lobula.arena.simulation import Simulation
from lobula.arena.world import World
from lobula.export import STACK, c_folder
from lobula.types import NEURONS

HERE = Path(__file__).parent
TOOLS = {
    "arm-none-eabi-gcc": "gcc-arm-none-eabi libnewlib-arm-none-eabi",
    "qemu-system-arm": "qemu-system-arm",
}
WIDTH, HEIGHT, RATE_HZ = 99, 72, 30.0
CYCLES_PER_INSTRUCTION, CLOCK_HZ = 1.5, 180e6
LIMITS = {
    "RAM, bytes": 192 * 1024, "stack, bytes": STACK, "flash, bytes": 64 * 1024, "instructions a frame": 4_000_000,
}  # fmt: skip
MOST_DIFFERENT = 0.001
"""Share of the frames that may have other spikes, decisions, states, or a potential that is further off than this:"""
TOLERANCE = 0.005

HEAD = np.dtype([(n, "<u4") for n in ("state_bytes", "stack_bytes", "loop_counted", "loop_true", "init_counted")])
ANSWER = np.dtype(
    [("time_s", "<f8"), *((name, "<f4") for name in NEURONS), ("spikes", "<i4", 4), ("collision", "<i4"),
     ("state", "<i4"), ("returned", "<i4"), ("counted", "<u4")]
)  # fmt: skip


class Film(NamedTuple):
    """What one robot saw: (T, H, W), (T,) and (T,)."""

    images: NDArray[np.uint8]
    times_s: NDArray[np.float64]
    turning: NDArray[np.bool_]


class Recorder:
    """A network that drives, and keeps what the first robot saw."""

    def __init__(self, preset: str) -> None:
        self._network = NetworkController(lobula.preset(preset))
        self.images: list[NDArray[np.uint8]] = []
        self.turning: list[bool] = []

    def start(self, robots: int, rng: np.random.Generator) -> None:
        self._network.start(robots, rng)

    def step(self, images: NDArray[np.uint8], time_s: float, turning: NDArray[np.bool_]) -> NDArray[np.bool_]:
        self.images.append(images[0].copy())
        self.turning.append(bool(turning[0]))
        return self._network.step(images, time_s, turning)


def film(preset: str, frames: int, seed: int) -> Film:
    """Let the paper's four robots drive."""
    recorder = Recorder(preset)
    simulation = Simulation(World(), recorder, seed)
    for _ in range(frames):
        simulation.tick()
    return Film(np.array(recorder.images), np.arange(frames) / RATE_HZ, np.array(recorder.turning))


def frames_file(seen: Film) -> bytes:
    """Every other frame goes in line by line."""
    parts = [struct.pack("<i", len(seen.images))]
    for t, image in enumerate(seen.images):
        parts += [struct.pack("<iif", t % 2, int(seen.turning[t]), 1000.0 / RATE_HZ), image.tobytes()]
    return b"".join(parts)


def build(preset: str, folder: Path) -> dict[str, int]:
    """Export, compile and link; return the sizes of a whole robot's program, bytes."""
    core = folder / "core"
    core.mkdir()
    for name, text in c_folder(lobula.preset(preset), preset, WIDTH, HEIGHT, "firmware/on_qemu.py").items():
        (core / name).write_text(text, encoding="utf-8")
    make = ["make", "--silent", "--no-print-directory", f"--directory={HERE}", f"CORE={core}", f"OUT={folder}"]
    subprocess.run(make, check=True, env={k: v for k, v in os.environ.items() if k != "MAKEFLAGS"})
    table = subprocess.run(
        ["arm-none-eabi-size", str(folder / "robot.elf")], check=True, capture_output=True, text=True
    )
    code, data, bss = map(int, table.stdout.splitlines()[1].split()[:3])
    calls = [line.split("\t") for path in folder.glob("*.su") for line in path.read_text().splitlines()]
    largest = max(calls, key=lambda call: int(call[1]))
    print(f"  largest stack frame: {largest[1]} bytes, {largest[0].rpartition('/')[2]}")
    return {"flash": code + data, "static": data + bss}


def emulate(folder: Path, seen: Film) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the heads before and after, and the answers."""
    (folder / "frames.bin").write_bytes(frames_file(seen))
    subprocess.run(
        ["qemu-system-arm", "-machine", "mps2-an386", "-kernel", "harness.elf", "-nographic", "-monitor", "none",
         "-serial", "none", "-icount", "shift=0,align=off,sleep=off", "-semihosting-config", "enable=on,target=native"],
        check=True, cwd=folder, timeout=60 + len(seen.images),
    )  # fmt: skip
    raw = (folder / "answers.bin").read_bytes()
    middle = np.frombuffer(raw, ANSWER, len(seen.images), HEAD.itemsize)
    ends = np.frombuffer(raw[: HEAD.itemsize] + raw[-HEAD.itemsize :], HEAD)
    return ends, middle


def compare(answers: NDArray[Any], trace: NDArray[Any]) -> dict[str, Any]:
    """Say how far the firmware is from a trace of the laptop."""
    spikes = np.stack([trace[f"spikes_{name}"] for name in NEURONS], axis=1)
    states = np.array([lobula.types.STATES[i] for i in answers["state"]])
    off = np.stack([np.abs(answers[name] - trace[name]) for name in NEURONS], axis=1)
    return {
        "largest difference": dict(zip(NEURONS, off.max(axis=0).tolist(), strict=True)),
        f"frames with a potential off by over {TOLERANCE}": int((~(off <= TOLERANCE)).any(axis=1).sum()),
        "frames with other spikes": int((answers["spikes"] != spikes).any(axis=1).sum()),
        "frames with another decision": int((answers["collision"] != trace["collision"]).sum()),
        "frames with another state": int((states != trace["state"]).sum()),
    }


def examine(preset: str, frames: int, seed: int) -> dict[str, Any]:
    """Return everything there is to say of one preset."""
    print(f"{preset}: {frames} frames of the arena, seed {seed}", flush=True)
    seen = film(preset, frames, seed)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        sizes = build(preset, folder)
        ends, answers = emulate(folder, seen)
    traces = {
        storage: lobula.Network(lobula.preset(preset), storage=storage).run(
            seen.images, seen.times_s, turning=seen.turning
        )
        for storage in ("float", "compact")
    }
    steps = answers["counted"]
    stack = int(ends["stack_bytes"][-1])
    return {
        "preset": preset,
        "frames": frames,
        "alarms": int((np.diff(traces["float"]["collision"].astype(int)) > 0).sum()),
        "spikes": {name: int(traces["float"][f"spikes_{name}"].sum()) for name in NEURONS},
        "counter": float(ends["loop_counted"][0] / ends["loop_true"][0]),
        "RAM, bytes": sizes["static"] + stack,
        "state, bytes": int(ends["state_bytes"][0]),
        "stack, bytes": stack,
        "flash, bytes": sizes["flash"],
        "instructions a frame": round(float(steps[1:].mean())),
        "instructions, most": int(steps[1:].max()),
        "against the laptop's float build": compare(answers, traces["float"]),
        "against the laptop's compact build": compare(answers, traces["compact"]),
    }


def report(found: dict[str, Any]) -> list[str]:
    """Print what was found, and return what is not as it must be."""
    mean, most = found["instructions a frame"], found["instructions, most"]
    cycles = mean * CYCLES_PER_INSTRUCTION
    print(
        f"  RAM {found['RAM, bytes'] / 1024:.1f} KiB: state {found['state, bytes']}, stack {found['stack, bytes']} "
        f"bytes, wheels and serial line included; flash {found['flash, bytes'] / 1024:.1f} KiB"
    )
    print(
        f"  instructions a frame: {mean / 1e6:.2f} million, at most {most / 1e6:.2f} million (counter off by "
        f"{abs(found['counter'] - 1):.2%})"
    )
    print(
        f"  estimate, at {CYCLES_PER_INSTRUCTION} cycles an instruction: {cycles / 1e6:.2f} million cycles, "
        f"{1000 * cycles / CLOCK_HZ:.1f} ms at {CLOCK_HZ / 1e6:.0f} MHz"
    )
    print(f"  {found['alarms']} alarms; spikes " + ", ".join(f"{k} {v}" for k, v in found["spikes"].items()))
    wrong = [f"{what}: {found[what]} > {most}" for what, most in LIMITS.items() if found[what] > most]
    for name in ("float", "compact"):
        against = found[f"against the laptop's {name} build"]
        other = {what: n for what, n in against.items() if what.startswith("frames ")}
        print(f"  against the laptop's {name} build: largest difference of a potential "
              f"{max(against['largest difference'].values()):.1e}; of {found['frames']} frames "
              + ", ".join(f"{n} {what.removeprefix('frames ')}" for what, n in other.items()))  # fmt: skip
        wrong += [f"{n} {what}" for what, n in other.items() if n > MOST_DIFFERENT * found["frames"]]
    return [f"{found['preset']}: {line}" for line in wrong]


def main() -> int:
    """Run the test."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--frames", type=int, default=600)
    parser.add_argument("--seed", type=int, default=121)
    parser.add_argument("--presets", default="paper,lobula")
    parser.add_argument("--json", type=Path, help="everything, for programs")
    chosen = parser.parse_args()
    missing = {package for tool, package in TOOLS.items() if shutil.which(tool) is None}
    if missing:
        print(f"firmware-test: skipped; to run it: apt-get install {' '.join(sorted(missing))}")
        return 0
    found = [examine(preset, chosen.frames, chosen.seed) for preset in chosen.presets.split(",")]
    wrong = [line for one in found for line in report(one)]
    if chosen.json:
        chosen.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    print("\n".join(wrong) or "firmware-test: all as it must be")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
