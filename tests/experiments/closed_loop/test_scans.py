"""Scans: their variants, their tables, and runs of a few seconds."""

from __future__ import annotations

import csv
from dataclasses import replace

import pytest

from lobula.arena import World
from lobula.errors import ParameterError
from lobula.experiments.closed_loop import negative_controls, sensitivity, trade_off
from lobula.experiments.closed_loop.scan import ScanPlan, Variant, job_count, rate_cells, run_scan
from lobula.experiments.closed_loop.tables import group
from lobula.model.presets import preset

from .hand_made import done

PLAN = ScanPlan(seeds=[51], minutes=0.03, densities=[2])


def rows(path):
    with path.open() as file:
        return list(csv.DictReader(file))


class TestPlan:
    def test_the_seeds_of_the_table_are_not_for_scans(self):
        with pytest.raises(ParameterError, match="must not be among 7000 to 7999"):
            ScanPlan(seeds=range(6990, 7001), minutes=1)

    def test_from_the_command_line_neither(self, capsys, tmp_path):
        assert trade_off.main(["--out", str(tmp_path), "--first-seed", "7001"]) == 2
        assert "must not be among" in capsys.readouterr().err
        assert not list(tmp_path.iterdir())

    @pytest.mark.parametrize("module", [trade_off, sensitivity, negative_controls])
    def test_what_would_be_run(self, module, capsys, tmp_path):
        assert module.main(["--out", str(tmp_path / "no"), "--list", "--seeds", "2", "--robots", "4"]) == 0
        assert f"{len(module.variants())} variants" in capsys.readouterr().out
        assert not (tmp_path / "no").exists()


class TestVariants:
    def test_levers_move_what_they_name_from_the_preset(self):
        paper = preset("paper")
        found = {(v.series, v.value): v.params for v in trade_off.variants() if v.base == "paper"}
        assert found["C_sig", "x2"].lgmd1.sigmoid_grey == 2 * paper.lgmd1.sigmoid_grey
        assert found["C_sig", "x2"].lgmd2.sigmoid_grey == 2 * paper.lgmd2.sigmoid_grey
        assert found["K_hs", "x10"].lptc.sigmoid_grey2 == pytest.approx(10 * paper.lptc.sigmoid_grey2)
        assert found["lptc_weight", "2"] == replace(paper, decision=replace(paper.decision, lptc_weight=2.0))
        assert found["window_ms", "500"].decision.window_ms == 500
        assert found["collision_spikes", "8"].decision.collision_spikes == 8
        assert found["LGMD-2 alone", ""].decision.neurons == "lgmd2"

    def test_levers_of_our_own_preset(self):
        own = preset("lobula")
        found = {(v.series, v.value): v.params for v in trade_off.variants() if v.base == "lobula"}
        assert found["coarse_gain", "x0"].lgmd2.coarse_gain == 0
        assert found["coarse_gain", "x0"].lgmd2.coarse_on_weight == own.lgmd2.coarse_on_weight
        assert found["coarse_on_weight", "x2"].lgmd2.coarse_on_weight == 2 * own.lgmd2.coarse_on_weight
        assert {params.decision.neurons for params in found.values()} == {"lgmd2"}

    def test_the_preset_itself_is_run_once(self):
        plan = ScanPlan(seeds=[1], minutes=1, densities=[4])
        chosen = [v for v in trade_off.variants() if v.base == "paper"]
        same = [v for v in chosen if v.params == preset("paper")]
        assert len(same) == 5  # one on each lever
        assert job_count(chosen, plan) == len(chosen) - 4

    def test_arenas_of_the_sensitivity(self):
        worlds = {(v.series, v.value): v.world for v in sensitivity.variants()}
        wall = worlds["stripes, +- grey levels", "10"].wall
        assert (wall.dark_grey, wall.light_grey) == (170, 190)
        assert worlds["margin of AA, cm", "3"].scoring.margin_cm == 3
        assert worlds["noise of the motors, share", "0.3"].robots.motor_noise == 0.3
        assert worlds["bend of the paths, 1/m", "1"].robots.curvature_per_m == 1
        assert worlds["frames a second", "60"].camera.rate_hz == 60
        wide = worlds["width of stripes, cm", "2.8"].wall
        assert (wide.stripe_low_cm, wide.stripe_high_cm) == pytest.approx((2.4, 3.2))
        for series in {v.series for v in sensitivity.variants()}:
            assert World() in [v.world for v in sensitivity.variants() if v.series == series]

    def test_names_are_unique(self):
        for module in (trade_off, sensitivity, negative_controls):
            names = [v.name for v in module.variants()]
            assert len(set(names)) == len(names)


