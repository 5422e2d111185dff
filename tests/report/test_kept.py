"""Clips of alarms: which frames are in them, which alarms share one, what a full disk does to them."""

import errno
import os
import re
from pathlib import Path

import av
import numpy as np
import pytest

from lobula.errors import OutputError, ParameterError
from lobula.report import ring
from lobula.report.kept import KeptClips
from lobula.report.trace_file import read_trace
from lobula.runtime.sinks import OutputLapseError

from .approach import HEADER, SUMMARY, reading
from .test_crash import child

RATE_HZ = 10
REJOIN = 5  # frames until the end of an alarm is told


def grey(index):
    return 30 + 7 * (index % 30)


def shown(index, noise=None):
    picture = np.full((48, 64, 3), grey(index), np.uint8)
    return picture if noise is None else noise.integers(0, 255, (48, 64, 3), np.uint8)


def records(index, alarms):
    for number, (start, end) in enumerate(alarms, 1):
        about = {"type": "collision", "id": number}
        if index == start:
            yield {**about, "phase": "start", "frame": index, "time_s": index / RATE_HZ}
        if index == end + REJOIN:
            yield {**about, "phase": "end", "frame": end, "time_s": end / RATE_HZ}


def feed(sink, numbers, alarms=(), event_first=True, noise=None):
    """Give frames ``numbers`` at 10 Hz; an alarm is (its first frame, the first one after it)."""
    for index in numbers:
        told = list(records(index, alarms))
        for record in told if event_first else ():
            sink.event(record)
        image = shown(index, noise)
        sink.frame(index, reading(0)._replace(time_s=index / RATE_HZ), lambda image=image: image)
        for record in () if event_first else told:
            sink.event(record)


def told(sink, numbers, alarms, close=True, noise=None):
    """Feed on, to the end with ``close``, and return what the sink says of clips that are lost."""
    said = []
    for call in (*((feed, sink, [n], alarms, True, noise) for n in numbers), (KeptClips.close, sink, SUMMARY)):
        if call[0] is feed or close:
            try:
                call[0](*call[1:])
            except OutputLapseError as error:
                said.append(str(error))
    return said


def kept(folder, count, alarms, **how):
    sink = KeptClips(folder, 1.0, 0.5)
    sink.open(HEADER)
    feed(sink, range(count), alarms, **how)
    sink.close(SUMMARY)
    return clips(folder)


def clips(folder):
    """Numbers of the frames of each clip, by its trace and by the greys of its pictures, oldest first."""
    found = []
    for path in sorted(folder.glob("*.mp4")):
        assert re.fullmatch(r"collision-\d{8}-\d{6}Z-\d{4}\.mp4", path.name)
        numbers = read_trace(path.with_suffix(".csv"))["frame"].tolist()
        with av.open(str(path)) as container:
            frames = list(container.decode(video=0))
            assert "0123456789ab" in container.metadata["comment"]
        assert [f.time for f in frames] == pytest.approx([(n - numbers[0]) / RATE_HZ for n in numbers], abs=1e-4)
        greys = [f.to_ndarray(format="rgb24")[24, 32, 0] for f in frames]
        assert np.abs(np.array(greys, int) - [grey(n) for n in numbers]).max() <= 4
        found.append(numbers)
    return found


@pytest.mark.parametrize("event_first", [True, False])
def test_a_clip_holds_what_was_before_and_after_its_alarm(tmp_path, event_first):
    # the alarm lasts from 3.0 to 3.5 s: from the key frame at 2.0 s to 4.0 s
    (numbers,) = kept(tmp_path, 80, [(30, 35)], event_first=event_first)
    assert numbers == list(range(20, 41))
    assert len(list(tmp_path.iterdir())) == 2


def test_between_key_frames_it_begins_up_to_a_second_earlier(tmp_path):
    (numbers,) = kept(tmp_path, 80, [(36, 40)])
    assert numbers == list(range(20, 46))  # a second before 3.6 s lies after the key frame at 2 s


