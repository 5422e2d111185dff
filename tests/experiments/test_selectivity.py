"""The paper's claims of selectivity, on the synthetic battery, with the default preset."""

from __future__ import annotations

import numpy as np
import pytest

from lobula.engine.library import available
from lobula.experiments.battery import Scored, own_rate_changes, score
from lobula.experiments.outcome import Outcome, checks, first_alarm, strongest_window
from lobula.model.presets import preset
from lobula.stimuli.battery import battery
from lobula.types import TRACE_DTYPE

KNOWN = {
    ("looming-noise", "LPTCs silent"),
    ("looming-textured", "LPTCs silent"),
    ("receding-stripes", "LPTCs silent"),
    ("receding-blobs", "LPTCs silent"),
    ("translating_right-low_contrast", "LGMDs alone call a collision"),
    ("translating_left-low_contrast", "LGMDs alone call a collision"),
}
"""What docs/selectivity.md says does not hold."""

needs_core = pytest.mark.skipif(not available(), reason="the battery takes a minute without the C core")


@pytest.fixture(scope="module")
def scored() -> list[Scored]:
    return score(preset("paper"))


@needs_core
def test_every_claim_of_the_paper_holds_but_for_the_ones_the_docs_name(scored: list[Scored]) -> None:
    failing = {(s.case.name, check.claim) for s in scored for check in s.checks if not check.holds}
    assert failing <= KNOWN


@needs_core
def test_a_dark_approach_is_always_called_before_contact_and_nothing_else_ever_is(scored: list[Scored]) -> None:
    for s in scored:
        about, result = s.case.expectation, s.result
        if about.kind == "looming" and about.dark:
            assert result.all_s is not None, s.case.name
            assert result.contact_s is not None
            assert result.all_s < result.contact_s, s.case.name
        elif about.kind != "angular" and not (about.kind == "receding" and not about.dark):
            assert result.all_s is None, s.case.name


@needs_core
def test_all_four_neurons_decide_alike_at_other_frame_rates() -> None:
    found = own_rate_changes(preset("paper"), [15.0, 60.0, 120.0])
    changed = [c for c in found if (c.at_30_hz_s is None) != (c.at_rate_s is None)]
    assert {c.neurons for c in changed} <= {"all"}
    assert all(c.name.startswith("angular") for c in changed)


@needs_core
def test_our_own_preset_takes_what_passes_for_an_approach() -> None:
    """What docs/limits.md says of preset lobula, at one speed: both kinds of approach, and objects that pass."""
    for name in ("looming-dark-8cm_s", "angular-from_left-45deg", "translating_right-dark-8cm_s"):
        case = next(case for case in battery() if case.name == name)
        assert first_alarm(case.movie(rate_hz=30.0), preset("lobula")) is not None, name
    for name in ("receding-dark-8cm_s", "looming-bright-8cm_s"):
        case = next(case for case in battery() if case.name == name)
        assert first_alarm(case.movie(rate_hz=30.0), preset("lobula")) is None, name


def test_the_strongest_window_is_counted_by_hand() -> None:
    trace = np.zeros(8, TRACE_DTYPE)
    trace["time_s"] = np.arange(8) / 30
    trace["spikes_lgmd1"] = [0, 1, 2, 2, 2, 2, 2, 2]
    trace["spikes_lgmd2"] = [0, 0, 0, 1, 1, 1, 0, 0]
    # six frames of 33 ms: LGMD-1 at most 12, LGMD-2 at most 3
    assert strongest_window(trace) == 3


def test_claims_fail_where_they_should() -> None:
    case = next(c for c in battery() if c.name == "translating_right-dark-8cm_s")
    wrong = Outcome(
        spikes={"lgmd1": 20, "lgmd2": 0, "lptc_r": 0, "lptc_l": 9}, lgmd1_burst_s=0.1, strongest=12,
        all_s=1.0, lgmds_s=None, contact_s=None,
    )  # fmt: skip
    assert not any(check.holds for check in checks(case, wrong, approach_strength=10))
