"""What lies outside the picture: the edge pixels, repeated (the published code's habit)."""

from __future__ import annotations

import numpy as np

from ..types import Image


def replicate(image: Image, margin_px: int) -> Image:
    """Return ``image`` (H, W) with its edge repeated ``margin_px`` pixels outwards on every side."""
    return np.pad(image, margin_px, mode="edge")
