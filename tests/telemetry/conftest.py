"""A robot for every test that wants one."""

from __future__ import annotations

import pytest

from .robots import Robot


@pytest.fixture
def robot(tmp_path):
    robot = Robot(tmp_path)
    yield robot
    robot.close()
