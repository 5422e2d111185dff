"""The one knob: 0.5 changes nothing, more alarms more readily, never without any spike."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lobula.errors import ParameterError
from lobula.model.presets import preset
from lobula.model.sensitivity import with_sensitivity
from lobula.params import settings_hash, with_settings


def test_the_middle_is_the_preset_itself():
    params = preset()
    assert with_sensitivity(params, 0.5) is params


def test_the_ends_by_hand():
    params = with_settings(preset(), {"decision": {"collision_spikes": 4, "lptc_weight": 1.0}}, "test")
    low, high = with_sensitivity(params, 0.0).decision, with_sensitivity(params, 1.0).decision
    assert (low.collision_spikes, low.lptc_weight) == (8, 2.0)  # 4^0.5 = 2
    assert (high.collision_spikes, high.lptc_weight) == (2, 0.5)
    assert low.source_of("collision_spikes") == "sensitivity 0"


@given(st.floats(0, 1), st.floats(0, 1), st.integers(1, 50), st.floats(0, 20))
def test_more_is_never_less_ready(a, b, spikes, weight):
    low, high = sorted((a, b))
    params = with_settings(preset(), {"decision": {"collision_spikes": spikes, "lptc_weight": weight}}, "test")
    slow, quick = with_sensitivity(params, low).decision, with_sensitivity(params, high).decision
    assert 1 <= quick.collision_spikes <= slow.collision_spikes
    assert quick.lptc_weight <= slow.lptc_weight


def test_nothing_but_the_decision_changes():
    changed = with_sensitivity(preset(), 0.9)
    back = with_settings(
        changed,
        {
            "decision": {
                "collision_spikes": preset().decision.collision_spikes,
                "lptc_weight": preset().decision.lptc_weight,
            }
        },
        "test",
    )
    assert settings_hash(back) == settings_hash(preset())


@pytest.mark.parametrize("bad", [-0.1, 1.1, float("nan")])
def test_outside_is_refused(bad):
    with pytest.raises(ParameterError, match=r"must be in \[0, 1\]"):
        with_sensitivity(preset(), bad)
