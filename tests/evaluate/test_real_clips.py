"""The labelled clips, where they are: the floor that the default preset must hold. No constant is tuned on them."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import lobula
from lobula.evaluate.clips import Failure, score_clips
from lobula.evaluate.labels import read_labels
from lobula.evaluate.summary import summarise

CLIPS = Path(os.environ.get("LOBULA_CLIPS") or Path(__file__).parents[2] / "../shared/clips")


@pytest.mark.skipif(not (CLIPS / "labels.csv").is_file(), reason="no labelled clips: set LOBULA_CLIPS to their folder")
def test_at_least_7_of_11_collisions_and_at_most_3_false_alarms_a_minute():
    net = lobula.Network()

    def fresh():
        net.reset()
        return net

    scores = list(score_clips(read_labels(CLIPS / "labels.csv"), CLIPS, fresh))
    assert not [score for score in scores if isinstance(score, Failure)]
    total = summarise(scores).headline
    assert total.collisions == 11
    assert total.hits >= 7
    assert total.per_minute <= 3
    assert total.hits / total.collisions > 3 * total.chance_hit_rate
