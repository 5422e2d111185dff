"""Settings that change while it runs: checked as everywhere, all or none, told to whom it concerns."""

from __future__ import annotations

import pytest

import lobula
from lobula.dashboard.live_settings import LABELS, LiveSettings, changes
from lobula.errors import ParameterError
from lobula.params import settings_hash, walk


@pytest.fixture
def settings():
    return LiveSettings(lobula.preset(), "default")


def test_every_setting_is_one_of_the_network_and_hangs_on_no_state():
    known = {path for path, _, _ in walk(lobula.preset())}
    assert set(LABELS) <= known
    for part in ("decision.", ".spiking.threshold", ".sigmoid_grey"):
        assert {path for path in known if part in path or path.startswith(part)} <= set(LABELS)


def test_a_change_is_one_new_value_and_is_told(settings):
    told = []
    settings.listen(lambda: told.append(settings.params.decision.collision_spikes))
    before = settings.params
    settings.change({"decision.collision_spikes": 6, "lgmd1.spiking.threshold": 0.8})
    assert told == [6]
    assert before is settings.start
    assert changes(before, settings.params) == {
        "decision.collision_spikes": (4, 6),
        "lgmd1.spiking.threshold": (0.7, 0.8),
    }
    assert settings.params.decision.source_of("collision_spikes") == "dashboard"
    assert settings.version == 1


def test_what_changes_nothing_is_no_change(settings):
    settings.change({"decision.collision_spikes": 4})
    settings.restore()
    assert settings.params is settings.start
    assert settings.version == 0


def test_back_to_the_start(settings):
    settings.change({"decision.neurons": "lgmd2"})
    settings.restore()
    assert settings.params == settings.start
    assert settings.version == 2


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"decision.collision_spike": 5}, "decision.collision_spike: cannot be changed here: did you mean decision."),
        ({"lamina.dog.sigma_px": 2.0}, "lamina.dog.sigma_px: cannot be changed here"),
        ({"decision.collision_spikes": 0}, "decision.collision_spikes = 0: must be int in [1, 100]"),
        ({"decision.collision_spikes": 5.5}, "must be int"),
        ({"decision.collision_spikes": True}, "must be int"),
        ({"lptc.spiking.threshold": float("nan")}, "must be float in [0.01, 0.99]"),
        ({"lptc.spiking.threshold": None}, "must be float"),
        ({"decision.neurons": "some"}, "one of all, lgmds, lgmd2"),
        ({"decision.lptc_weight": 2.0, "decision.window_ms": -1.0}, "decision.window_ms"),
    ],
)
def test_a_wrong_value_changes_nothing(settings, values, says):
    with pytest.raises(ParameterError) as caught:
        settings.change(values)
    assert says in str(caught.value)
    assert settings.params is settings.start


def test_what_the_page_is_told(settings):
    entries = {entry["path"]: entry for entry in settings.described()}
    spikes = entries["decision.collision_spikes"]
    assert (spikes["whole"], spikes["low"], spikes["high"], spikes["start"]) == (True, 1, 100, 4)
    assert spikes["slider"] == {"low": 1, "high": 20, "log": False}
    c_sig = entries["lgmd1.sigmoid_grey"]
    assert c_sig["slider"] == pytest.approx({"low": c_sig["start"] / 30, "high": c_sig["start"] * 30, "log": True})
    assert entries["decision.neurons"]["slider"] is None
    for entry in entries.values():
        if entry["slider"]:
            assert entry["low"] <= entry["slider"]["low"] <= entry["start"] <= entry["slider"]["high"] <= entry["high"]
    settings.change({"lptc.spiking.threshold": 0.3})
    now = settings.values()
    assert now["values"]["lptc.spiking.threshold"] == 0.3
    assert now["thresholds"] == {"lgmd1": 0.7, "lgmd2": 0.7, "lptc_r": 0.3, "lptc_l": -0.3}
    assert now["settings_hash"] == settings_hash(settings.params)
