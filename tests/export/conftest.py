"""A C compiler, where there is one."""

import shutil

import pytest


@pytest.fixture(scope="session")
def compiler():
    found = shutil.which("cc")
    if found is None:
        pytest.skip("no C compiler: cc")
    return found
