"""The presets: the values of the published code, one by one, and where values come from."""

import math

import pytest

from lobula.errors import ParameterError
from lobula.model.presets import BASES, DEFAULT, NAMES, PRESETS, preset
from lobula.params import to_dict, walk

PUBLISHED = to_dict(preset("published"))
LOW = {"centre_weight": 1.0, "nearest_weight": 0.25, "diagonal_weight": 0.125,
       "centre_ms": 60.0, "nearest_ms": 120.0, "diagonal_ms": 180.0}  # fmt: skip
HIGH = {"centre_weight": 2.0, "nearest_weight": 0.5, "diagonal_weight": 0.25,
        "centre_ms": 15.0, "nearest_ms": 30.0, "diagonal_ms": 45.0}  # fmt: skip
BOTH_LGMDS = {
    "neighbour_px": 1, "change_scale_grey": 20.0, "on_gain": 1.0, "off_gain": 1.0, "coarse_gain": 0.0,
    "sfa": {"enabled": True, "tau_ms": 800.0, "growth": 0.003},
    "spiking": {"gain": 4.0, "threshold": 0.7},
}  # fmt: skip
PUBLISHED_SCALES = {
    "reads": "change", "sigmoid_grey": 1.0,
    "grouping": {"enabled": True, "threshold_grey": 30.0, "floor_grey": 0.01, "divisor": 4.0},
}  # fmt: skip
LGMD1 = {"on": {**LOW, "bias": 0.5}, "off": {**LOW, "bias": 0.5}, "change_ms": 10.0, "product_gain": 0.0}
LGMD2 = {"on": {**HIGH, "bias": 1.0}, "off": {**LOW, "bias": 0.5}, "change_ms": 90.0, "product_gain": 1.0}


def heard(lgmd):
    """The settings of an LGMD less the one that only patches need, which nothing published has."""
    return {name: value for name, value in PUBLISHED[lgmd].items() if name != "coarse_on_weight"}


def test_published_lgmd1():
    assert heard("lgmd1") == {**BOTH_LGMDS, **PUBLISHED_SCALES, **LGMD1}


def test_published_lgmd2():
    assert heard("lgmd2") == {**BOTH_LGMDS, **PUBLISHED_SCALES, **LGMD2}


def test_published_lptc():
    assert PUBLISHED["lptc"] == {
        "emd": {"spans_px": [1, 2, 3, 4], "delays_ms": [40.0, 30.0, 20.0, 10.0]},
        "sigmoid_grey2": 0.01,
        "spiking": {"gain": 4.0, "threshold": 0.2},
    }


def test_published_lamina():  # 5 x 5 of sigma 2, 9 x 9 of sigma 4; |e| under 1e-4 is nothing; a tenth stays; 1 ms
    assert PUBLISHED["lamina"] == {
        "dog": {"enabled": True, "radius_px": 2, "sigma_px": 2.0, "surround": 2, "dead_zone_grey": 1e-4},
        "on_off": {"residual": 0.1},
        "fdsr": {"enabled": True, "rise_ms": 1.0},
    }


@pytest.mark.parametrize("name", NAMES)
def test_clock_of_every_preset(name):
    p = preset(name)
    assert p.clock.period_ms == 1000 / 30
    assert (p.clock.repeat_mean_grey, p.clock.repeat_max_grey) == (0.1, 8.0)


@pytest.mark.parametrize("name", ["default", *BASES])
def test_rule_of_the_papers_presets(name):
    p = preset(name)
    assert p.decision.neurons == "all"
    assert (p.decision.window_ms, p.decision.collision_spikes, p.decision.lptc_weight) == (200.0, 4, 1.0)
    assert (p.decision.end_ms, p.decision.after_turn_ms) == (200.0, 67.0)


def test_paper_differs_from_published_only_by_what_was_calibrated():
    """All four neurons read the lamina; rings, delays, gains, SFA and spikes are the published ones."""
    paper = to_dict(preset("paper"))
    for lgmd in ("lgmd1", "lgmd2"):
        assert paper[lgmd]["reads"] == "lamina"
        for name in ("reads", "sigmoid_grey"):
            paper[lgmd][name] = PUBLISHED[lgmd][name]
        for name in ("threshold_grey", "floor_grey"):
            paper[lgmd]["grouping"][name] = PUBLISHED[lgmd]["grouping"][name]
    paper["lptc"]["sigmoid_grey2"] = PUBLISHED["lptc"]["sigmoid_grey2"]
    assert paper == PUBLISHED


