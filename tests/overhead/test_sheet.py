"""Both kinds of sheet are measured: the PNG by finding its patterns, the PDF by reading its drawing."""

from __future__ import annotations

import re
import struct

import numpy as np
import pytest

from lobula.errors import ParameterError
from lobula.overhead import MarkerParams
from lobula.overhead.detection import MarkerFinder
from lobula.overhead.markers import marker_cells
from lobula.overhead.sheet import sheet

cv2 = pytest.importorskip("cv2")

IDS = (0, 1, 2, 3, 4, 5, 6, 46)


def test_a_png_has_every_pattern_in_true_size():
    data = sheet(IDS, ".png")
    place = data.index(b"pHYs")
    per_m = struct.unpack(">II", data[place + 4 : place + 12])
    assert per_m == (11811, 11811)  # 300 dpi
    page = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_GRAYSCALE)
    assert (page.shape[1] / per_m[0], page.shape[0] / per_m[1]) == pytest.approx((0.210, 0.297), abs=1e-4)
    found = MarkerFinder().find(page)
    assert sorted(found["id"].tolist()) == sorted(IDS)
    sides_m = np.linalg.norm(np.roll(found["corners_px"], 1, axis=1) - found["corners_px"], axis=2) / per_m[0]
    assert sides_m == pytest.approx(np.full(sides_m.shape, 0.024), rel=0.006)
    up = found["corners_px"][:, 0] - found["corners_px"][:, 3]  # from back left to front left
    assert (up[:, 1] < -100).all()  # forward points up the page


def test_a_pdf_draws_every_cell_in_true_size():
    text = sheet((7,), ".pdf", MarkerParams(disc_cm=5.0)).decode("latin-1")
    assert float(re.search(r"([\d.]+) 0 0 [\d.]+ 0 0 cm", text)[1]) == pytest.approx(72 / 2.54, abs=1e-5)
    width, height = map(float, re.search(r"MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", text).groups())
    assert (width * 2.54 / 72, height * 2.54 / 72) == pytest.approx((21.0, 29.7), abs=1e-3)
    cells = np.array(
        [list(map(float, one)) for one in re.findall(r"^([\d.]+) ([\d.]+) ([\d.]+) ([\d.]+) re$", text, re.M)]
    )
    assert len(cells) == marker_cells(7).sum()
    assert cells[:, 2:] == pytest.approx(np.full((len(cells), 2), 0.5))  # 5 cm * 0.6 / 6
    assert cells[:, :2].max(axis=0) + 0.5 - cells[:, :2].min(axis=0) == pytest.approx([3.0, 3.0])


def test_a_pdf_is_whole():
    """Each object starts where the table says, and the stream is as long as it says."""
    data = sheet(IDS, ".pdf")
    table = int(re.search(rb"startxref\n(\d+)", data)[1])
    assert data[table:].startswith(b"xref\n0 6\n")
    starts = [int(line) for line in re.findall(rb"^(\d{10}) 00000 n", data, re.M)]
    assert [data[start : start + 7] for start in starts] == [b"%d 0 obj" % (k + 1) for k in range(5)]
    length = int(re.search(rb"/Length (\d+)", data)[1])
    content = data[data.index(b"stream\n") + 7 : data.index(b"\nendstream")]
    assert len(content) == length


@pytest.mark.parametrize(
    ("ids", "suffix", "says"),
    [
        ((1,), ".svg", r"'\.svg': must be \.pdf or \.png"),
        ((), ".pdf", "different numbers"),
        ((1, 1), ".pdf", "different numbers"),
        ((50,), ".pdf", r"in 0\.\.49"),
        (range(40), ".pdf", "at most 20 fit a sheet"),
    ],
)
def test_wrong_requests(ids, suffix, says):
    with pytest.raises(ParameterError, match=says):
        sheet(ids, suffix)
