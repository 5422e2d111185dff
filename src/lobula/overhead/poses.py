"""Where a robot is and where it looks, from the four corners of its ID pattern in cm."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .markers import MarkerParams


class Poses(NamedTuple):
    """Middles, headings and their errors, (n,) each.

    ``scale`` is the pattern's size over the size it should have, ``misfit`` how far its shape is from a square (root
    mean square of the corners, over its side). ``error_cm`` and ``error_rad`` are standard errors by that misfit.
    """

    x_cm: NDArray[np.float64]
    y_cm: NDArray[np.float64]
    heading_rad: NDArray[np.float64]
    scale: NDArray[np.float64]
    misfit: NDArray[np.float64]
    error_cm: NDArray[np.float64]
    error_rad: NDArray[np.float64]


def fit_poses(corners_cm: NDArray[np.float64], marker: MarkerParams) -> Poses:
    """Return the poses of patterns whose corners (n, 4, 2) lie there: the square that fits them best.

    Least squares over place, heading and size: with corners z and the square's own c, both complex and about their
    means, the factor a = sum(z conj(c)) / sum(c conj(c)) turns and scales it.
    """
    z = corners_cm[..., 0] + 1j * corners_cm[..., 1]
    middle = z.mean(axis=-1)
    own = marker.corners_cm[:, 0] + 1j * marker.corners_cm[:, 1]  # forward is the real axis
    size2 = float(np.sum(np.abs(own) ** 2))
    factor = (z - middle[:, None]) @ own.conj() / size2
    miss2 = np.sum(np.abs(z - middle[:, None] - factor[:, None] * own) ** 2, axis=-1)
    deviation = np.sqrt(miss2 / 4)  # of one coordinate of a corner: eight of them, four numbers fitted
    scale = np.abs(factor)
    return Poses(
        x_cm=middle.real,
        y_cm=middle.imag,
        heading_rad=np.angle(factor),
        scale=scale,
        misfit=np.sqrt(miss2 / 4) / marker.side_cm,
        error_cm=deviation * np.sqrt(2 / 4),  # x and y together, mean of four corners
        error_rad=deviation / (scale * np.sqrt(size2)),
    )
