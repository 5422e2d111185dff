"""Light that changes while nothing moves, through the whole run: a camera that sets its exposure, and mains flicker.

Synthetic pictures with sensor noise; how bands of a rolling shutter differ from this is in docs/live.md.
"""

from __future__ import annotations

import numpy as np
import pytest

from lobula import Network
from lobula.frames import open as open_frames
from lobula.runtime.loop import run
from lobula.runtime.outputs import Outputs

from .test_watch import RecordingSink

HEIGHT, WIDTH = 72, 99
MAINS_DEPTH = 0.15  # how far a lamp's light swings about its mean


def lit(gains, seed=0):
    """A textured still scene at 30 Hz under light of each of ``gains``, with noise of 1.5 grey levels."""
    rng = np.random.default_rng(seed)
    rows, columns = np.mgrid[:HEIGHT, :WIDTH]
    scene = 90 + 40 * np.sin(columns / 7) + 20 * np.cos(rows / 5) + rng.normal(0, 5, (HEIGHT, WIDTH))
    noise = rng.normal(0, 1.5, (len(gains), HEIGHT, WIDTH))
    return np.clip(np.rint(scene * np.asarray(gains)[:, None, None] + noise), 0, 255).astype(np.uint8)


def outcome_of(images, rate_hz=30.0):
    sink = RecordingSink()
    with open_frames(images, rate_hz=rate_hz) as source:
        outcome = run(source, Network(), Outputs([sink], print), {"type": "header"})
    return outcome.summary["collisions"], [r["state"] for r in sink.records if r["phase"] == "start"]


@pytest.mark.parametrize("gain", [0.5, 0.7, 1.4, 1.8])
@pytest.mark.parametrize("frames", [1, 6])
def test_an_exposure_step_is_a_flash_and_no_collision(gain, frames):
    gains = np.concatenate([np.ones(60), np.linspace(1, gain, frames + 1)[1:], np.full(60, gain)])
    collisions, states = outcome_of(lit(gains))
    assert collisions == 0
    assert set(states) == {"warming_up", "flash"}


@pytest.mark.parametrize(
    ("mains_hz", "rate_hz"), [(50, 24.9), (50, 29.97), (50, 30), (60, 25), (60, 29.9), (60, 29.97)]
)
def test_mains_flicker_is_no_collision(mains_hz, rate_hz):
    times_s = np.arange(120) / rate_hz
    # a lamp lights up twice in a period; each picture meets it in another phase, but for rates that divide it
    gains = 1 + MAINS_DEPTH * np.sin(2 * np.pi * 2 * mains_hz * times_s + 0.3)
    assert np.ptp(gains) > MAINS_DEPTH
    collisions, _ = outcome_of(lit(gains), rate_hz)
    assert collisions == 0
