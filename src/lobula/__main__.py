"""``python -m lobula`` is the command ``lobula``."""

import sys

from .cli import main

sys.exit(main())
