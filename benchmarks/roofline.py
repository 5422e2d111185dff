"""How fast the step could be on this machine: the model's bytes and operations against what one core can do.

The limit of one step is the larger of two times: its operations at the best rate of vector arithmetic, and its bytes at
the best rate at which memory of the state's size is read and written. ``python roofline.py`` prints both counts, the
measured rates and the limits; ``run.py`` sets the core's best time beside them.

Counted is the least that is known to do the work of the preset, not what the core happens to do: loads, stores,
addresses, the width of a row that is no multiple of a vector, and sums kept in double precision cost nothing here.
"""

from __future__ import annotations

import platform
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from lobula.model.network import NetworkParams
from lobula.model.presets import preset

SIZES = ((99, 72), (320, 240), (640, 480), (1280, 720))
"""Working sizes of every table, width x height."""

FLAGS = {
    "x86-64": ("-march=x86-64", 16),
    "x86-64-v3": ("-march=x86-64-v3", 32),
    "x86-64-v4": ("-march=x86-64-v4", 64),
    "aarch64": ("-O2", 16),
    "plain": ("-O2", 4),
}
"""Instruction set of the core -> compiler flag, and bytes of a vector."""


@dataclass(frozen=True)
class Work:
    """Operations for each pixel of one part of the step; a multiply-add counts once."""

    part: str
    operations: int
    count: str


def operations(p: NetworkParams) -> list[Work]:
    """Return the vector operations of a step, part by part."""
    inner, outer = p.lamina.dog.radius_px, p.lamina.dog.radius_px * p.lamina.dog.surround
    spans = len(p.lptc.emd.spans_px)
    branches = [lgmd.on for lgmd in (p.lgmd1, p.lgmd2)], [lgmd.off for lgmd in (p.lgmd1, p.lgmd2)]
    sets = sum(1 if a == b else 2 for a, b in branches)
    products = sum(lgmd.product_gain != 0 for lgmd in (p.lgmd1, p.lgmd2))
    return [
        Work("look at the change first: repeated? flash?", 7, "2 to float, difference, magnitude, 2 sums, maximum"),
        Work("change P", 4, "2 to float, difference, scale"),
        Work("Gaussians, along rows", outer + inner + 1 + outer + 1, "pairs shared by both fields, then one each"),
        Work("Gaussians, along columns", 2 * inner + 1 + 2 * outer + 1, "pairs, then one each"),
        Work("centre against surround", 8, "difference, magnitude; for each sign 2 tests and a choice"),
        Work("ON and OFF of the lamina", 2, "the residual, twice"),
        Work("adaptation", 7, "2 x (rise, not below 0); both channels in one signed plane: join, and 2 to part"),
        Work("motion detectors", 2 * (2 * spans + 1), "2 channels x (pairs of M, weigh, times M one step ago)"),
        Work("ON and OFF of the change", 4, "2 halves, the residual twice"),
        Work("neighbours to the sides", 4, "2 channels, now and one step ago"),
        Work("inhibition", 10 * sets, f"{sets} distinct branches x (own row 4, rows above and below 4, 2 to join)"),
        Work("competition", sets, "not below 0"),
        Work("summation", 2 + products, "ON and OFF; with a product one more"),
        Work("grouping", 2 * 7, "2 LGMDs x (3 x 3 sum 4, times S, maximum, test); what passes is not counted"),
    ]  # fmt: skip


PLANES = ("luminance", "lamina ON", "lamina OFF", "adapted, signed", "change ON", "change OFF")
"""Float planes that must outlive a step. Of the adapted channels only one is above 0 at a pixel, so a sign tells."""


def bytes_per_pixel(frames: int = 1) -> float:
    """Return the bytes of a step: every plane read and written once in ``frames`` steps, and one uint8 frame read."""
    return len(PLANES) * 2 * 4 / frames + 1


@dataclass(frozen=True)
class Peaks:
    """What one core did at best: vector operations a second, and bytes a second for each number of bytes in use."""

    isa: str
    vector_bytes: int
    operations_s: dict[str, float]
    bytes_s: dict[int, float]


