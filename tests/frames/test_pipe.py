"""Raw pictures and self-describing streams from a pipe."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError, ParameterError
from lobula.frames import FrameStream
from lobula.frames.geometry import View
from lobula.frames.pipe import open_pipe
from lobula.frames.selection import Selection
from lobula.frames.source import FrameSequence

from .clips import moving_bar, write_clip

PICTURES = np.stack(moving_bar(5, 64, 48))


def read(data, pixel_format, size=(64, 48), **options):
    reader = open_pipe(pixel_format, size, file=io.BytesIO(data), **options)
    with FrameSequence(reader, View(size=size), Selection()) as frames:
        return list(frames), frames


def raw(pixel_format):
    half = np.full((5, 48 * 32), 128, np.uint8)
    packed = np.full((5, 48, 128), 128, np.uint8)
    packed[:, :, 0::2] = PICTURES
    flat = PICTURES.reshape(5, -1)
    return {
        "gray8": flat,
        "yuv420p": np.hstack([flat, half[:, : 24 * 32], half[:, : 24 * 32]]),
        "yuvj422p": np.hstack([flat, half, half]),
        "nv12": np.hstack([flat, half]),
        "yuyv422": packed.reshape(5, -1),
        "rgb24": np.repeat(flat, 3, axis=1),
    }[pixel_format].tobytes()


@pytest.mark.parametrize("pixel_format", ["gray8", "yuvj422p", "rgb24", "yuv420p", "nv12", "yuyv422"])
def test_pixel_formats(pixel_format):
    got, frames = read(raw(pixel_format), pixel_format, rate_hz=25)
    limited = pixel_format in ("yuv420p", "nv12", "yuyv422")
    expected = (PICTURES - 16.0) * 255 / 219 if limited else PICTURES
    np.testing.assert_allclose(np.stack([f.image for f in got]), expected, atol=1e-3)
    np.testing.assert_allclose([f.time_s for f in got], np.arange(5) / 25)
    assert (frames.fps, frames.live, frames.dropped, frames.notes) == (25.0, False, 0, [])


def test_odd_sizes():
    data = np.random.default_rng(0).integers(16, 236, (2, 49 * 65 + 2 * 25 * 33), np.uint8)
    got, _ = read(data.tobytes(), "yuv420p", (65, 49))
    expected = (data[:, : 49 * 65].reshape(2, 49, 65) - 16.0) * 255 / 219
    np.testing.assert_allclose(np.stack([f.image for f in got]), expected, atol=1e-3)


def test_last_picture_cut_short_is_noted():
    got, frames = read(PICTURES.tobytes()[:-100], "gray8")
    assert len(got) == 4
    assert frames.notes == ["-: the last picture is cut short: left out; check input_size (--input-size)"]
    assert frames.damaged == 0


@pytest.mark.parametrize("data", [b"", b"x" * 100])
def test_not_one_whole_picture(data):
    with pytest.raises(FrameSourceError, match="-: no whole 64 x 48 gray8 picture: must hold 3072 bytes each"):
        read(data, "gray8")


def test_a_stream_that_says_what_it_is(tmp_path):
    path = write_clip(tmp_path / "a.mkv", moving_bar(6))
    with (
        FrameSequence(open_pipe(file=io.BytesIO(path.read_bytes())), View(), Selection()) as piped,
        lobula.frames.open(path) as whole,
    ):
        for from_pipe, from_file in zip(piped, whole, strict=True):
            assert from_pipe.time_s == from_file.time_s
            np.testing.assert_array_equal(from_pipe.image, from_file.image)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("gray8", None), "must be given both pixel_format and input_size"),
        ((None, (64, 48)), "must be given both pixel_format and input_size"),
        (("grey7", (64, 48)), "pixel_format = 'grey7': must be gray8, yuv420p, nv12, yuyv422 or another"),
    ],
)
def test_refuses(arguments, message):
    with pytest.raises(ParameterError, match=message):
        open_pipe(*arguments, file=io.BytesIO(b""))


def test_unrecognised_stream():
    with pytest.raises(FrameSourceError, match="-: not a stream that FFmpeg recognises: raw pictures need"):
        open_pipe(file=io.BytesIO(bytes(range(256)) * 100))


def test_standard_input_is_read_as_it_comes():
    code = (
        "import lobula.frames\n"
        "with lobula.frames.open('-', pixel_format='gray8', input_size=(64, 48), size=(64, 48)) as frames:\n"
        "    for f in frames: print(f.index, int(f.image[0, 63]), flush=True)\n"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as child:
        for i, picture in enumerate(PICTURES):
            child.stdin.write(picture.tobytes())
            child.stdin.flush()
            # the answer comes before the next picture is sent: nothing is held back
            assert child.stdout.readline().split() == [b"%d" % i, b"%d" % picture[0, 63]]
        child.stdin.close()
        assert child.wait(20) == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_ends_the_wait_for_data(number):
    code = (
        "import lobula.frames, signal\n"
        "class Stop(BaseException): pass\n"
        "def stop(*_): raise Stop\n"
        "signal.signal(signal.SIGTERM, stop)\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in jobs that a shell starts behind\n"
        "frames = lobula.frames.open('-', pixel_format='gray8', input_size=(64, 48))\n"
        "try:\n"
        "    for f in frames: print(f.index, flush=True)\n"
        "except (KeyboardInterrupt, Stop) as reason: print(type(reason).__name__)\n"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as child:
        child.stdin.write(PICTURES[0].tobytes())
        child.stdin.flush()
        assert child.stdout.readline() == b"0\n"
        child.send_signal(number)
        assert child.stdout.readline() == (b"KeyboardInterrupt\n" if number == signal.SIGINT else b"Stop\n")
        assert child.wait(20) == 0


def last_of(frames, least):
    """Poll on until a frame of number ``least`` or later came."""
    while (frame := frames.poll(5)) is None or frame.index < least:
        pass
    return frame


@pytest.mark.parametrize("kind", ["raw", "y4m"])
def test_a_live_pipe_gives_the_newest_picture_at_the_time_it_came(kind):
    head, mark = (b"YUV4MPEG2 W64 H48 F30:1 Cmono\n", b"FRAME\n") if kind == "y4m" else (b"", b"")
    how = ("gray8", (64, 48)) if kind == "raw" else (None, None)
    reading, writing = os.pipe()
    begun_s = time.monotonic()
    with open(reading, "rb", buffering=0) as file, open(writing, "wb", buffering=0) as feed:
        feed.write(head + b"".join(mark + picture.tobytes() for picture in PICTURES[:4]))
        with FrameStream(open_pipe(*how, file=file, live=True), View(size=(64, 48)), Selection()) as frames:
            first = last_of(frames, 3)
            time.sleep(0.3)
            feed.write(mark + PICTURES[4].tobytes())
            second = last_of(frames, 4)
            assert begun_s < first.captured_s < second.captured_s < time.monotonic()
            assert frames.fps == 30.0
            assert second.time_s - first.time_s > 0.25  # by the clock, not by the rate that it claims
            np.testing.assert_allclose(second.image, PICTURES[4], atol=1e-3)
            feed.close()
            with pytest.raises(FrameSourceError, match="-: the stream ended"):
                last_of(frames, 5)
