"""The benchmark beside OpenSees: how it counts, judges and picks; a short run of both programs."""

import json
import math
import time
from dataclasses import asdict

import pytest

from frames.solve import recorder, run
from validation.measurements import benchmark
from validation.measurements.benchmark import draw, multiply_adds
from validation.measurements.benchmark_models import STRUCTURES, motion_of, strong
from validation.measurements.benchmark_page import (
    before,
    bound,
    goals,
    goals_text,
    power,
    rival,
    second_cost,
    short,
    step_cost,
    text,
    verdict,
    whole_cost,
)
from validation.measurements.benchmark_runs import (
    DIRECTIONS,
    HISTORIES,
    SCALES,
    USUAL,
    Run,
    Setting,
    cpu_clock,
    motions,
    run_here,
    run_there,
)
from validation.measurements.benchmark_search import cheapest, coarsest, setting_of


def runs(*errors):
    """Return runs at steps of 1, 2, 3 ... ms whose peaks are off by `errors` from 1 m."""
    return [Run(1e-3 * k, 10, 1.0, 2.0, 1.0 + error) for k, error in enumerate(errors, start=1)]


def test_the_largest_step_that_keeps_the_peak_as_all_smaller_ones_do():
    assert coarsest(runs(1e-4, 1e-3, 4e-3, 9e-3), 1.0) == pytest.approx(3e-3)
    assert coarsest(runs(1e-4, 9e-3, 1e-4), 1.0) == pytest.approx(1e-3)
    assert math.isnan(coarsest(runs(9e-3, 1e-4), 1.0))
    own_step = Run(math.nan, 10, 1.0, 2.0, 1.0)
    assert coarsest([own_step, *runs(1e-3)], 1.0) == pytest.approx(1e-3)
    assert math.isnan(coarsest([Run(1e-3, 10, 1.0, 2.0, 1.0, "rim_exceeded")], 1.0))


def test_the_best_way_is_the_cheapest_that_keeps_the_error():
    usual, loose = {"dt": 0.02, "loop": 1.0}, {"dt": math.nan}
    assert cheapest([usual, loose, {"dt": 0.0025, "loop": 2.0}]) is usual
    quick = {"dt": 0.01, "loop": 0.5}
    assert cheapest([usual, quick]) is quick
    assert cheapest([loose, loose]) is loose


def test_power_laws_are_found():
    sizes = [9.0, 16.0, 36.0, 100.0]
    assert power(sizes, [3.0 * n**1.7 for n in sizes]) == pytest.approx(1.7)
    assert power(sizes, [9.0, math.nan, 36.0, 100.0]) == pytest.approx(1.0)
    assert math.isnan(power(sizes[:1], [1.0]))


def test_multiply_adds_of_one_bearing_by_hand():
    # three matrices of 3 x 3; two residuals, two solutions, of each one for the guess; half a
    # tangent: its factorisation, and 12 x 12 put in place
    expected = 27.0 + 18.0 + 18.0 + 0.5 * (9.0 + 144.0)
    assert multiply_adds(3, 0, 1, 1.0, 1.0, 0.5) == pytest.approx(expected)


def kept(ratio):
    """Return results of a mass on one bearing where OpenSees costs `ratio` times as much."""
    there = {"dt": 0.01, "error": 1e-3, "setting": asdict(USUAL)}
    there |= {"loop": 0.8, "whole": 1.0, "rescued": 0}
    run = asdict(Run(0.01, 1200, 0.01, 0.1, 0.2))
    here = {
        "direct": {"runs": [run], "errors": [1e-3], "dt": 0.01, "reference": 0.2},
        "reduced": {"refused": "refused: not here"},
    }
    pairs = {
        "direct": 0.1,
        "usual": 0.2 * ratio,
        "best": 0.1 * ratio,
        "window": 8.0,
        "ratios": {"usual over direct": 2.0 * ratio, "best over direct": ratio},
    }
    kinds = ("singleFPBearing", "TripleFrictionPendulum", "LIR-DCFP, in-process coupling")
    found = {
        "state": "ok",
        "key": "a",
        "when": "2026-01-01",
        "sizes": {"bearings": 1, "unknowns": 3, "bearing_unknowns": 3},
        "here": {"plain DCFP": here, "LIR-DCFP": here},
        "there": {k: {"usual": there, "best": there, "tried": {"x": 1.0}} for k in kinds},
        "pairs": {**dict.fromkeys(kinds, pairs), kinds[1]: {**pairs, "best": 0.05 * ratio}},
    }
    return {"a": found, "machine": "a machine"}


def test_costs_of_a_step_of_a_second_and_of_a_whole_run():
    found = kept(25.0)["a"]
    assert step_cost(found, "singleFPBearing", "best") == pytest.approx(2.5 * 0.01 / 8.0)
    assert step_cost(found, "singleFPBearing", "direct") == pytest.approx(0.1 * 0.01 / 8.0)
    assert math.isnan(step_cost(found, "singleFPBearing", "reduced"))
    assert second_cost(found, "singleFPBearing", "usual") == pytest.approx(5.0 / 8.0)
    assert whole_cost(found, "singleFPBearing") == (1.0, 0.1)


