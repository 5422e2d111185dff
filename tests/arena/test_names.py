"""Every public name of the arena is there, and nothing heavy is loaded for it before."""

import subprocess
import sys

from lobula import arena


def test_every_name_is_there() -> None:
    for name in arena.__all__:
        assert getattr(arena, name).__name__ == name
    assert set(arena.__all__) <= set(dir(arena))


def test_the_package_alone_loads_nothing() -> None:
    code = "import sys, lobula.arena; print('numpy' in sys.modules, callable(lobula.arena.run))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert out.split() == ["False", "True"]
