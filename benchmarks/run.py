"""Every figure of the package against what a user would take instead, on this machine.

    python benchmarks/run.py --out results.json [--quick] [--only steps file ...]

Ratios of contenders that take turns in one process; medians over rounds; processor time of the thread, of the process
where a decoder works, the wall clock where threads or processes are the point. Needs SciPy, OpenCV, PyAV, a C compiler.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import sys
from pathlib import Path

GROUPS = ("steps", "streams", "file", "startup", "memory", "static", "tuning", "batch")
ROUNDS, QUICK_ROUNDS = 9, 3
ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


def main() -> int:
    """Measure, print the table, write the file; 1 where a figure is below what it must be."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True, help="JSON file to write")
    parser.add_argument("--quick", action="store_true", help="three rounds, and the two small sizes: a look, no figure")
    parser.add_argument("--only", nargs="+", choices=GROUPS, default=GROUPS, metavar="NAME", help=", ".join(GROUPS))
    options = parser.parse_args()

    # Libraries read these once, when they are loaded: NumPy must not have been imported yet.
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))
    from report import markdown

    from lobula.bench.machine import machine

    rounds = QUICK_ROUNDS if options.quick else ROUNDS
    about = machine()
    found = []
    for name in options.only:
        print(f"measuring: {name}", file=sys.stderr)
        found += importlib.import_module(f"figures.{name}").figures(rounds, options.quick)
    about["load_after"] = machine()["load"]
    document = {"machine": about, "rounds": rounds, "quick": options.quick, "figures": [f.as_dict() for f in found]}
    options.out.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    print(markdown(document))
    return 1 if any(figure.reaches(figure.must) is False for figure in found) else 0


if __name__ == "__main__":
    sys.exit(main())
