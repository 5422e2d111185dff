"""The public names: one checked-in list, and nothing loaded before it is wanted."""

from __future__ import annotations

import math
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lobula
from lobula.errors import LobulaError

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


@pytest.mark.parametrize("params", ["paper", "foo", 3, {"decision": {}}])
def test_a_network_of_something_else_than_settings_is_refused_at_once(params: Any) -> None:
    with pytest.raises(LobulaError, match=re.escape('must be NetworkParams, such as lobula.preset("paper")')):
        lobula.Network(params)


@pytest.mark.parametrize("rate", [math.nan, math.inf, "fast"])
def test_a_yaw_rate_that_is_no_finite_number_is_refused(rate: Any) -> None:
    with pytest.raises(LobulaError, match=r"yaw_rate_deg_s = .*: must be a finite number"):
        lobula.Network().step(np.zeros((72, 99), np.uint8), 0.0, yaw_rate_deg_s=rate)


def test_a_time_that_is_text_is_refused() -> None:
    with pytest.raises(LobulaError, match="time 'a': must be a number of seconds"):
        lobula.Network().step(np.zeros((72, 99), np.uint8), "a")  # type: ignore[arg-type]  # what is tested
