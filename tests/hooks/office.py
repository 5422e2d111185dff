"""Hooks that do as they are told, and a run's calls without a run."""

from __future__ import annotations

import signal
import subprocess
import sys
import textwrap
import threading
import time

from lobula.hooks import Hook, PostOffice
from lobula.types import Reading, Spikes

HEADER = {"type": "header", "version": "1", "source": "movie", "thresholds": {}, "settings": []}
SUMMARY = {"type": "summary", "status": "ok", "frames": 3}
START = {
    "type": "collision", "phase": "start", "id": 1, "frame": 57, "time_s": 1.9,
    "lgmd1": 0.93, "lgmd2": 0.91, "lptc_r": 0.02, "lptc_l": -0.01,
}  # fmt: skip
END = {"type": "collision", "phase": "end", "id": 1, "frame": 66, "time_s": 2.2, "peak_frame": 61}


def reading(time_s, lgmd1=0.5):
    return Reading(time_s, lgmd1, 0.6, 0.25, -0.125, Spikes(1, 2, 3, 4), False, "ok")


def event(number):
    return {"type": "state", "state": "flash", "phase": "start", "frame": number, "time_s": number / 30}


def wait_until(true):
    """Wait until ``true()`` is, at most for as long as no machine needs."""
    deadline_s = time.monotonic() + 30
    while not true():
        assert time.monotonic() < deadline_s, "it never came"
        time.sleep(0.005)


def opened(*hooks, readings_hz=None, retry_s=0.01, close_s=20.0):
    """A post office at work; the waits are short where a peer comes back, long where everything must arrive."""
    office = PostOffice(hooks, readings_hz, retry_s=retry_s, close_s=close_s)
    office.open(HEADER)
    return office


def delivered(hook, *records, readings=()):
    """Send these records through ``hook`` to the end, and return its counts."""
    office = opened(hook)
    for index, one in enumerate(readings):
        office.frame(index, one, None)
    for record in records:
        office.event(record)
    office.close(SUMMARY)
    (tally,) = office.tallies()
    return tally


def killed_while_running(target, when=lambda: True):
    """Have another process send 100 readings and START to ``target``; kill it once they are sent and ``when()`` is."""
    program = f"""
        import time
        from lobula.hooks import make_hook
        from tests.hooks.office import START, opened, reading, wait_until
        office = opened(make_hook({str(target)!r}))
        for index in range(100):
            office.frame(index, reading(index / 30), None)
        office.event(START)
        wait_until(lambda: office.tallies()[0]["sent"] == 101)
        print("told", flush=True)
        time.sleep(60)
    """
    command = [sys.executable, "-c", textwrap.dedent(program)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout.readline() == "told\n"
            wait_until(when)
        finally:
            process.send_signal(signal.SIGKILL)


class Scripted(Hook):
    """Notes what it was given. ``plan`` holds what the next sends do: take the message (None), or raise this."""

    def __init__(self, plan=(), connects=(), name="scripted"):
        super().__init__(name)
        self.plan, self.connects = list(plan), list(connects)
        self.calls, self.got = [], []

    def connect(self, header):
        self.calls.append("connect")
        error = self.connects.pop(0) if self.connects else None
        if error:
            raise error

    def send(self, message):
        self.calls.append("send")
        error = self.plan.pop(0) if self.plan else None
        if error:
            raise error
        self.got.append(message)

    def disconnect(self):
        self.calls.append("disconnect")

    @property
    def frames(self):
        return [m.record.get("frame") for m in self.got]


class Hanging(Hook):
    """Hangs in its first send until it is let go."""

    def __init__(self, name="hanging"):
        super().__init__(name)
        self.inside, self.go, self.aborted, self.got = threading.Event(), threading.Event(), False, []

    def send(self, message):
        self.inside.set()
        self.go.wait(60)
        self.got.append(message)

    def abort(self):
        self.aborted = True