def test_alarms_close_together_share_a_clip(tmp_path):
    (numbers,) = kept(tmp_path, 99, [(30, 33), (39, 41), (47, 50)])
    assert numbers == list(range(20, 56))


def test_alarms_apart_have_one_each(tmp_path):
    assert kept(tmp_path, 99, [(20, 22), (50, 52)]) == [list(range(10, 28)), list(range(40, 58))]


def test_an_alarm_in_the_first_frame_and_one_to_the_last(tmp_path):
    assert kept(tmp_path, 60, [(0, 3), (58, 70)]) == [list(range(9)), list(range(40, 60))]


def test_no_alarm_no_clip(tmp_path):
    assert kept(tmp_path / "deep" / "er", 30, []) == []
    assert (tmp_path / "deep" / "er").is_dir()


def test_a_source_that_goes_away_ends_its_clip(tmp_path):
    sink = KeptClips(tmp_path, 1.0, 5.0)
    sink.open(HEADER)
    feed(sink, range(34), [(30, 32)])
    sink.event({"type": "collision", "id": 1, "phase": "end", "frame": 32, "time_s": 3.2})
    sink.event({"type": "source", "phase": "lost", "frame": 33, "time_s": 3.4, "reason": "cable out"})
    sink.event({"type": "state", "state": "stale", "phase": "start", "frame": 33, "time_s": 3.4})
    feed(sink, range(34, 60))
    sink.close(SUMMARY)
    assert clips(tmp_path) == [list(range(20, 34))]


def test_a_pause_of_hours_ends_a_clip(tmp_path):
    """Too long for an MP4, in the middle of an alarm; the clip of the next alarm holds nothing from before it."""
    sink = KeptClips(tmp_path, 1.0, 0.5)
    sink.open(HEADER)
    late = 10 * 30_000
    alarms = [(30, late + 5), (late + 32, late + 35)]
    assert told(sink, [*range(40), *range(late, late + 60)], alarms) == []
    assert clips(tmp_path) == [list(range(20, 40)), list(range(late + 20, late + 41))]


def test_an_alarm_right_after_a_pause_of_hours(tmp_path):
    late = 10 * 30_000
    sink = KeptClips(tmp_path, 1.0, 0.5)
    sink.open(HEADER)
    assert told(sink, [*range(40), *range(late, late + 30)], [(late, late + 3)]) == []
    assert clips(tmp_path) == [list(range(late, late + 9))]


def test_a_killed_run_leaves_a_clip_that_plays(tmp_path):
    sink = KeptClips(tmp_path, 1.0, 3.0)
    sink.open(HEADER)
    feed(sink, range(60), [(30, 35)])  # and nothing after that
    (part,) = tmp_path.glob("*.part.mp4")
    with av.open(str(part)) as container:
        assert sum(1 for _ in container.decode(video=0)) >= 35  # frames 20 to 59, but for the last half second
    (rows,) = tmp_path.glob("*.csv")
    assert read_trace(rows)["frame"].tolist() == list(range(20, 60))
    sink.close(SUMMARY)


def test_memory_is_bounded_and_a_clip_that_begins_late_is_told_once(tmp_path, monkeypatch):
    monkeypatch.setattr(ring.Ring.__init__, "__defaults__", (30_000,))
    noise = np.random.default_rng(0)
    sink = KeptClips(tmp_path, 10.0, 0.5)
    sink.open(HEADER)
    feed(sink, range(60), noise=noise)
    assert sink._ring.size_bytes <= 30_000
    with pytest.raises(OutputLapseError, match=r"clips begin less than 10 s before an alarm: so much changes"):
        feed(sink, range(60, 90), [(65, 67)], noise=noise)
    feed(sink, range(66, 99), [(65, 67), (75, 77)], noise=noise)
    sink.close(SUMMARY)
    assert len(list(tmp_path.glob("collision-*.mp4"))) == 2


