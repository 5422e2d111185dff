"""PNG files without an imaging library: deflate does the work."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import ShapeError
from ..landing import whole_file

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_COLOUR_TYPE = {2: 0, 3: 2}  # grey, RGB


def encode_png(picture: NDArray[np.uint8]) -> bytes:
    """Return an (h, w) grey or (h, w, 3) RGB picture, uint8, as a PNG, without loss.

    Raises
    ------
    ShapeError : another shape or type

    Source: PNG specification, ISO/IEC 15948.
    """
    if picture.dtype != np.uint8 or picture.ndim not in _COLOUR_TYPE or picture.shape[2:] not in ((), (3,)):
        raise ShapeError(f"png: {picture.dtype} {picture.shape}: must be uint8, (h, w) grey or (h, w, 3) RGB")
    height, width = picture.shape[:2]
    lines = np.zeros((height, 1 + picture[0].size), np.uint8)  # each line begins with its filter: 0, none
    lines[:, 1:] = picture.reshape(height, -1)
    head = struct.pack(">IIBBBBB", width, height, 8, _COLOUR_TYPE[picture.ndim], 0, 0, 0)
    return _SIGNATURE + b"".join(
        _chunk(name, data)
        for name, data in ((b"IHDR", head), (b"IDAT", zlib.compress(lines.tobytes())), (b"IEND", b""))
    )


def write_png(path: str | Path, picture: NDArray[np.uint8]) -> None:
    """Write ``picture`` to ``path``, whole or not at all.

    Raises
    ------
    ShapeError : not a picture
    OutputError : the file cannot be written
    """
    data = encode_png(picture)
    with whole_file(Path(path)) as temporary:
        temporary.write_bytes(data)


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
