"""A robot on a serial line, without a robot: looks at a movie and tells what it decides, as the firmware does.

    python examples/serial_robot.py            once through the movie, four seconds
    python examples/serial_robot.py forever    over and over, until Ctrl-C

It prints the name of a port. In another terminal, watch it there with `lobula run` or `lobula serve`.
"""

import contextlib
import itertools
import os
import sys
import time
import tty

import lobula
from lobula.params import settings_hash
from lobula.telemetry import RobotHello, RobotReading, hello_frame, reading_frame

RATE_HZ = 30
HELLO_EVERY = 32  # readings

robot_end, watched_end = os.openpty()  # a pseudo-terminal: what is written into one end comes out of the other
tty.setraw(watched_end)
os.set_blocking(robot_end, False)
print(f"serial:{os.ttyname(watched_end)}", flush=True)

params = lobula.preset("default")
lptc = params.lptc.spiking.threshold
thresholds = (params.lgmd1.spiking.threshold, params.lgmd2.spiking.threshold, lptc, -lptc)
hello = RobotHello(
    99, 72, params.decision.neurons, RATE_HZ, thresholds, settings_hash(params), "default", lobula.__version__
)


def send(frame: bytes) -> None:
    """Like a wire: if nobody listens, it is gone."""
    with contextlib.suppress(BlockingIOError):
        os.write(robot_end, frame)


net = lobula.Network(params)
images = lobula.stimuli.looming(scene="arena").images
rounds = itertools.count() if "forever" in sys.argv else range(1)
begun_s = due_s = time.monotonic()
collisions, number, alarm, avoiding_until = 0, 0, False, -1

try:
    for image in (image for _ in rounds for image in images):
        due_s = max(due_s + 1 / RATE_HZ, time.monotonic())  # a picture that is late does not hurry the next
        time.sleep(max(0.0, due_s - time.monotonic()))
        step_s = time.perf_counter()
        reading = net.step(image, time_s=number / RATE_HZ)
        step_us = round(1e6 * (time.perf_counter() - step_s))
        if reading.collision and not alarm:
            collisions += 1
            avoiding_until = number + RATE_HZ  # the wheels stop for 0.2 s and turn for 0.8 s
        alarm = reading.collision
        left = avoiding_until - number
        action = "forward" if left <= 0 else "stop" if left > 0.8 * RATE_HZ else "turn_left"
        potentials = (reading.lgmd1, reading.lgmd2, reading.lptc_r, reading.lptc_l)
        told = RobotReading(
            sequence=number, frame=number, time_ms=round(1000 * (due_s - begun_s)), potentials=potentials,
            spikes=reading.spikes, collision=reading.collision, state=reading.state, action=action, step_us=step_us,
        )  # fmt: skip
        if number % HELLO_EVERY == 0:
            send(hello_frame(hello))
        send(reading_frame(told))
        number += 1
except KeyboardInterrupt:
    pass
print(f"{number} readings sent, collisions: {collisions}")
