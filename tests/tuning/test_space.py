"""What ``--vary`` picks: names, patterns, ranges; and what it refuses, in one line."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lobula.errors import ParameterError
from lobula.model.presets import PRESETS, preset
from lobula.params import walk
from lobula.tuning.space import axes, default_vary, settings_at

PAPER = preset("paper")


def one(text, params=PAPER):
    (axis,) = axes(params, [text])
    return axis


def paths(*vary, params=PAPER):
    return [axis.path for axis in axes(params, vary)]


class TestRanges:
    def test_the_range_written_beside_a_setting(self):
        axis = one("lgmd2.sigmoid_grey")
        assert (axis.low, axis.high, axis.log, axis.start, axis.kind) == (1e-6, 100, True, 0.0048, "float")
        assert axis.range_text == "1e-06..100 grey, log"

    @pytest.mark.parametrize(
        ("text", "log"),
        [
            ("lgmd1.change_scale_grey", True),  # 0.1..1000
            ("decision.collision_spikes", True),  # 1..100: just two decades
            ("decision.window_ms", False),  # 30..1000
            ("lgmd1.grouping.threshold_grey", False),  # begins at 0
            ("lgmd1.grouping.threshold_grey=0.01..30", True),
            ("lgmd1.sigmoid_grey=1..99", False),
            ("decision.window_ms=x2", True),
        ],
    )
    def test_decades_are_searched_in_the_logarithm(self, text, log):
        assert one(text).log is log

    def test_within_a_factor(self):
        axis = one("lptc.sigmoid_grey2=x5")  # 0.002 in the paper preset
        assert (axis.low, axis.high) == (0.0004, 0.01)

    def test_within_a_factor_but_not_beyond_what_is_allowed(self):
        assert (one("decision.window_ms=x10").low, one("decision.window_ms=x10").high) == (30, 1000)
        spikes = one("decision.collision_spikes=x3")  # 4: 4/3 to 12, whole numbers
        assert (spikes.low, spikes.high, spikes.kind) == (2, 12, "int")

    def test_choices_and_truth_values(self):
        assert one("decision.neurons").choices == ("all", "lgmds", "lgmd2")
        assert one("lamina.dog.enabled").choices == (False, True)
        assert one("lamina.dog.enabled").range_text == "false | true"

    def test_the_later_text_holds(self):
        found = axes(PAPER, ["lgmd*.sigmoid_grey", "lgmd2.sigmoid_grey=1..2"])
        assert {axis.path: axis.high for axis in found} == {"lgmd1.sigmoid_grey": 100, "lgmd2.sigmoid_grey": 2}


class TestPatterns:
    def test_a_pattern_takes_numbers_only(self):
        assert paths("lptc.*") == ["lptc.sigmoid_grey2", "lptc.spiking.gain", "lptc.spiking.threshold"]
        assert "decision.neurons" not in paths("decision.*")

    def test_everything(self):
        every = set(paths("*"))
        for path, owner, name in walk(PAPER):
            is_number = type(getattr(owner, name)) in (int, float)
            assert (path in every) is is_number, path

    def test_what_is_asked_for_twice_is_there_once_in_the_order_of_the_settings(self):
        assert paths("lptc.sigmoid_grey2", "lgmd?.sigmoid_grey", "lgmd1.change_s*") == [
            "lgmd1.change_scale_grey", "lgmd1.sigmoid_grey", "lgmd2.sigmoid_grey", "lptc.sigmoid_grey2"
        ]  # fmt: skip


class TestDefault:
    @pytest.mark.parametrize("name", PRESETS)
    def test_it_holds_for_every_preset(self, name):
        assert axes(preset(name)) == axes(preset(name), ["default"])

    def test_neurons_without_a_say_are_left_out(self):
        alone, pair = preset("paper", neurons="lgmd2"), preset("paper", neurons="lgmds")
        assert not [path for path in paths(params=alone) if path.startswith(("lgmd1", "lptc"))]
        assert "decision.lptc_weight" in paths()
        assert "decision.lptc_weight" not in paths(params=pair)
        assert [path for path in paths(params=pair) if path.startswith("lgmd1")]

    def test_patches_where_they_are_heard(self):
        assert "lgmd2.coarse_gain" in paths(params=preset("lobula"))
        assert "lgmd2.coarse_gain" not in paths()

    def test_it_can_be_added_to(self):
        assert set(paths("default", "flash.trim")) == {*paths(), "flash.trim"}
        assert len(default_vary(PAPER)) == len(paths())


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("lgmd2.sigmoid", "--vary lgmd2.sigmoid: no such setting: did you mean lgmd2.sigmoid_grey?"),
        ("nonsense.*", "--vary nonsense.*: matches no setting; `lobula config show` lists them"),
        ("*.enabled", "--vary *.enabled: matches no number with a range; name truth values and choices in full"),
        ("lptc.emd.spans_px", "--vary lptc.emd.spans_px: is a list of numbers: must be a single one"),
        ("decision.neurons=1..2", "decision.neurons is one of all | lgmds | lgmd2: must be named without a range"),
        ("lgmd1.sigmoid_grey=", "must be PATH, PATH=LOW..HIGH or PATH=xFACTOR"),
        ("lgmd1.sigmoid_grey=3", "must be PATH, PATH=LOW..HIGH or PATH=xFACTOR"),
        ("lgmd1.sigmoid_grey=a..b", "'a' is no number"),
        ("lgmd1.sigmoid_grey=1..nan", "'nan' is no number"),
        ("lgmd1.sigmoid_grey=xtwo", "'two' is no number"),
        ("lgmd1.sigmoid_grey=5..1", "must be LOW..HIGH in 1e-06..100 grey"),
        ("lgmd1.sigmoid_grey=1..1", "nothing between 1 and 1: must be a range"),
        ("lgmd1.sigmoid_grey=0..1", "must be LOW..HIGH in 1e-06..100 grey"),
        ("lgmd1.sigmoid_grey=1..1000", "must be LOW..HIGH in 1e-06..100 grey"),
        ("decision.collision_spikes=1.5..3", "is a whole number: LOW and HIGH must be, too"),
        ("lgmd1.coarse_gain=x2", "lgmd1.coarse_gain is 0: xFACTOR must be above 1, of a setting above 0"),
        ("lgmd1.sigmoid_grey=x1", "xFACTOR must be above 1"),
        ("lamina.dog.surround=x1.2", "nothing between 2 and 2"),
        ("", "--vary : no such setting"),
    ],
)
def test_what_is_refused(text, says):
    with pytest.raises(ParameterError) as refused:
        axes(PAPER, [text])
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_value_that_is_tried_is_short_and_within_the_range(value):
    for text in ("lgmd1.sigmoid_grey=x4", "decision.window_ms", "lgmd1.sigmoid_grey=0.123456789..0.987654321"):
        axis = one(text)
        tried = axis.clipped(value)
        assert axis.low <= tried <= axis.high
        assert tried in (axis.low, axis.high, float(f"{tried:.4g}"))
    assert type(one("decision.collision_spikes").clipped(value)) is int


def test_settings_remember_where_they_come_from():
    changed = settings_at(PAPER, {"lgmd2.sigmoid_grey": 0.01, "decision.window_ms": 300.0}, "trial 7")
    assert (changed.lgmd2.sigmoid_grey, changed.decision.window_ms) == (0.01, 300.0)
    assert changed.lgmd2.source_of("sigmoid_grey") == "trial 7"
    assert changed.lgmd1 == PAPER.lgmd1
