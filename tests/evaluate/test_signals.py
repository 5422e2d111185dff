"""Signals of frame difference and flow, and the alarms a threshold makes of them."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from lobula.errors import MissingExtraError
from lobula.evaluate.labels import Label
from lobula.evaluate.signals import SIGNALS, SignalTrace, divergence, load_opencv, score_signal, signal_trace
from lobula.types import Frame

CRASH = Label(file="clip", contact_frame=60, uncertainty_frames=0, kind="crash")
NONE = Label(file="clip", contact_frame=None, uncertainty_frames=0, kind="none")


def test_divergence_of_a_field_that_grows():
    rows, columns = np.mgrid[0:20, 0:30].astype(np.float32)
    growing = np.stack([0.1 * columns, 0.1 * rows], axis=-1)
    assert divergence(growing) == pytest.approx(np.full((20, 30), 0.2), abs=1e-5)  # 0.1 along each axis
    turning = np.stack([-0.1 * rows, 0.1 * columns], axis=-1)
    assert divergence(turning) == pytest.approx(np.zeros((20, 30)), abs=1e-5)


class TestSignals:
    cv2 = pytest.importorskip("cv2", reason="the extra opencv is not installed")

    def texture(self, scale, shift=0):
        """A wall of soft blobs seen ``scale`` times as large about the middle."""
        rows, columns = np.mgrid[0:120, 0:160].astype(float)
        y, x = (rows - 59.5) / scale, (columns - 79.5 - shift) / scale
        waves = sum(np.sin(x * a + y * b + a) for a, b in ((0.2, 0.05), (-0.1, 0.22), (0.13, -0.17), (0.05, 0.3)))
        return (128 + 25 * waves).astype(np.float32)

    def test_a_wall_that_comes_diverges_as_it_grows(self):
        images = [self.texture(1.02**i) for i in range(4)]
        trace = signal_trace((Frame(image, i / 10, i) for i, image in enumerate(images)), "fast")
        # 2 % a frame along both axes, 10 frames a second: 2 * 0.02 * 10 = 0.4 / s
        assert trace.signals["mean divergence, middle half"][1:] == pytest.approx([0.4] * 3, rel=0.2)
        assert (trace.signals["mean divergence"][1:] > 0.2).all()  # DIS sees less of it along the border

    def test_a_wall_that_passes_does_not(self):
        images = [self.texture(1.0, shift=2 * i) for i in range(4)]
        trace = signal_trace((Frame(image, i / 10, i) for i, image in enumerate(images)), "fast")
        assert np.abs(trace.signals["mean divergence, middle half"][1:]).max() < 0.1

    def test_differences_by_hand(self):
        images = [np.full((24, 32), grey, np.uint8) for grey in (10, 13, 11)]
        trace = signal_trace((Frame(image, i / 10, 5 + i) for i, image in enumerate(images)), "ultrafast")
        assert set(trace.signals) == set(SIGNALS)
        assert trace.signals["mean absolute difference"].tolist() == [-np.inf, 3.0, 2.0]
        assert trace.signals["mean square difference"].tolist() == [-np.inf, 9.0, 4.0]
        assert trace.frames.tolist() == [5, 6, 7]


def trace_of(peaks, n=70):
    """1 in the frames ``peaks`` of a clip at 30 Hz, 0 elsewhere."""
    signal = np.zeros(n)
    signal[list(peaks)] = 1.0
    return SignalTrace(np.arange(n) / 30, np.arange(n), {}), signal


class TestAlarms:
    def test_an_alarm_starts_where_the_signal_rises_above_its_threshold(self):
        score = score_signal(CRASH, *trace_of([40]), 0.5)
        assert [(a.start_frame, a.end_frame) for a in score.alarms] == [(40, 46)]  # and lasts for 200 ms
        assert score.lead_s == pytest.approx(20 / 30)

    def test_the_threshold_itself_is_not_above_it(self):
        assert not score_signal(CRASH, *trace_of([40]), 1.0).alarms

    def test_the_first_200_ms_count_as_warming_up(self):
        assert score_signal(NONE, *trace_of(range(6)), 0.5).false_alarms == 0
        assert score_signal(NONE, *trace_of([6]), 0.5).false_alarms == 1

    def test_alarms_that_follow_closely_are_one(self):
        assert score_signal(NONE, *trace_of([10, 20, 30]), 0.5).false_alarms == 1
        assert score_signal(NONE, *trace_of([10, 40]), 0.5).false_alarms == 2


def test_without_opencv_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(MissingExtraError, match=r'optical flow needs OpenCV: pip install "lobula\[opencv\]"'):
        load_opencv()
