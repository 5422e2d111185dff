"""Robots seen from above: ID patterns to print, pictures of an arena, and tracks out of a recording.

Needs the extra ``opencv``.
"""

from __future__ import annotations

from .calibration import read_points
from .camera import TopCameraParams
from .markers import MarkerParams
from .reference import Reference
from .room import Room, parse_room
from .sightings import TrackParams
from .top_view import TopView
from .track import frame_count, track
from .tracks import POSE_DTYPE, TRACK_DTYPE, Tracks, read_tracks, tracks_csv

__all__ = [
    "POSE_DTYPE",
    "TRACK_DTYPE",
    "MarkerParams",
    "Reference",
    "Room",
    "TopCameraParams",
    "TopView",
    "TrackParams",
    "Tracks",
    "frame_count",
    "parse_room",
    "read_points",
    "read_tracks",
    "track",
    "tracks_csv",
]
