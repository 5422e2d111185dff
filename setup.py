"""Build the C core as a plain shared library: one wheel serves every Python of a platform, and no headers are needed.

Everything else about the package stands in pyproject.toml. Where there is no C compiler the package installs without
the core and runs on its NumPy reference.
"""

import os
import shlex
import shutil
import subprocess
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_ext import build_ext
from setuptools.command.build_py import build_py

SOURCE = Path("core/src")
FLAGS = ["-std=c99", "-O3", "-fPIC", "-fvisibility=hidden", "-DLOBULA_LAPTOP", "-Icore/include"]
# The loops over pixels may fuse and reorder nothing else; never -ffast-math, which changes the caller's process.
LOOPS = ["-fno-math-errno", "-fno-trapping-math", "-fno-signed-zeros", "-ffinite-math-only", "-ffp-contract=fast"]
# Times, spikes and decisions are computed exactly as in Python.
SCALARS = ["-ffp-contract=off"]
VARIANTS = {
    "base": [],
    "v3": ["-march=x86-64", "-mavx2", "-mfma", "-mf16c", "-mtune=generic"],
    "v4": ["-march=x86-64", "-mavx512f", "-mavx512vl", "-mavx512bw", "-mavx512dq", "-mavx2", "-mfma",
           "-mprefer-vector-width=512", "-mtune=generic"],
}  # fmt: skip
LOOPS_OF: dict[str, dict[str, list[str]]] = {
    "sweep.c": {"": [], "compact": ["-DLOBULA_COMPACT_PLANES"]},
    "eye_sensor.c": {"": []},
}
"""Files with loops over pixels, each built for every variant; the network's also for every storage of its planes."""


class BuildCore(build_ext):
    """Compile ``core/src`` with $CC or cc into ``lobula/engine/liblobula.so``."""

    def get_ext_filename(self, fullname: str) -> str:
        return os.path.join(*fullname.split(".")) + ".so"

    def get_outputs(self) -> list[str]:
        return [path for path in super().get_outputs() if os.path.exists(path)]

    def build_extension(self, ext: Extension) -> None:
        target = Path(self.get_ext_fullpath(ext.name))
        try:
            self._compile(target)
        except (OSError, subprocess.CalledProcessError) as error:
            target.unlink(missing_ok=True)
            warnings.warn(
                f"the C core was not built ({error}); lobula will run on its slower NumPy reference", stacklevel=1
            )

    def _compile(self, target: Path) -> None:
        compiler = shlex.split(os.environ.get("CC", "cc"))
        machine = subprocess.run([*compiler, "-dumpmachine"], check=True, capture_output=True, text=True).stdout
        variants = list(VARIANTS) if machine.startswith("x86_64") else ["base"]
        dispatch = [f"-DLOBULA_WITH_{name.upper()}" for name in variants if name != "base"]
        folder = Path(self.build_temp) / "core"
        folder.mkdir(parents=True, exist_ok=True)
        target.parent.mkdir(parents=True, exist_ok=True)
        commands = {
            str(folder / f"{source.stem}{name}.o"): [*compiler, *FLAGS, *own, "-c", str(source)]
            for source in sorted(SOURCE.glob("*.c"))
            for name, own in _builds(source.name, variants, dispatch)
        }
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(self._call, ([*command, "-o", made] for made, command in commands.items())))
        strip = [] if sys.platform == "darwin" else ["-s"]
        self._call([*compiler, "-shared", *strip, "-o", str(target), *commands, "-lm"])

    def _call(self, command: list[str]) -> None:
        print(shlex.join(command))
        subprocess.run(command, check=True)


def _builds(source: str, variants: list[str], dispatch: list[str]) -> list[tuple[str, list[str]]]:
    """Return what an object file of ``source`` is called besides, and its own flags, for each of them."""
    if source not in LOOPS_OF:
        return [("", [*SCALARS, *dispatch])]
    return [
        (f"{variant}{storage}", [*LOOPS, *VARIANTS[variant], f"-DLOBULA_ISA={variant}", *flags])
        for variant in variants
        for storage, flags in LOOPS_OF[source].items()
    ]


class BuildPython(build_py):
    """Put the C sources that ``lobula export`` hands out into the package, side by side."""

    folder = "lobula/export/c"
    files = (*Path("core/robot/files.txt").read_text(encoding="utf-8").split(), "LICENSE")

    def run(self) -> None:
        super().run()
        if not self.editable_mode:  # a checkout has them in core
            target = Path(self.build_lib) / self.folder
            shutil.rmtree(target, ignore_errors=True)
            target.mkdir(parents=True)
            for name in self.files:
                shutil.copyfile(name, target / Path(name).name)

    def get_outputs(self, include_bytecode: bool = True) -> list[str]:
        own = [] if self.editable_mode else [f"{self.build_lib}/{self.folder}/{Path(name).name}" for name in self.files]
        return [*super().get_outputs(include_bytecode), *own]


class PlainWheel(bdist_wheel):
    """The library depends on the platform, not on the Python."""

    def get_tag(self) -> tuple[str, str, str]:
        return "py3", "none", super().get_tag()[2]


setup(
    ext_modules=[Extension("lobula.engine.liblobula", [], optional=True)],
    cmdclass={"build_ext": BuildCore, "build_py": BuildPython, "bdist_wheel": PlainWheel},
)
