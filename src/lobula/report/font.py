"""Letters drawn as strokes: smooth text at any size, without a font file or an imaging library."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

CAP_HEIGHT = 6
"""Height of a capital letter in grid units; ``size_px`` everywhere is this height in pixels."""

_ASCENT, _DESCENT, _GAP = 1.0, 2.5, 1.9

# Each glyph is a set of strokes parted by "|"; each stroke a list of points "xy" on a grid 5 wide (x 0..4), row 0 the
# top of a capital, 6 the baseline, 8 the foot of a "g". A corner cut by one unit reads as a curve once it is drawn
# with a round pen. A stroke of two equal points is a dot.
_STROKES = {
    "A": "06 20 46|14 34",
    "B": "03 33 44 45 36 06 00 30 41 42 33",
    "C": "41 30 10 01 05 16 36 45",
    "D": "00 30 41 45 36 06 00",
    "E": "40 00 06 46|03 33",
    "F": "40 00 06|03 33",
    "G": "41 30 10 01 05 16 36 45 43 23",
    "H": "00 06|40 46|03 43",
    "I": "00 06",
    "J": "40 45 36 16 05",
    "K": "00 06|40 03 46",
    "L": "00 06 46",
    "M": "06 00 24 40 46",
    "N": "06 00 46 40",
    "O": "10 30 41 45 36 16 05 01 10",
    "P": "06 00 30 41 42 33 03",
    "Q": "10 30 41 45 36 16 05 01 10|24 47",
    "R": "06 00 30 41 42 33 03|23 46",
    "S": "41 30 10 01 02 13 33 44 45 36 16 05",
    "T": "00 40|20 26",
    "U": "00 05 16 36 45 40",
    "V": "00 26 40",
    "W": "00 16 22 36 40",
    "X": "00 46|40 06",
    "Y": "00 23 40|23 26",
    "Z": "00 40 06 46",
    "a": "42 46|43 32 12 03 05 16 36 45",
    "b": "00 06|03 12 32 43 45 36 16 05",
    "c": "43 32 12 03 05 16 36 45",
    "d": "40 46|43 32 12 03 05 16 36 45",
    "e": "04 44 43 32 12 03 05 16 36 45",
    "f": "30 20 11 16|02 32",
    "g": "42 47 38 18 07|43 32 12 03 05 16 36 45",
    "h": "00 06|03 12 32 43 46",
    "i": "02 06|00 00",
    "j": "12 17 08|10 10",
    "k": "00 06|32 04 36",
    "l": "00 05 16",
    "m": "02 06|03 12 23 26|23 32 43 46",
    "n": "02 06|03 12 32 43 46",
    "o": "12 32 43 45 36 16 05 03 12",
    "p": "02 08|03 12 32 43 45 36 16 05",
    "q": "42 48|43 32 12 03 05 16 36 45",
    "r": "02 06|03 12 32",
    "s": "43 32 12 03 14 34 45 36 16 05",
    "t": "10 15 26 36|02 32",
    "u": "02 05 16 36 45|42 46",
    "v": "02 26 42",
    "w": "02 16 23 36 42",
    "x": "02 46|42 06",
    "y": "02 26|42 26 18 08",
    "z": "02 42 06 46",
    "0": "10 30 41 45 36 16 05 01 10",
    "1": "11 20 26|16 36",
    "2": "01 10 30 41 42 06 46",
    "3": "01 10 30 41 42 33 44 45 36 16 05|33 23",
    "4": "36 30 04 44",
    "5": "40 00 02 32 43 45 36 16 05",
    "6": "41 30 10 01 05 16 36 45 44 33 13 04",
    "7": "00 40 16",
    "8": "13 02 01 10 30 41 42 33 13 04 05 16 36 45 44 33",
    "9": "05 16 36 45 41 30 10 01 02 13 33 42",
    " ": "",
    "-": "03 33",
    "+": "03 43|21 25",
    "=": "02 42|04 44",
    ".": "06 06",
    ",": "16 07",
    ":": "03 03|06 06",
    "/": "07 40",
    "%": "06 40|00 10 11 01 00|35 45 46 36 35",
    "(": "10 01 05 16",
    ")": "00 11 15 06",
    "_": "07 47",
    "<": "31 03 35",
    ">": "01 33 05",
    "!": "00 04|06 06",
    "?": "01 10 30 41 42 23 24|26 26",
    "'": "00 01",
    "|": "00 07",
    "#": "10 16|30 36|02 42|04 44",
}
_UNKNOWN = "00 40 46 06 00"


def text_mask(text: str, size_px: float = 12.0, weight: float = 0.9) -> NDArray[np.float32]:
    """Return ``text`` as an (h, w) map of ink, 0 to 1.

    Parameters
    ----------
    size_px : height of a capital letter; row 0 of the mask lies ``size_px / 6`` above it
    weight : width of the pen, in sixths of ``size_px``
    """
    height = round((CAP_HEIGHT + _ASCENT + _DESCENT) * size_px / CAP_HEIGHT)
    glyphs = [_glyph(letter, float(size_px), float(weight)) for letter in text]
    return np.concatenate([np.zeros((height, 0), np.float32), *glyphs], axis=1)


@lru_cache(maxsize=1024)
def _glyph(letter: str, size_px: float, weight: float) -> NDArray[np.float32]:
    unit = size_px / CAP_HEIGHT
    strokes = [
        [(float(xy[0]), float(xy[1])) for xy in stroke.split()]
        for stroke in _STROKES.get(letter, _UNKNOWN).split("|")
        if stroke
    ]
    wide = 4.0 if letter.isdigit() else max((x for stroke in strokes for x, _ in stroke), default=1.5)  # digits line up
    height, width = round((CAP_HEIGHT + _ASCENT + _DESCENT) * unit), round((wide + _GAP) * unit)
    rows, columns = np.mgrid[:height, :width] + 0.5
    x, y = columns / unit - _GAP / 2, rows / unit - _ASCENT
    distance = np.full((height, width), np.inf)
    for stroke in strokes:
        for (x0, y0), (x1, y1) in pairwise(stroke):
            along = ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / max((x1 - x0) ** 2 + (y1 - y0) ** 2, 1e-9)
            along = np.clip(along, 0.0, 1.0)
            distance = np.minimum(distance, np.hypot(x - x0 - along * (x1 - x0), y - y0 - along * (y1 - y0)))
    dots_only = all(len(set(stroke)) == 1 for stroke in strokes)
    pen = weight * (1.35 if dots_only else 1.0)  # a full stop as thin as a line is lost
    ink: NDArray[np.float32] = np.clip((pen / 2 - distance) * unit + 0.5, 0.0, 1.0).astype(np.float32)
    ink.setflags(write=False)
    return ink