class TestRuns:
    def test_tables_and_resume(self, tmp_path):
        paper = preset("paper")
        chosen = [
            Variant(base="b", series="s", value=value, params=params)
            for value, params in (("1", paper), ("2", preset("paper", neurons="lgmd2")), ("3", paper))
        ]
        steps = []
        results = run_scan("scan", chosen, PLAN, tmp_path, advance=lambda: steps.append(1))
        assert len(steps) == 2
        assert [(v.value, robots) for v, robots in results] == [("1", 2), ("2", 2), ("3", 2)]
        assert results[chosen[0], 2].score == results[chosen[2], 2].score
        first = (tmp_path / "scan.csv").read_bytes()
        assert [(row["value"], row["robots"]) for row in rows(tmp_path / "scan.csv")] == [
            ("1", "2"),
            ("2", "2"),
            ("3", "2"),
        ]
        assert len(rows(tmp_path / "scan-runs.csv")) == 2
        run_scan("scan", chosen, PLAN, tmp_path)
        assert (tmp_path / "scan.csv").read_bytes() == first

    def test_robots_that_stand_still_turn_for_nothing(self, tmp_path, monkeypatch):
        still = [
            v for v in negative_controls.variants() if v.series == negative_controls.STILL and "proposed" in v.base
        ]
        monkeypatch.setattr(negative_controls, "variants", lambda: still)
        results = negative_controls.make(ScanPlan(seeds=[52], minutes=0.1, densities=[3]), tmp_path, 1)
        for found in results.values():
            assert sum(len(one.events) for one in found.results) == 0
        page = (tmp_path / "negative-controls.md").read_text()
        assert page.count("| 0.00 (0.00 to ") == len(still) == 8

    def test_the_command_writes_figures_and_pages(self, tmp_path, monkeypatch, capsys):
        pytest.importorskip("matplotlib")
        few = [v for v in trade_off.variants() if v.series == "collision_spikes" and v.value in ("2", "4")]
        monkeypatch.setattr(trade_off, "variants", lambda: few)
        arguments = [
            "--out",
            str(tmp_path / "t"),
            "--seeds",
            "1",
            "--minutes",
            "0.02",
            "--robots",
            "2",
            "--workers",
            "1",
        ]
        assert trade_off.main(arguments) == 0
        assert capsys.readouterr().out.strip() == str(tmp_path / "t")
        files = {path.name for path in (tmp_path / "t").iterdir()}
        assert {"trade-off.md", "trade-off.csv", "trade-off-published.svg"} <= files
        assert {"trade-off-paper.png", "trade-off-lobula.png"} <= files

    def test_the_drawing_of_the_sensitivity(self):
        pytest.importorskip("matplotlib")
        chosen = sensitivity.variants()
        found = group([done(AP=9, CP=1, AA=5, AT=3, CR=2)])
        drawing = sensitivity.draw(4, PLAN, dict.fromkeys(((v, 4) for v in chosen), found))
        assert len(drawing.axes) == 14
        lines = drawing.axes[0].containers
        assert [list(line.lines[0].get_ydata()) for line in lines] == [[90.0] * 5] * 4


def test_the_front_is_what_no_other_beats():
    groups = [group([done(AT=at, CR=cr)]) for at, cr in ((4, 1), (2, 2), (3, 3), (1, 5), (1, 6), (2, 2))]
    assert trade_off.front(groups) == [True, True, False, True, False, True]


def test_rates_with_their_intervals():
    # Wilson's of 8 of 10: 49.0 to 94.3 %
    assert rate_cells(group([done(AP=8, CP=2)])) == ("80.0 % (49.0 to 94.3)", "nothing to count")


def test_turns_a_robot_minute():
    # exact Poisson of 2 events: 0.2422 to 7.2247
    two = group([done(robots=2, minutes=0.5, AP=1, spurious=1)])
    assert negative_controls.turns_text(two) == "2.00 (0.24 to 7.22)"
