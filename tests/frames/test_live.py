"""Live sources: the newest frame, drops counted, errors that travel, no thread that hangs."""

from __future__ import annotations

import http.server
import threading
import time
from contextlib import contextmanager

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError
from lobula.frames import FrameSequence, FrameStream
from lobula.frames.geometry import View
from lobula.frames.selection import Selection

from .clips import image_bytes, moving_bar, write_clip
from .scripted_camera import ScriptedCamera, picture, wait_until


@contextmanager
def stream(selection=None, **options):
    camera = ScriptedCamera()
    with FrameStream(camera, View(), selection or Selection(), **options) as frames:
        try:
            yield camera, frames
        finally:
            camera.give(None)


def slowly(frames):
    for frame in frames:
        yield frame
        time.sleep(0.05)


def test_newest_frame_wins_and_the_rest_is_counted():
    with stream() as (camera, frames):
        camera.give(*(picture(i) for i in range(5)))
        wait_until(lambda: frames.dropped == 4)
        assert frames.poll(5).index == 4
        assert frames.poll(0.01) is None
        camera.give(picture(5))
        frame = frames.poll(5)
        assert (frame.index, frame.time_s, frames.dropped) == (5, 5 / 30, 4)
        np.testing.assert_array_equal(frame.image, 5)
        np.testing.assert_array_equal(frames.picture(), 5)


def test_silence_is_no_error_for_poll_but_for_next():
    with stream(timeout_s=0.05) as (_, frames):
        assert frames.poll(0.01) is None
        assert not frames.ended
        with pytest.raises(FrameSourceError, match=r"camera: no frame for 0\.05 s") as caught:
            next(frames)
        assert caught.value.on_the_way


@pytest.mark.parametrize("error", [FrameSourceError("camera: unplugged", on_the_way=True), RuntimeError("a bug")])
def test_errors_travel_after_the_frames_before_them(error):
    with stream() as (camera, frames):
        camera.give(picture(0), error)
        wait_until(camera.closed.is_set)
        assert frames.poll(5).index == 0
        with pytest.raises(type(error), match=str(error)):
            frames.poll(5)
        assert frames.ended


def test_end_of_the_stream_is_an_error():
    with stream() as (camera, frames):
        camera.give(picture(0), None)
        assert next(frames).index == 0
        with pytest.raises(FrameSourceError, match="camera: the stream ended") as caught:
            next(frames)
        assert caught.value.on_the_way


def test_wanted_stretch_ends_in_peace():
    with stream(Selection(end_s=0.05)) as (camera, frames):
        camera.give(picture(0), picture(1), picture(2))
        assert next(frames).index in (0, 1)
        assert [f.index for f in frames] in ([1], [])
        assert frames.ended


def test_most_frames():
    with stream(Selection(max_frames=2)) as (camera, frames):
        camera.give(picture(0))
        assert next(frames).index == 0
        camera.give(picture(1))
        assert [f.index for f in frames] == [1]
        assert frames.ended
        assert frames.poll(0) is None
        assert frames.frame_count == 2


def test_stamps_that_do_not_increase_are_left_out():
    with stream() as (camera, frames):
        camera.give(picture(0, 1.0), picture(1, 1.0), picture(2, 0.5), picture(3, 1.1))
        wait_until(lambda: frames.dropped >= 3)
        assert frames.poll(5).time_s == 1.1


def test_closing_stops_the_thread():
    with stream() as (camera, frames):
        camera.give(picture(0))
        camera.give(None)
        frames.close()
        assert not frames._thread.is_alive()
        assert camera.closed.is_set()
        assert frames.poll(0) is None


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    """A web camera at /camera (JPEG after JPEG), one that falls silent at /silent, a recording at /clip.mp4."""
    clip = write_clip(tmp_path_factory.mktemp("clips") / "clip.mp4", moving_bar(12))
    jpegs = [image_bytes(np.full((72, 99), 5 * i, np.uint8), "mjpeg", "yuvj420p") for i in range(20)]
    gone = threading.Event()

    class Handler(http.server.BaseHTTPRequestHandler):
        def log_message(self, *_):
            pass

        def do_GET(self):
            self.send_response(200)
            if self.path == "/clip.mp4":
                self.send_header("Content-Length", str(clip.stat().st_size))
                self.end_headers()
                self.wfile.write(clip.read_bytes())
                return
            self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
            self.end_headers()
            try:
                for jpeg in jpegs:
                    head = b"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n" % len(jpeg)
                    self.wfile.write(head + jpeg + b"\r\n")
                    self.wfile.flush()
                    time.sleep(0.02)
                if self.path == "/silent":
                    gone.wait(10)
            except OSError:
                pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    gone.set()
    server.shutdown()
    server.server_close()


def test_web_camera_gives_the_newest_frame(address):
    with lobula.frames.open(f"{address}/camera", timeout_s=5) as frames:
        assert isinstance(frames, FrameStream)
        assert frames.live
        got = []
        with pytest.raises(FrameSourceError) as caught:
            got.extend(slowly(frames))
        assert caught.value.on_the_way
        assert got[-1].index == 19
        assert frames.dropped == 20 - len(got)
    for frame in got:
        np.testing.assert_allclose(frame.image, 5.0 * frame.index, atol=3)
    # the demuxer would claim 25 pictures a second; the clock says they come 20 ms apart
    assert (np.diff([f.time_s for f in got]) > 0).all()


def test_web_camera_that_falls_silent(address):
    with lobula.frames.open(f"{address}/silent", timeout_s=0.5) as frames:
        seen = []
        with pytest.raises(FrameSourceError, match=r"no frame for 0\.5 s|nothing came in time"):
            seen.extend(frames)
        assert seen


def test_recording_at_an_address_gives_every_frame(address):
    with lobula.frames.open(f"{address}/clip.mp4") as frames:
        assert isinstance(frames, FrameSequence)
        assert [f.index for f in frames] == list(range(12))


def test_nobody_answers():
    with pytest.raises(FrameSourceError, match=r"rtsp://127\.0\.0\.1:9/x: Connection refused: must be the address"):
        lobula.frames.open("rtsp://user:secret@127.0.0.1:9/x", timeout_s=2)
