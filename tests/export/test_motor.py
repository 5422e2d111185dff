"""The motor queue in C keeps step with the arena's: the same phases in every tick, whatever alarms come."""

import ctypes
import math
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lobula.arena.motion import FORWARD, STOP, TURN, Motion
from lobula.arena.world import World

ROBOT = Path(__file__).parents[2] / "core" / "robot"
LEFT, RIGHT = 2, 3
"""The C names both sides of ``TURN``."""


class Motor(ctypes.Structure):
    _fields_ = (
        ("action", ctypes.c_int), ("turn_deg_s", ctypes.c_float), ("elapsed_ms", ctypes.c_float),
        ("chance", ctypes.c_uint32),
    )  # fmt: skip


@pytest.fixture(scope="session")
def core(tmp_path_factory, compiler):
    library = tmp_path_factory.mktemp("motor") / "motor.so"
    subprocess.run([compiler, "-std=c99", "-shared", "-fPIC", str(ROBOT / "motor.c"), "-o", str(library)], check=True)
    loaded = ctypes.CDLL(str(library))
    loaded.lobula_motor_pass.argtypes = [ctypes.c_void_p, ctypes.c_float]
    loaded.lobula_motor_wheels.argtypes = [ctypes.c_void_p, ctypes.c_float, ctypes.c_float, ctypes.c_void_p]
    return loaded


@pytest.fixture
def motor(core):
    fresh = Motor()
    core.lobula_motor_init(ctypes.byref(fresh), 11)
    return fresh


@pytest.mark.parametrize("rate_hz", [15.0, 25.0, 30.0, 40.0, 60.0])
@pytest.mark.parametrize("often", [0.02, 0.3, 1.0])
def test_it_goes_through_the_arenas_phases(core, motor, rate_hz, often):
    world = World(camera=replace(World().camera, rate_hz=rate_hz))
    rngs = [np.random.default_rng([3, i]) for i in range(3)]
    arena = Motion(world, np.array([[10.0, 20.0, 0.0]]), rngs[:1], rngs[1])
    alarms = rngs[2].random(1500) < often
    at = ctypes.byref(motor)
    seen = set()
    for tick, alarm in enumerate(alarms):
        if tick:  # the time since the picture before has gone by
            arena.chords()
            arena.advance()
            turning = core.lobula_motor_pass(at, 1000.0 / rate_hz)
            assert turning == arena.turning[0]
        if alarm:
            arena.avoid([0])
        core.lobula_motor_decide(at, int(alarm))
        phase = motor.action if motor.action in (FORWARD, STOP) else TURN
        assert phase == arena.phases[0], tick
        seen.add(motor.action)
    assert seen >= {STOP, LEFT, RIGHT}


def test_its_turns_obey_the_arenas_law(core, motor):
    law, at = World().turn, ctypes.byref(motor)
    angles = []
    for _ in range(1000):
        assert core.lobula_motor_decide(at, 1) == 1
        angles.append(motor.turn_deg_s * law.turn_s)
        core.lobula_motor_pass(at, 1000.0 * law.stop_s)
        assert motor.action == (LEFT if angles[-1] > 0 else RIGHT)
        core.lobula_motor_pass(at, 1000.0 * law.turn_s)
        assert motor.action == FORWARD
    size = np.abs(angles)
    assert law.low_deg <= size.min() + 1e-3
    assert size.max() <= law.high_deg + 1e-3
    share = np.sort(size - law.low_deg) / (law.high_deg - law.low_deg)
    assert np.abs(share - (np.arange(1000) + 0.5) / 1000).max() < 1.63 / math.sqrt(1000)  # Kolmogorov, 1 in 100
    assert abs((np.array(angles) > 0).mean() - 0.5) < 0.05


def test_left_is_the_arenas_left(core, motor):
    """The arena's headings grow counter-clockwise, so the right wheel goes ahead in a turn to the left."""
    wheels = (ctypes.c_float * 2)()
    motor.action, motor.turn_deg_s = LEFT, 90.0
    track_cm = World().robots.track_cm
    core.lobula_motor_wheels(ctypes.byref(motor), 8.0, track_cm, wheels)
    assert (wheels[1] - wheels[0]) / track_cm == pytest.approx(math.radians(90), rel=1e-6)


@pytest.mark.parametrize("turn_ms", ["0", "0.5f", "-800.0f"])
def test_a_turn_in_no_time_does_not_compile(turn_ms, compiler, tmp_path):
    command = [compiler, "-std=c99", f"-DLOBULA_MOTOR_TURN_MS={turn_ms}", "-c", ROBOT / "motor.c"]
    done = subprocess.run([*command, "-o", tmp_path / "motor.o"], capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert "lobula_motor_turn_ms_is_1_or_more" in done.stderr
