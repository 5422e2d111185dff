"""The oracles are found by their own name, whatever the folder is imported as."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
