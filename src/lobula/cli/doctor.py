"""``lobula doctor``: what was found on this machine, what is missing and how to get it."""

from __future__ import annotations

import platform
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from .._version import __version__
from ..errors import pip_install
from . import options as o
from .call import new_app

app = new_app()

EXTRAS = {
    "plot": (("matplotlib",), "figures, as of lobula plot"),
    "parquet": (("pyarrow",), "traces in .parquet"),
    "opencv": (("cv2",), "lobula track, robots seen from above"),
    "dashboard": (("starlette", "uvicorn", "websockets"), "lobula serve, the page"),
    "tune": (("optuna", "matplotlib"), "lobula tune"),
    "pettingzoo": (("gymnasium", "pettingzoo"), "the arena as an environment"),
    "dask": (("distributed",), "a cluster for lobula batch"),
    "mqtt": (("paho",), "--hook mqtt://, records to a broker"),
    "mavlink": (("pymavlink", "serial"), "--hook mavlink:, alarms for an autopilot"),
    "foxglove": (("foxglove",), "--hook foxglove:, a live view in Foxglove"),
    "mcap": (("mcap",), "--hook mcap:, recordings for Foxglove"),
    "rosbags": (("rosbags",), "ROS bags: --hook rosbag:, and as a source"),
    "rerun": (("rerun",), "--hook rerun:, recordings for Rerun"),
    "bench": (("scipy", "cv2"), "the comparisons of lobula bench"),
}
"""Extra -> its modules, and what it is for."""


@app.command()
def doctor(json: o.Json = False) -> None:
    """Show the engine, the codecs, the cameras and the optional parts: found, or missing and how to get them."""
    from .print_json import print_json
    from .table import table

    found = examine()
    if json:
        print_json(found)
        return
    rows = [(name, _text(value)) for name, value in found.items() if name not in ("extras", "missing")]
    rows += [(f"extra {name}", "found" if there else "missing") for name, there in found["extras"].items()]
    print(table(("what", "found"), rows))
    print("\n" + ("\n".join(f"missing: {line}" for line in found["missing"]) or "nothing is missing"))


def examine() -> dict[str, Any]:
    """Return everything that was found, ready for JSON; ``missing`` holds one line for each thing to get."""
    missing = []
    engine = _engine()
    if engine["engine"] != "core":
        missing.append(
            f"the C core ({engine['why_not']}): install a C compiler, then, in the clone, `pip install "
            "--force-reinstall --no-deps .`; until then the NumPy reference runs"
        )
    codecs = _codecs()
    if not codecs.get("h264_encoder"):
        missing.append("an H.264 encoder, needed by --annotate and lobula stimulus: pip install --force-reinstall av")
    extras = {name: all(find_spec(module) for module in modules) for name, (modules, _) in EXTRAS.items()}
    missing += [f"{EXTRAS[name][1]}: {pip_install(name)}" for name, there in extras.items() if not there]
    return {
        "lobula": __version__,
        "python": platform.python_version(),
        "executable": sys.executable,
        "numpy": _version("numpy"),
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        **engine,
        **codecs,
        "cameras": sorted(str(path) for path in Path("/dev").glob("video*")),
        "extras": extras,
        "missing": missing,
    }


def _engine() -> dict[str, Any]:
    from ..engine import library

    there = library.available()
    return {
        "engine": "core" if there else "reference",
        "library": str(library.FILE) if there else None,
        "isa": library.isa() if there else None,
        "isas": list(library.isas()),
        "why_not": library.why_not() or None,
    }


def _codecs() -> dict[str, Any]:
    import av

    return {
        "av": av.__version__,
        "ffmpeg": av.ffmpeg_version_info,
        "h264_decoder": _opens("h264", "r"),
        "hevc_decoder": _opens("hevc", "r"),
        "mjpeg_decoder": _opens("mjpeg", "r"),
        "h264_encoder": _opens("libx264", "w"),
    }


def _opens(codec: str, mode: Any) -> bool:
    import av

    try:
        av.codec.Codec(codec, mode)
    except ValueError:  # what PyAV raises for a codec it was built without
        return False
    return True


def _version(module: str) -> str:
    from importlib.metadata import version

    return version(module)


def _text(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(map(str, value)) or "none"
    if value is None:
        return "-"
    return ("no", "yes")[value] if isinstance(value, bool) else str(value)
