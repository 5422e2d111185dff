"""Many clips on all cores or a cluster: each looked at once, whatever happens on the way, and told in one manifest."""

from __future__ import annotations

from .clips import Clip, find_clips
from .request import Request
from .row import Row
from .run import Ended, run_batch

__all__ = ["Clip", "Ended", "Request", "Row", "find_clips", "run_batch"]