def test_what_bounds_a_step():
    spent = {"step": 10.0, "states": 6.0, "tangents": 2.0, "arithmetic": 1.0}
    assert bound(spent) == "the bearings' state determinations (60 %)"
    assert bound({**spent, "step": 100.0}).startswith("what is left")


def test_the_rival_is_the_cheapest_of_opensees_own_elements():
    found = kept(25.0)["a"]
    assert rival(found, "plain DCFP", "best").kind == "TripleFrictionPendulum"
    assert rival(found, "plain DCFP", "usual").kind == "singleFPBearing"
    assert rival(found, "LIR-DCFP", "best").kind == "LIR-DCFP, in-process coupling"


@pytest.mark.parametrize(("ratio", "said"), [(25.0, "met"), (10.0, "**missed**, by a factor")])
def test_the_page_of_goals_judges_them(ratio, said):
    given = kept(ratio)
    assert all(row[-1].startswith(said) for row in goals(given))
    assert verdict(20.0, 5.0) == "**missed**, by a factor of 4.0"
    assert said in goals_text(given)
    given["a"]["before"] = before(kept(17.0)["a"])
    own = "17 (TripleFrictionPendulum; here direct; 8.5 a step, of 10 ms there, 10 ms here)"
    assert f"| {own}; 2026-01-01 |" in goals_text(given)


def test_the_page_says_how_often_opensees_costs_what_is_spent_here(tmp_path, monkeypatch):
    monkeypatch.setattr("validation.page.FOLDER", tmp_path)
    given = kept(25.0)
    kinds = "singleFPBearing, TripleFrictionPendulum"
    assert [row[1:] for row in short(given)] == [
        ("plain DCFP", kinds, "50", "25"),
        ("LIR-DCFP", "LIR-DCFP, in-process coupling", "50", "25"),
    ]
    page = text(given)
    assert "| singleFPBearing, TripleFrictionPendulum | 50 | 25 |" in page
    assert "goal" not in page.lower()
    assert "refused: not here" in page
    assert "3 storeys, 9 bearings (not run)" in page


def test_the_figure_is_drawn_of_what_there_is():
    assert len(draw(kept(25.0)).axes) == 2
    assert draw({"b": {**kept(25.0)["a"], "key": "b"}}).axes[1].lines


def test_settings_are_kept_as_text():
    setting = Setting("BandGeneral", "AMD", ("ModifiedNewton", "-initial"), ("EnergyIncr", 1e-4))
    assert setting_of(json.loads(json.dumps(asdict(setting)))) == setting
    assert setting.name == "BandGeneral, AMD, ModifiedNewton -initial, EnergyIncr 1e-04"


def test_motions(monkeypatch):
    monkeypatch.delenv("LIR_RECORDS", raising=False)
    assert len(motions()) * len(SCALES) == HISTORIES
    assert len(motions()) == DIRECTIONS
    assert strong(1.0).duration == pytest.approx(1.1, abs=0.02)
    assert not motion_of(8.0).components[:, 2].any()


def test_analyses_tell_cpu_time_inside_alone():
    with cpu_clock():
        for one in (run, recorder):  # what one counts the other takes off
            assert one.perf_counter is time.process_time
    assert run.perf_counter is recorder.perf_counter is time.perf_counter


def test_both_programs_run_one_bearing_alike(monkeypatch):
    pytest.importorskip("openseespy")
    monkeypatch.delenv("LIR_RECORDS", raising=False)
    structure, motion = STRUCTURES["a"], motion_of(3.0)
    bearing = structure.bearing()
    here = run_here(structure.frame(bearing.as_dcfp(rims=False)), motion, 3.0, 0.005)
    there = run_there(structure, bearing, "singleFPBearing", motion, 0.005, 600)
    assert here.status == there.status == "ok"
    assert here.steps == there.steps == 600
    assert there.peak == pytest.approx(here.peak, rel=0.02)
    assert 0.0 < here.loop <= here.whole
    assert 0.0 < there.loop <= there.whole


def test_a_method_that_is_not_there_is_refused_with_its_reason(monkeypatch):
    monkeypatch.delenv("LIR_RECORDS", raising=False)
    structure = STRUCTURES["a"]
    run = run_here(structure.frame(structure.bearing()), motion_of(4.0), 1.0, 0.01, "by magic")
    assert run.status.startswith("refused")
    assert "by magic" in run.status


def test_results_are_kept_case_by_case(monkeypatch, tmp_path):
    file, done = tmp_path / "kept.json", []

    def measured(key, _, *, short):
        done.append((key, short))
        return {"state": "ok", "key": key}

    monkeypatch.setattr(benchmark, "measured", measured)
    monkeypatch.setattr(benchmark, "before", lambda found: found["key"])
    results = {}
    for again in (False, False, True):
        benchmark.run("d", results, file, again=again, short=True)
    assert done == [("d100", True), ("d256", True)] * 2
    again = json.loads(file.read_text(encoding="utf-8"))
    assert set(again) == {"d100", "d256", "machine"}
    assert again["d100"]["before"] == "d100"
