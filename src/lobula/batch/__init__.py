"""Many clips on all cores or a cluster: each looked at once, whatever happens on the way, and told in one manifest."""

from __future__ import annotations

from .clips import Clip, find_clips
from .cluster import Cluster
from .crew import Crew
from .request import Request, make_request
from .row import Row
from .run import Ended, run_batch

__all__ = ["Clip", "Cluster", "Crew", "Ended", "Request", "Row", "find_clips", "make_request", "run_batch"]
