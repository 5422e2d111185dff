"""One picture from one image file."""

from __future__ import annotations

from os import PathLike, fspath
from typing import Any

import av

from ..errors import FrameSourceError


def read_still(path: str | PathLike[str]) -> Any | None:
    """Return the decoded picture of an image file, or None when it is no image or is damaged.

    Raises
    ------
    FrameSourceError : there is no such file, or it cannot be read
    """
    try:
        # through a Python file, so that a "%" or ":" in the name means nothing to FFmpeg
        with open(path, "rb") as file, av.open(file, "r") as container:
            return next(iter(container.decode(video=0)), None)
    except (av.FFmpegError, IndexError):
        return None
    except OSError as error:
        raise FrameSourceError(f"{fspath(path)}: {error.strerror or error}") from error
