import os

import pytest

pytest.importorskip("optuna", reason="the extra tune is not installed")


@pytest.fixture(autouse=True, scope="session")
def _no_waiting_for_the_disk():
    """A journal waits for the disk at each line; what a power cut leaves is not tested here."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda file: None)
        yield
