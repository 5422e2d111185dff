"""A web camera without a camera: an approach every ten seconds, as JPEG after JPEG over HTTP on loopback.

    python benchmarks/web_camera.py --rate 30 --scale 6

prints its address and serves until it is stopped. For trying `lobula run ADDRESS`, and for ``soak.py``.
"""

from __future__ import annotations

import argparse
import http.server
import time
from fractions import Fraction

import av
import numpy as np
from numpy.typing import NDArray

from lobula import stimuli

PAUSE_S = 7.0
"""The scene is still for so long, but for noise, between two approaches."""


def approach_and_pause(rate_hz: float, scale: int) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    """Return pictures (n, 72 scale, 98 scale) and the order in which they make an approach and a pause."""
    movie = stimuli.looming(scene="arena", speed_cm_s=12.0, rate_hz=rate_hz)
    images = movie.images[:, :, :98]
    rng = np.random.default_rng(0)
    still = np.clip(images[0] + rng.normal(0, 2, (30, *images[0].shape)), 0, 255)
    pictures = np.concatenate([images, np.rint(still).astype(np.uint8)])
    pause = len(images) + rng.integers(0, len(still), round(PAUSE_S * rate_hz))
    large = pictures.repeat(scale, axis=1).repeat(scale, axis=2)
    return large, np.concatenate([np.arange(len(images)), pause])


def jpegs(pictures: NDArray[np.uint8]) -> list[bytes]:
    """Return each picture as a JPEG."""
    encoder = av.CodecContext.create("mjpeg", "w")
    encoder.height, encoder.width = pictures[0].shape
    encoder.pix_fmt, encoder.time_base, encoder.thread_count = "yuvj420p", Fraction(1, 1000), 1
    encoder.options = {"qmin": "4", "qmax": "4"}
    frames = (av.VideoFrame.from_ndarray(picture, "gray").reformat(format="yuvj420p") for picture in pictures)
    return [b"".join(bytes(packet) for packet in encoder.encode(frame)) for frame in frames]


def main() -> None:
    """Serve until stopped."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rate", type=float, default=30.0, help="pictures per second")
    parser.add_argument("--scale", type=int, default=6, help="6 gives 588 x 432 px")
    parser.add_argument("--port", type=int, default=0, help="a free one if left out")
    options = parser.parse_args()
    pictures, order = approach_and_pause(options.rate, options.scale)
    coded = jpegs(pictures)

    class Handler(http.server.BaseHTTPRequestHandler):
        def log_message(self, *_: object) -> None:
            pass

        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=picture")
            self.end_headers()
            begun_s, count = time.monotonic(), 0
            try:
                while True:
                    time.sleep(max(0.0, begun_s + count / options.rate - time.monotonic()))
                    jpeg = coded[order[count % len(order)]]
                    head = f"--picture\r\nContent-Type: image/jpeg\r\nContent-Length: {len(jpeg)}\r\n\r\n"
                    self.wfile.write(head.encode() + jpeg + b"\r\n")
                    self.wfile.flush()
                    count += 1
            except OSError:
                pass  # who looked has gone

    server = http.server.ThreadingHTTPServer(("127.0.0.1", options.port), Handler)
    server.daemon_threads = True
    print(f"http://127.0.0.1:{server.server_port}/", flush=True)
    server.serve_forever()


if __name__ == "__main__":
    main()
