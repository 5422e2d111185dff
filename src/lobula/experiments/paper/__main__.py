"""docs/paper.md from a folder of results: ``python -m lobula.experiments.paper FOLDER docs``.

The folder is the one that ``lobula reproduce all --out FOLDER`` has written.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from .reproduction import publish


def main() -> None:
    """Publish the folder given on the command line."""
    parser = argparse.ArgumentParser(prog="python -m lobula.experiments.paper", description=__doc__)
    parser.add_argument("folder", type=Path, help="what `lobula reproduce` wrote")
    parser.add_argument("docs", type=Path, help="where paper.md and the folder paper/ go")
    given = parser.parse_args()
    publish(given.folder, given.docs)


if __name__ == "__main__":
    main()
