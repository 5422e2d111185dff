"""The picture of a search: every point at its place, in both panels."""

from __future__ import annotations

import pytest

from lobula.report.front_plot import Mark, Series, plot_front

pytest.importorskip("matplotlib", reason="the extra plot is not installed")

WORDS = {"x": "false alarms", "y": "misses", "z": "lead"}


@pytest.fixture
def figure():
    best = Mark({"x": 1.0, "y": 0.2, "z": 0.5}, {"x": (0.5, 2.0), "y": (0.1, 0.4)})
    panels = {
        "searched on": [
            Series("trials", "trials", [Mark({"x": 4.0, "y": 0.8, "z": 0.1}, {})]),
            Series("front", "front", [best._replace(intervals={}, label=label) for label in "79"]),
            Series("best", "best", [best]),
        ],
        "held out": [Series("front", "front", []), Series("best", "best", [best])],
    }  # fmt: skip
    return plot_front(panels, [("x", "y"), ("x", "z")], WORDS, "title")


def test_a_column_for_each_panel_and_a_row_for_each_view(figure):
    assert [axes.get_title() for axes in figure.axes] == ["searched on", "held out", "", ""]
    assert [axes.get_ylabel() for axes in figure.axes] == ["misses", "", "lead", ""]
    assert [axes.get_xlabel() for axes in figure.axes] == ["", "", "false alarms", "false alarms"]


def test_points_and_intervals(figure):
    lines = [tuple(map(tuple, line.get_data())) for line in figure.axes[0].lines]
    assert ((4.0,), (0.8,)) in lines
    assert ((0.5, 2.0), (0.2, 0.2)) in lines
    assert ((1.0, 1.0), (0.1, 0.4)) in lines


def test_points_that_lie_together_share_their_words(figure):
    assert [text.get_text() for text in figure.axes[0].texts] == ["7, 9"]


def test_the_legend_names_each_series_once(figure):
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["trials", "front", "best"]


def test_it_fits_without_a_complaint(figure, tmp_path, recwarn):
    figure.savefig(tmp_path / "front.png")
    assert not recwarn.list