def test_a_clip_that_cannot_be_finished_is_told_and_the_next_one_tried(tmp_path):
    sink = KeptClips(tmp_path, 1.0, 0.2)
    sink.open(HEADER)
    feed(sink, range(24), [(20, 22)])
    (part,) = tmp_path.glob("*.part.mp4")
    part.write_bytes(b"")  # somebody tampers with it
    said = told(sink, range(24, 60), [(20, 22), (40, 42)])
    assert len(said) == 1
    assert said[0].startswith("a clip of an alarm is lost: ")
    assert [p.name[-8:] for p in tmp_path.glob("collision-*.mp4") if ".part" not in p.name] == ["0002.mp4"]


FULL = """
import resource
import numpy as np
from lobula.report.kept import KeptClips
from report.test_kept import HEADER, feed, told
noise = np.random.default_rng(0)
sink = KeptClips("clips", 1.0, 0.5)
sink.open(HEADER)
alarms = [(20, 22), (40, 42), (60, 62)]
print(*told(sink, range(50), alarms, False, noise), sep="\\n")
resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
print(*told(sink, range(50, 80), alarms, True, noise), sep="\\n")
"""


def test_a_full_disk_is_told_once_and_survived(tmp_path):
    def small_disk():
        import resource
        import signal

        resource.setrlimit(resource.RLIMIT_FSIZE, (9_000, resource.RLIM_INFINITY))
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

    done = child(FULL, tmp_path, preexec_fn=small_disk)
    assert done.returncode == 0, done.stderr
    first, last = done.stdout.splitlines()
    assert re.match(r"a clip of an alarm is lost: cannot write clips/collision-\S+-0001\.mp4: File too large", first)
    assert last == "clips: 2 clips of alarms are lost in all"
    whole = [p for p in (tmp_path / "clips").glob("*.mp4") if ".part" not in p.name]
    assert [p.name[-8:] for p in whole] == ["0003.mp4"]
    with av.open(str(whole[0])) as container:
        assert sum(1 for _ in container.decode(video=0)) > 15


@pytest.mark.parametrize(("before_s", "after_s", "says"), [
    (-1, 3, r"before an alarm \(--keep-before\): -1: must be 0 to 600"),
    (10, 601, r"after an alarm \(--keep-after\): 601: must be 0 to 600"),
    (float("nan"), 3, "before an alarm .* nan: must be"),
])  # fmt: skip
def test_times_that_are_none(tmp_path, before_s, after_s, says):
    with pytest.raises(ParameterError, match=says):
        KeptClips(tmp_path, before_s, after_s)


def test_a_folder_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    sink = KeptClips(tmp_path / "file" / "clips")
    with pytest.raises(OutputError, match=r"^cannot write .*file/clips: "):
        sink.open(HEADER)
    sink.close(SUMMARY)


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="needs a folder that takes no files from anybody, root too")
def test_a_folder_that_takes_no_files_is_found_before_the_first_frame():
    sink = KeptClips("/proc")
    with pytest.raises(OutputError, match=r"^cannot write /proc: no file can be made there$"):
        sink.open(HEADER)
    sink.close(SUMMARY)


def test_a_folder_one_may_not_write_into_is_found_before_the_first_frame(tmp_path, monkeypatch):
    def denied(path, *more, **named):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "open", denied)  # root may
    sink = KeptClips(tmp_path)
    with pytest.raises(OutputError, match=rf"^cannot write {tmp_path}: no permission$"):
        sink.open(HEADER)
    sink.close(SUMMARY)


def test_looking_into_the_folder_leaves_nothing_there(tmp_path):
    KeptClips(tmp_path).open(HEADER)
    assert list(tmp_path.iterdir()) == []


def test_a_disk_that_is_full_at_the_start_may_have_room_later(tmp_path, monkeypatch):
    def full(**_):
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("lobula.report.kept.TemporaryFile", full)
        sink = KeptClips(tmp_path / "clips")
        sink.open(HEADER)
    sink.close({})
