"""OpenCV, which knows the ID patterns: loaded when it is needed, from the extra ``opencv``."""

from __future__ import annotations

import importlib
from typing import Any

from ..errors import MissingExtraError, pip_install


def load_opencv() -> Any:
    """Return the module ``cv2``.

    Raises
    ------
    MissingExtraError : it is not installed, or too old to have ``cv2.aruco.ArucoDetector``
    """
    try:
        cv2 = importlib.import_module("cv2")
    except ImportError as error:
        raise MissingExtraError(f"ID patterns need OpenCV: {pip_install('opencv')}") from error
    if not hasattr(getattr(cv2, "aruco", None), "ArucoDetector"):
        version = getattr(cv2, "__version__", "of unknown version")
        raise MissingExtraError(f"ID patterns need OpenCV 4.9 or newer, found {version}: {pip_install('opencv')}")
    return cv2
