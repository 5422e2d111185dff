"""A killed run and a full disk leave files that read; run in a child process, which is what gets killed."""

import os
import resource
import signal
import subprocess
import sys
from pathlib import Path

import av
import numpy as np
import pytest

import lobula
from lobula.report.trace_file import read_trace

from .approach import table

KILLED = """
import os, signal
from pathlib import Path
from report.approach import FRAMES, HEADER, picture, reading
from lobula.report.trace import TraceWriter
from lobula.report.video import AnnotatedVideo
from lobula.report.recording import Recording
sinks = [TraceWriter("t.csv"), TraceWriter("t.npz"), AnnotatedVideo("out.mp4"), Recording("raw.mp4")]
for sink in sinks:
    sink.open(HEADER)
for index in range(2 * FRAMES):
    for sink in sinks:
        sink.frame(index, reading(index % FRAMES)._replace(time_s=index / 10), picture)
print(*(note for sink in sinks for note in sink.notes), sep="\\n", flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""

PARTS = [("t", ".csv"), ("out", ".mp4"), ("raw", ".mp4")]  # of the killed run

FULL = """
from report.approach import HEADER, SUMMARY, picture, reading
from lobula.errors import OutputError
from lobula.report.trace import TraceWriter
from lobula.report.video import AnnotatedVideo
for sink in TraceWriter("t.csv"), TraceWriter("t.jsonl"), AnnotatedVideo("out.mp4"):
    sink.open(HEADER)
    try:
        for index in range(4000):
            sink.frame(index, reading(index % 30)._replace(time_s=index / 10), picture)
    except OutputError as error:
        print(str(error).splitlines())
    sink.close(SUMMARY)
"""


def child(code: str, folder: Path, **more: object) -> subprocess.CompletedProcess[str]:
    tests = Path(__file__).parents[1]
    path = os.pathsep.join([str(tests), str(Path(lobula.__file__).parents[1])])
    return subprocess.run(
        [sys.executable, "-c", code],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        **more,
    )  # type: ignore[call-overload]


def frames_of(path: Path) -> int:
    with av.open(str(path)) as container:
        return sum(1 for _ in container.decode(video=0))


def test_killed_run_leaves_rows_and_a_video_that_plays(tmp_path: Path) -> None:
    done = child(KILLED, tmp_path)
    assert done.returncode == -signal.SIGKILL, done.stderr
    for name in ("t.csv", "t.part.csv"):
        assert np.array_equal(read_trace(tmp_path / name)["lgmd1"], np.tile(table()["lgmd1"], 2))
    for name in ("out", "raw"):
        assert not (tmp_path / f"{name}.mp4").exists()
        # 60 frames at 10 Hz; the file lacks its last, unfinished half second
        assert frames_of(tmp_path / f"{name}.part.mp4") >= 54


def test_the_same_run_again_leaves_what_the_killed_one_left(tmp_path: Path) -> None:
    child(KILLED, tmp_path)
    left = {(stem, suffix): (tmp_path / f"{stem}.part{suffix}").read_bytes() for stem, suffix in PARTS}
    done = child(KILLED.replace("2 * FRAMES", "FRAMES"), tmp_path)
    assert done.stdout.splitlines() == [
        f"{stem}.part{suffix} was left by an earlier run: it is {stem}.part-2{suffix} now" for stem, suffix in PARTS
    ]
    for (stem, suffix), data in left.items():
        assert (tmp_path / f"{stem}.part-2{suffix}").read_bytes() == data
        assert (tmp_path / f"{stem}.part{suffix}").stat().st_size < len(data)


@pytest.mark.skipif(sys.platform != "linux", reason="a file size limit stands in for the disk")
def test_full_disk_half_way_leaves_whole_rows_and_a_video_that_plays(tmp_path: Path) -> None:
    def small_disk() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, 60_000))
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

    done = child(FULL, tmp_path, preexec_fn=small_disk)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert len(lines) == 3
    assert all(line.startswith("['cannot write ") and line.count("',") == 0 for line in lines)
    for name in ("t.csv", "t.jsonl"):
        text = (tmp_path / name).read_text()
        assert text.endswith("\n")
        assert len(read_trace(tmp_path / name)) > 300
    assert not (tmp_path / "out.mp4").exists()
    assert frames_of(tmp_path / "out.part.mp4") > 0
