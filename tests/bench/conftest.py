"""The benchmarks are scripts, not part of the package: their folder must be found first."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