@dataclass(frozen=True)
class Limit:
    """Least time of a step, us: of its operations, and of its bytes."""

    operations_us: float
    bytes_us: float

    @property
    def us(self) -> float:
        """The limit."""
        return max(self.operations_us, self.bytes_us)

    @property
    def by(self) -> str:
        """What sets it."""
        return "arithmetic" if self.operations_us >= self.bytes_us else "memory"


def state_bytes(width: int, height: int) -> int:
    """Return the bytes of the planes."""
    return len(PLANES) * 4 * width * height


def measure_peaks(isa: str, rounds: int = 25) -> Peaks:
    """Compile peaks.c for ``isa`` with the system's C compiler and run it.

    Raises
    ------
    OSError, subprocess.CalledProcessError : there is no compiler, or it cannot compile for ``isa``
    """
    flag, vector_bytes = FLAGS[isa]
    sizes = [str(state_bytes(*size)) for size in SIZES]
    with tempfile.TemporaryDirectory() as folder:
        program = str(Path(folder, "peaks"))
        source = str(Path(__file__).with_name("peaks.c"))
        subprocess.run(
            [
                "cc",
                "-O2",
                "-std=gnu11",
                "-ffp-contract=fast",
                flag,
                f"-DVECTOR_BYTES={vector_bytes}",
                source,
                "-o",
                program,
            ],
            check=True,
        )
        printed = subprocess.run([program, str(rounds), *sizes], check=True, capture_output=True, text=True).stdout
    rates = [line.split() for line in printed.splitlines()]
    return Peaks(
        isa,
        vector_bytes,
        {kind: float(rate) for kind, *_, rate in rates if kind != "rmw"},
        {int(rest[0]): float(rest[1]) for kind, *rest in rates if kind == "rmw"},
    )


def better(a: Peaks, b: Peaks) -> Peaks:
    """Return the best rates of two measurements of the same instruction set."""
    return Peaks(
        a.isa,
        a.vector_bytes,
        {kind: max(rate, b.operations_s[kind]) for kind, rate in a.operations_s.items()},
        {size: max(rate, b.bytes_s[size]) for size, rate in a.bytes_s.items()},
    )


def limit(peaks: Peaks, width: int, height: int, frames: int = 1) -> Limit:
    """Return the limit of a step at one size, where ``frames`` steps share one pass over the state."""
    pixels = width * height
    vectors = sum(w.operations for w in operations(preset("published"))) * pixels * 4 / peaks.vector_bytes
    return Limit(
        1e6 * vectors / max(peaks.operations_s.values()),
        1e6 * bytes_per_pixel(frames) * pixels / peaks.bytes_s[state_bytes(width, height)],
    )


def main() -> None:
    """Print the counts, the rates and the limits."""
    from lobula.engine import library

    isa = library.isa() if library.available() else ("aarch64" if platform.machine() == "aarch64" else "x86-64")
    work = operations(preset("published"))
    print("| part of the step | operations/px | |\n|---|--:|---|")
    for w in work:
        print(f"| {w.part} | {w.operations} | {w.count} |")
    print(f"| all | {sum(w.operations for w in work)} | |\n")
    print(f"state: {len(PLANES)} float planes ({', '.join(PLANES)}); {bytes_per_pixel():g} bytes/px and step\n")
    peaks = measure_peaks(isa)
    rates = ", ".join(f"{kind} {rate / 1e9:.2f}" for kind, rate in peaks.operations_s.items())
    print(f"{isa}: 1e9 vector operations/s of {peaks.vector_bytes} bytes: {rates}\n")
    print("| size | state, MB | GB/s | arithmetic, us | memory, us | limit, us |\n|---|--:|--:|--:|--:|--:|")
    for width, height in SIZES:
        size, best = state_bytes(width, height), limit(peaks, width, height)
        print(
            f"| {width}x{height} | {size / 1e6:.2f} | {peaks.bytes_s[size] / 1e9:.0f} | {best.operations_us:.1f} | "
            f"{best.bytes_us:.1f} | {best.us:.1f} ({best.by}) |"
        )


if __name__ == "__main__":
    main()
