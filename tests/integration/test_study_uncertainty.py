"""The study of uncertainty: its sets, and its numbers by other routes."""

from dataclasses import replace

import numpy as np
import pytest

from frames.risk import sobol_indices
from validation.study.pairs import BY_LOAD, OURS, UNBREAKABLE, device
from validation.study.uncertainty import effects_of, shares_of
from validation.study.uncertainty_runs import (
    BEST,
    RECORD,
    SAMPLES,
    SPREADS,
    best,
    best_frames,
    changed,
    elastic_frames,
    ours,
    record_of,
    sets_of,
    stiffness_frames,
)


def test_properties_of_a_set_are_those_of_its_bearings():
    sets = sets_of()
    assert len(sets) == SAMPLES * (len(SPREADS) + 2)
    each = sets[5]
    link = next(iter(device(BY_LOAD).bearings.values()))
    found, options = changed(link.bearing, each), link.bearing.resolved()
    assert found.interface_friction == pytest.approx(0.16 * each["interface"])
    assert found.frictions[0].f_max == pytest.approx(0.065 * each["friction"])
    assert found.rim_stiffness == pytest.approx(each["stiffness"] * options["rim_stiffness"])
    assert found.rim_yield_force == pytest.approx(each["strength"] * options["design_load"])
    plastic = found.rim_overrun - found.rim_yield_force / found.rim_stiffness
    assert plastic == pytest.approx(each["breaks"])
    assert ours(each).damping.ratio == pytest.approx(each["damping"])
    assert changed(link.bearing, {}) == replace(
        link.bearing,
        rim_stiffness=options["rim_stiffness"],
        friction=replace(link.bearing.frictions[0]),
    )
    equal, same = best(each).bearings, device(OURS).bearings
    for name, one in equal.items():
        factor = one.bearing.interface_friction / same[name].bearing.interface_friction
        assert factor == pytest.approx(each["interface"])
    assert len({one.bearing.slider_radius for one in equal.values()}) == 1
    numbers = [record_of(one, 22) for one in sets]
    assert set(numbers) == set(range(22))


def test_softer_rims_break_where_they_are_said_to():
    for key, frame in (stiffness_frames() | elastic_frames() | best_frames()).items():
        kind, share = key.split("|")
        for name, link in frame.bearings.items():
            bearing, base = link.bearing, device(UNBREAKABLE).bearings[name].bearing.resolved()
            if kind != "LIR-DCFP":
                assert bearing.rim_stiffness == pytest.approx(float(share) * base["rim_stiffness"])
            if kind == BEST:
                load = base["design_load"]
                assert bearing.rim_yield_force == pytest.approx(load)
                plastic = bearing.rim_overrun - load / bearing.rim_stiffness
                assert plastic == pytest.approx(0.02 - load / base["rim_stiffness"])
            if kind == "DCFP, elastic":
                assert bearing.rim_overrun == 0.02
            if kind == "DCFP, 1 W":
                load = base["design_load"]
                plastic = bearing.rim_overrun - load / bearing.rim_stiffness
                assert plastic == pytest.approx(0.02 - load / base["rim_stiffness"])


def result(each):
    return (
        2.0 * SPREADS["friction"].cdf(each["friction"])
        + SPREADS["damping"].cdf(each["damping"])
        + 3.0 * (record_of(each, 22) % 2)
    )


def test_shares_and_effects_of_a_known_result():
    sets = sets_of()
    table = np.array([result(each) for each in sets]).reshape(-1, SAMPLES)
    tables = {"LIR-DCFP": table, "DCFP": 0.5 * table}
    tables["DCFP"][0, 3] = np.nan  # a run of unknown outcome
    found = shares_of(tables, 20)
    assert found["ratio"]["left out"] == 1
    package = sobol_indices(
        lambda sets: [result(each) for each in sets], SPREADS, samples=SAMPLES, seed=1, widest=2.0
    )
    for key in SPREADS:
        own = found["LIR-DCFP"]
        first = max(own["first"][key][0], 0.0)
        assert first == pytest.approx(package.table.loc[key, "first"], abs=1e-12)
        assert own["total"][key][0] == pytest.approx(package.table.loc[key, "total"])
    effects = effects_of(tables, sets, 22, 20)["LIR-DCFP"]
    # shares are linear in the result, the record is a constant of its own
    assert effects["friction"][0] == pytest.approx(0.68 * 2.0)
    assert effects["damping"][0] == pytest.approx(0.68)
    assert effects["interface"][0] == pytest.approx(0.0, abs=1e-9)
    assert RECORD not in effects
