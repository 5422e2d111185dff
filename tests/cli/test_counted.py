"""Numbers of things read as English does."""

from __future__ import annotations

import pytest

from lobula.cli.counted import counted


@pytest.mark.parametrize(
    ("number", "text"), [(0, "0 collisions"), (1, "1 collision"), (2, "2 collisions"), (11, "11 collisions")]
)
def test_one_is_singular_and_every_other_number_plural(number, text):
    assert counted(number, "collision") == text