@pytest.mark.parametrize("name", BASES)
def test_nothing_saturates_and_nobody_hears_patches_in_the_papers_presets(name):
    p = preset(name)
    assert not p.saturation.enabled
    assert p.lgmd1.coarse_gain == p.lgmd2.coarse_gain == 0


def test_lobula_is_the_published_wiring_with_patches():
    """LGMD-2 alone decides, hears patches, and sees a change that saturates; its constants come from a search."""
    lobula, ours = preset("lobula"), to_dict(preset("lobula"))
    assert lobula.saturation.enabled
    assert lobula.lgmd2.coarse_gain > 0
    assert lobula.lgmd2.coarse_on_weight > 1
    assert lobula.decision.neurons == "lgmd2"
    assert {name for name in ours if ours[name] != PUBLISHED[name]} <= {"saturation", "coarse", "lgmd2", "decision"}
    for group in ("on", "off", "sfa", "spiking"):
        assert ours["lgmd2"][group] == PUBLISHED["lgmd2"][group]
    assert lobula.lgmd2.source_of("coarse_gain").startswith("calibrated in the arena")


def test_default_is_one_of_the_bases():
    assert DEFAULT in BASES
    assert preset() == preset("default") == preset(DEFAULT)
    assert set(BASES) == {"paper", "published"}
    assert set(PRESETS) == {*BASES, "lobula"}
    assert set(NAMES) == {"default", *PRESETS}


@pytest.mark.parametrize(("name", "neurons"), [*((base, "all") for base in BASES), ("lobula", "lgmd2")])
def test_who_decides_where_nobody_is_chosen(name, neurons):
    assert preset(name).decision.neurons == neurons
    assert preset(name, neurons=None) == preset(name) == preset(name, neurons=neurons)
    assert preset(name).decision.source_of("neurons") != "chosen by the caller"
    assert preset(name, neurons=neurons).decision.source_of("neurons") == "chosen by the caller"


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("neurons", ["all", "lgmds", "lgmd2"])
def test_neurons_choose_who_decides_and_nothing_else(name, neurons):
    p, base = to_dict(preset(name, neurons=neurons)), to_dict(preset(name))
    del base["decision"]["neurons"]
    assert p["decision"].pop("neurons") == neurons
    assert p == base


@pytest.mark.parametrize("name", NAMES)
def test_every_value_has_an_origin(name):
    assert all(owner.source_of(field).strip() for _, owner, field in walk(preset(name)))


def test_origins_follow_the_preset():
    published, paper = preset("published"), preset("paper")
    assert published.lgmd2.source_of("change_ms") == "published code: LGMD2-open-source"
    assert published.lgmd1.source_of("change_ms") == "published code: NewLGMDs"
    assert paper.lgmd1.source_of("sigmoid_grey").startswith("calibrated")
    assert published.lgmd1.spiking.source_of("threshold") == "paper Sec. III"


def test_published_shares_give_the_published_ceiling():  # 800 / 833.3 = 0.96, so 2 spikes at most
    sfa, spiking = preset("published").lgmd1.sfa, preset("published").lgmd1.spiking
    ceiling = sfa.tau_ms / (sfa.tau_ms + 1000 / 30)
    assert ceiling == pytest.approx(0.96)
    assert math.floor(math.exp(spiking.gain * (ceiling - spiking.threshold))) == 2


@pytest.mark.parametrize("bad", ["papers", "", "PAPER", "lgmds"])
def test_unknown_presets_are_refused(bad):
    with pytest.raises(ParameterError, match=rf"preset '{bad}': must be one of default, published, paper, lobula"):
        preset(bad)


@pytest.mark.parametrize("bad", ["lgmd1", "four", ""])
def test_unknown_selections_are_refused(bad):
    with pytest.raises(ParameterError, match=rf"neurons '{bad}': must be one of all, lgmds, lgmd2"):
        preset(neurons=bad)
