"""The public names: one checked-in list, and nothing loaded before it is wanted."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import lobula

NAMES = ["Frame", "LobulaError", "Network", "NetworkParams", "Reading", "Spikes", "__version__", "open", "preset",
         "stimuli"]  # fmt: skip


def test_the_list_of_names():
    assert sorted(lobula.__all__) == NAMES
    assert set(NAMES) <= set(dir(lobula))
    for name in NAMES:
        assert getattr(lobula, name) is getattr(lobula, name)


def test_a_name_that_is_not_there():
    with pytest.raises(AttributeError, match="module 'lobula' has no attribute 'netwrok'"):
        _ = lobula.netwrok


def test_importing_loads_nothing_else():
    program = "import sys; import lobula; print(sorted(m for m in sys.modules if m.startswith(('lobula.', 'numpy'))))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True,
                          env={"PYTHONPATH": str(Path(lobula.__file__).parents[1])})  # fmt: skip
    assert done.stdout.strip() == "['lobula._version']"


def test_the_lines_of_the_contract(tmp_path):
    movie = lobula.stimuli.looming(scene="arena", speed_cm_s=12)
    net = lobula.Network()
    reading = net.step(movie.images[0], 0.0)
    assert (reading.time_s, reading.collision, reading.state) == (0.0, False, "warming_up")
    assert reading.spikes == (0, 0, 0, 0)
    net.reset()
    block = net.run(movie.images, movie.times_s)
    assert block.shape == (len(movie),)
    state = net.state_dict()
    other = lobula.Network(lobula.preset("published", neurons="all"), engine="reference")
    other.reset()
    net.load_state_dict(state)
    with lobula.open(movie) as frames:
        alarms = [frame.time_s for frame in frames if other.step(frame).collision]
    assert alarms
    assert alarms[0] < movie.contact_s
