"""Sheets of ID patterns at their true size, to print and cut out: A4, as PDF (exact, vectors) or PNG (300 dpi)."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from .markers import CELLS, MarkerParams, marker_cells, require_ids
from .opencv import load_opencv

SHEET_SUFFIXES = (".pdf", ".png")
PAGE_CM = (21.0, 29.7)

_MARGIN_CM, _GAP_CM, _LABEL_CM = 1.5, 0.5, 0.6
_RULER_CM = 10.0
_PT_PER_CM = 72 / 2.54
_PX_PER_CM = 300 / 2.54
_ROUND = 0.5523  # of the radius: Bezier handles that make a quarter of a circle


def sheet(ids: Sequence[int], suffix: str, marker: MarkerParams | None = None) -> bytes:
    """Return a page with the patterns ``ids`` as a file of the kind ``suffix``, one of ``SHEET_SUFFIXES``.

    Each disc has a short line at its rim that points forward, and its number below; a ruler of 10 cm shows whether the
    printer kept the scale.

    Raises
    ------
    ParameterError : another suffix, ids that are not different numbers of the dictionary, or more than fit the page
    MissingExtraError : OpenCV is not installed
    """
    marker = marker or MarkerParams()
    numbers = require_ids(list(ids), "ids")
    if suffix not in SHEET_SUFFIXES:
        raise ParameterError(f"sheet of ID patterns: {suffix!r}: must be {' or '.join(SHEET_SUFFIXES)}")
    places = _places(len(numbers), marker.disc_cm)
    draw = _pdf if suffix == ".pdf" else _png
    return draw(list(zip(numbers, places, strict=True)), marker)


def _places(count: int, disc_cm: float) -> list[tuple[float, float]]:
    """Middles of the discs, cm from the page's lower left corner, line by line from the top."""
    width, height = PAGE_CM
    step_x, step_y = disc_cm + _GAP_CM, disc_cm + _GAP_CM + _LABEL_CM
    columns = int((width - 2 * _MARGIN_CM + _GAP_CM) // step_x)
    rows = int((height - 3 * _MARGIN_CM + _GAP_CM) // step_y)  # the ruler has the third margin
    if count > columns * rows:
        raise ParameterError(f"{count} ID patterns of {disc_cm:g} cm: at most {columns * rows} fit a sheet")
    return [
        (
            _MARGIN_CM + disc_cm / 2 + (k % columns) * step_x,
            height - _MARGIN_CM - disc_cm / 2 - (k // columns) * step_y,
        )
        for k in range(count)
    ]


def _pdf(discs: list[tuple[int, tuple[float, float]]], marker: MarkerParams) -> bytes:
    lines = [f"{_PT_PER_CM:.6f} 0 0 {_PT_PER_CM:.6f} 0 0 cm", "0.02 w"]  # from here on in cm
    radius, cell = marker.disc_cm / 2, marker.side_cm / CELLS
    for number, (x, y) in discs:
        lines += [_circle(x, y, radius), f"{x:.4f} {y + radius:.4f} m {x:.4f} {y + 0.9 * radius:.4f} l S"]
        for row, column in np.argwhere(marker_cells(number)).tolist():
            left, low = x + (column - CELLS / 2) * cell, y + (CELLS / 2 - row - 1) * cell
            lines.append(f"{left:.4f} {low:.4f} {cell:.4f} {cell:.4f} re")
        lines.append("f")  # all cells in one go: no seams between them
        lines.append(_text(x - 0.15, y - radius - 0.45, str(number)))
    lines += [_text(_MARGIN_CM, 1.35, "10 cm"), f"{_MARGIN_CM} 1 m {_MARGIN_CM + _RULER_CM} 1 l S"]
    lines += [f"{_MARGIN_CM + k} 0.9 m {_MARGIN_CM + k} 1.1 l S" for k in range(int(_RULER_CM) + 1)]
    return _pdf_file("\n".join(lines).encode("ascii"))


def _circle(x: float, y: float, radius: float) -> str:
    points = radius * np.array([(1, _ROUND), (_ROUND, 1), (0, 1)]) + 0.0
    path = [f"{x + radius:.4f} {y:.4f} m"]
    for _ in range(4):
        path.append(" ".join(f"{x + dx:.4f} {y + dy:.4f}" for dx, dy in points) + " c")
        points = np.column_stack([-points[:, 1], points[:, 0]])  # the next quarter
    return "\n".join([*path, "S"])


def _text(x: float, y: float, words: str) -> str:
    return f"BT /F 0.35 Tf {x:.4f} {y:.4f} Td ({words}) Tj ET"


def _pdf_file(content: bytes) -> bytes:
    """Wrap the content of one page as a PDF file. Source: ISO 32000-1."""
    width, height = (side * _PT_PER_CM for side in PAGE_CM)
    objects = [
        b"<< /Type /Catalog /Pages 2 0 R >>",
        b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width:.3f} {height:.3f}] /Contents 4 0 R "
        "/Resources << /Font << /F 5 0 R >> >> >>".encode(),
        b"<< /Length %d >>\nstream\n%s\nendstream" % (len(content), content),
        b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>",
    ]
    file = bytearray(b"%PDF-1.4\n")
    starts = []
    for number, body in enumerate(objects, 1):
        starts.append(len(file))
        file += b"%d 0 obj\n%s\nendobj\n" % (number, body)
    table = len(file)
    file += b"xref\n0 %d\n0000000000 65535 f \n" % (len(objects) + 1)
    file += b"".join(b"%010d 00000 n \n" % start for start in starts)
    file += b"trailer\n<< /Size %d /Root 1 0 R >>\nstartxref\n%d\n%%%%EOF\n" % (len(objects) + 1, table)
    return bytes(file)


def _png(discs: list[tuple[int, tuple[float, float]]], marker: MarkerParams) -> bytes:
    cv2 = load_opencv()
    width, height = (round(side * _PX_PER_CM) for side in PAGE_CM)
    page = np.full((height, width), 255, np.uint8)
    sixteenth = 4  # bits of a pixel's fraction that OpenCV draws with

    def at(x: float, y: float) -> tuple[int, int]:
        return round(x * _PX_PER_CM * 2**sixteenth), round((PAGE_CM[1] - y) * _PX_PER_CM * 2**sixteenth)

    radius = marker.disc_cm / 2
    side = round(marker.side_cm * _PX_PER_CM)
    # whole pixels for the square; its cells divide it as evenly as they can
    cell_of = np.arange(side) * CELLS // side
    for number, (x, y) in discs:
        cv2.circle(page, at(x, y), round(radius * _PX_PER_CM * 2**sixteenth), 0, 2, cv2.LINE_AA, sixteenth)
        cv2.line(page, at(x, y + radius), at(x, y + 0.9 * radius), 0, 2, cv2.LINE_AA, sixteenth)
        left, top = (round(value / 2**sixteenth - side / 2) for value in at(x, y))
        page[top : top + side, left : left + side][marker_cells(number)[np.ix_(cell_of, cell_of)]] = 0
        _write(page, x - 0.15, y - radius - 0.45, str(number))
    _write(page, _MARGIN_CM, 1.35, "10 cm")
    cv2.line(page, at(_MARGIN_CM, 1), at(_MARGIN_CM + _RULER_CM, 1), 0, 2, cv2.LINE_AA, sixteenth)
    for k in range(int(_RULER_CM) + 1):
        cv2.line(page, at(_MARGIN_CM + k, 0.9), at(_MARGIN_CM + k, 1.1), 0, 2, cv2.LINE_AA, sixteenth)
    data = bytes(cv2.imencode(".png", page)[1])
    per_m = round(_PX_PER_CM * 100)
    return data[:33] + _chunk(b"pHYs", struct.pack(">IIB", per_m, per_m, 1)) + data[33:]  # after the head


def _write(page: NDArray[np.uint8], x: float, y: float, words: str) -> None:
    cv2 = load_opencv()
    place = round(x * _PX_PER_CM), round((PAGE_CM[1] - y) * _PX_PER_CM)
    cv2.putText(page, words, place, cv2.FONT_HERSHEY_SIMPLEX, 1.2, 0, 2, cv2.LINE_AA)


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
