"""Plots of courses, counts and angles: what they refuse, and what stands where."""

from __future__ import annotations

import numpy as np
import pytest

from lobula.errors import ParameterError
from lobula.report.angle_plot import AnglePanel, GroundPlan, plot_angles
from lobula.report.count_plot import plot_boxes
from lobula.report.course_plot import CourseColumn, plot_courses
from lobula.types import NEURONS, TRACE_DTYPE

pytest.importorskip("matplotlib")

THRESHOLDS = {"lgmd1": 0.7, "lgmd2": 0.7, "lptc_r": 0.2, "lptc_l": -0.2}


def column(title="approach"):
    trace = np.zeros(30, TRACE_DTYPE)
    trace["time_s"] = np.arange(30) / 30
    trace["lgmd1"] = trace["lgmd2"] = 0.5
    return CourseColumn(title, np.zeros((30, 72, 99), np.uint8), [trace, trace], (0.2, 0.8), [0.2, 0.5])


def test_courses_stand_side_by_side_with_their_thresholds():
    figure = plot_courses([column(), column("recession")], THRESHOLDS, "about")
    assert len(figure.axes) == 2 * 4  # pictures and three rows of potentials
    pictures, lgmd1, _, lptcs = figure.axes[:4]
    assert pictures.get_title() == "approach"
    assert len(pictures.images) == 2
    flat = [
        line.get_ydata()[0] for line in lptcs.lines if len(set(line.get_ydata())) == 1 and len(line.get_xdata()) == 2
    ]
    assert {round(float(y), 3) for y in flat} >= {0.2, -0.2}
    assert lgmd1.get_xlim() == (0.0, pytest.approx(29 / 30))


def test_boxes_hold_the_counts():
    counts = {(n, "a"): [0, 1, 2, 30] for n in NEURONS}
    figure = plot_boxes({("r", "c"): counts}, rows={"r": "row"}, columns={"c": "column"}, groups={"a": "first"})
    (axes,) = figure.axes
    assert (axes.get_title(), axes.get_ylabel()) == ("column", "row")
    dots = [line for line in axes.lines if line.get_marker() == "."]
    assert len(dots) == 4
    assert all(list(line.get_ydata()) == [0, 1, 2, 30] for line in dots)


def test_nothing_counted_is_an_empty_panel():
    figure = plot_boxes({("r", "c"): {}}, rows={"r": "row"}, columns={"c": "c"}, groups={"a": "first", "b": "second"})
    assert not [line for line in figure.axes[0].lines if line.get_marker() == "."]


def test_angles_show_medians():
    ground = GroundPlan(np.array([[[20.0, 0.0], [4.0, 0.0]]]), 2.0, 1.33, 70.0)
    counts = {a: {(n, ""): [1, 5, 9] for n in NEURONS} for a in (-30.0, 0.0, 30.0)}
    figure = plot_angles(ground, [[AnglePanel("slow", counts)]], "spikes")
    plan, panel = figure.axes
    assert panel.get_title() == "slow"
    marked = [line for line in panel.lines if line.get_marker() not in ("None", None, "")]
    assert len(marked) == 4
    assert all(list(line.get_ydata()) == [5, 5, 5] for line in marked)
    assert plan.texts[0].get_text() == ""  # the arrow
    assert "0" in [text.get_text() for text in plan.texts]


def test_nothing_to_draw_is_refused():
    ground = GroundPlan(np.zeros((1, 2, 2)), 2.0, 1.33, 70.0)
    with pytest.raises(ParameterError, match="plot_courses"):
        plot_courses([], THRESHOLDS)
    with pytest.raises(ParameterError, match="plot_courses"):
        plot_courses([column()._replace(traces=[])], THRESHOLDS)
    with pytest.raises(ParameterError, match="plot_boxes"):
        plot_boxes({}, rows={}, columns={}, groups={})
    with pytest.raises(ParameterError, match="plot_angles"):
        plot_angles(ground, [], "spikes")
