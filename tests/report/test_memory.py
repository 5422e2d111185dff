"""What was freed goes back, though something small lies above it."""

from __future__ import annotations

import ctypes
import os
from pathlib import Path

import pytest

from lobula.report.memory import give_back

C = ctypes.CDLL(None)
PIECE, PIECES = 64 * 1024, 1000  # each below what glibc asks the system for on its own; 62.5 MB together


def held_bytes():
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not hasattr(C, "malloc_trim"), reason="the C library is not glibc")
def test_what_is_free_below_something_that_is_not_goes_back():
    C.malloc.restype, C.malloc.argtypes, C.free.argtypes = ctypes.c_void_p, [ctypes.c_size_t], [ctypes.c_void_p]
    pieces = [C.malloc(PIECE) for _ in range(PIECES)]
    for piece in pieces:
        ctypes.memset(piece, 1, PIECE)
    *most, last = pieces
    for piece in most:
        C.free(piece)
    before = held_bytes()
    give_back()
    after = held_bytes()
    C.free(last)
    assert before - after > 0.9 * PIECE * PIECES
