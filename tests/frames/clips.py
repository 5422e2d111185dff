"""Writes little clips, pictures and damaged files for the tests of this folder."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from numpy.typing import NDArray

WIDTH, HEIGHT = 96, 64


def moving_bar(count: int, width: int = WIDTH, height: int = HEIGHT) -> list[NDArray[np.uint8]]:
    """Grey pictures, each of another brightness (frame i: 20 + 5 i, up to 235), with a white bar that moves right."""
    pictures = []
    for i in range(count):
        picture = np.full((height, width), 20 + 5 * (i % 44), np.uint8)
        picture[:, (4 * i) % width : (4 * i) % width + 4] = 235
        pictures.append(picture)
    return pictures


def as_frame(y: NDArray[np.uint8], pixel_format: str) -> av.VideoFrame:
    """A frame whose luma plane holds ``y`` exactly, colourless; planar YUV, grey or, through swscale, RGB."""
    height, width = y.shape
    if not pixel_format.startswith(("yuv", "gray")):
        return av.VideoFrame.from_ndarray(y, "gray").reformat(format=pixel_format)
    frame = av.VideoFrame(width, height, pixel_format)
    shift = frame.format.components[0].bits - 8  # deeper formats hold the same value with zeros below
    kind = np.dtype("<u2" if shift else np.uint8)
    for number, plane in enumerate(frame.planes):
        rows = np.full((plane.height, plane.line_size // kind.itemsize), 128 << shift, kind)
        if number == 0:
            rows[:, :width] = y.astype(kind) << shift
        plane.update(rows.tobytes())
    return frame


def write_clip(
    path: Path,
    pictures: Sequence[NDArray[np.uint8]],
    *,
    codec: str = "libx264",
    pixel_format: str = "yuv420p",
    rate: int = 30,
    stamps: Sequence[int] | None = None,
    time_base: Fraction | None = None,
    options: dict[str, str] | None = None,
    container_options: dict[str, str] | None = None,
    color_range: int = 0,
) -> Path:
    """Encode ``pictures`` as they are (their values are the luma plane); ``stamps`` count in ``time_base``."""
    with av.open(str(path), "w", options=container_options or {}) as container:
        stream = container.add_stream(codec, rate=rate)
        stream.height, stream.width = pictures[0].shape
        stream.pix_fmt = pixel_format
        stream.options = options or {}
        stream.codec_context.time_base = time_base or Fraction(1, rate)
        if color_range:
            stream.codec_context.color_range = color_range
        for i, picture in enumerate(pictures):
            frame = as_frame(picture, pixel_format)
            frame.pts = i if stamps is None else stamps[i]
            frame.time_base = time_base or Fraction(1, rate)
            if color_range:
                frame.color_range = color_range
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    return path


def write_lossless(path: Path, pictures: Sequence[NDArray[np.uint8]], pixel_format: str = "gray") -> Path:
    """A clip whose pictures come back bit for bit; the path must end in .mkv or .avi."""
    return write_clip(path, pictures, codec="ffv1", pixel_format=pixel_format)


def write_sizes(path: Path, first: Sequence[NDArray[np.uint8]], then: Sequence[NDArray[np.uint8]]) -> Path:
    """An AVI of JPEG pictures that changes its size in the middle: the packets of two encoders in one stream."""
    with av.open(str(path), "w") as container:
        stream = container.add_stream("mjpeg", rate=30)
        stream.height, stream.width = first[0].shape
        stream.pix_fmt = "yuvj420p"
        for i, picture in enumerate([*first, *then]):
            encoder = av.CodecContext.create("mjpeg", "w")
            encoder.height, encoder.width = picture.shape
            encoder.pix_fmt = "yuvj420p"
            encoder.time_base = Fraction(1, 30)
            frame = as_frame(picture, "yuvj420p")
            frame.pts = i
            for packet in encoder.encode(frame):
                packet.stream = stream
                packet.pts = packet.dts = i
                packet.time_base = Fraction(1, 30)
                container.mux(packet)
    return path


def image_bytes(picture: NDArray[np.uint8], codec: str = "png", pixel_format: str = "gray") -> bytes:
    """One image file as bytes."""
    encoder = av.CodecContext.create(codec, "w")
    encoder.height, encoder.width = picture.shape
    encoder.pix_fmt = pixel_format
    encoder.time_base = Fraction(1, 25)
    frame = as_frame(picture, pixel_format)
    frame.pts = 0
    return b"".join(bytes(packet) for packet in [*encoder.encode(frame), *encoder.encode(None)])


def turn_clockwise(path: Path) -> Path:
    """Make the movie header of an MP4 ask for a quarter turn clockwise when shown, as telephones do.

    The matrix (a, b, u, c, d, v, x, y, w) of the track header maps (p, q) to (a p + c q, b p + d q): with a = d = 0,
    b = 1 and c = -1 what points right comes to point down. Source: ISO/IEC 14496-12, 8.3.2.
    """
    one, minus_one, unit_w = (n.to_bytes(4, "big") for n in (0x10000, 0xFFFF0000, 0x40000000))
    zero = bytes(4)
    upright = one + zero * 3 + one + zero * 3 + unit_w
    turned = zero + one + zero + minus_one + zero * 4 + unit_w
    data = path.read_bytes()
    track = data.index(b"tkhd")
    where = data.index(upright, track)
    path.write_bytes(data[:where] + turned + data[where + len(turned) :])
    return path
