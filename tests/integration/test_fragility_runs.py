"""Incremental dynamic analyses, stripes and clouds of a mass on one bearing."""

import warnings

import numpy as np
import pytest

from frames import GroundMotion, lumped_mass, time_histories
from frames.demo import bearing_for
from frames.risk import (
    FragilityError,
    HuntFill,
    Intensity,
    IntensityRuns,
    LimitState,
    cloud_analysis,
    fragility_of,
    ida,
    multiple_stripes,
)
from lir_element.errors import AnalysisWarning
from tests.refusals import refused

LOAD = 1000e3
BEARING = bearing_for(LOAD)
MODEL = lumped_mass(BEARING, LOAD / 9.80665, name="mass")
PGV = Intensity(kind="PGV", measure="x")


def pulse(period: float) -> GroundMotion:
    time = 0.01 * np.arange(int(period / 0.01) + 1)
    wave = np.sin(2.0 * np.pi * time / period)
    return GroundMotion(x=wave, dt=0.01, name=f"pulse {period:g} s").with_tail(2.0)


PULSES = [pulse(period) for period in (1.0, 1.4, 1.9, 2.5)]


def test_an_ida_brackets_the_failure_of_each_motion() -> None:
    rules = HuntFill(first=0.2, growth=0.1, resolution=0.05, runs=14)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # failures of bearings are outcomes
        found = ida(MODEL, PULSES, intensity=PGV, rules=rules)
    table = found.capacities()
    assert not table["censored"].any()
    gap = (table["upper"] - table["lower"]) / table["upper"]
    assert (gap <= 0.05).all()
    grown = found.curve("pulse 1.4 s", "bearing displacement")
    assert (np.diff(grown["demand"][np.isfinite(grown["demand"])]) > 0.0).all()
    rims = found.capacities(LimitState.rim_contact())["capacity"]
    assert (rims < table["capacity"]).all()
    curve = fragility_of(found, LimitState.bearing_failure(), resamples=50)
    assert table["capacity"].min() < curve.median < table["capacity"].max()


def test_an_ida_goes_on_from_runs_that_are_there() -> None:
    rules = HuntFill(first=0.3, runs=6)
    whole = ida(MODEL, PULSES[:2], intensity=PGV, rules=rules).runs
    part = IntensityRuns(whole.table.iloc[:3], PGV, whole.units)  # the second has one run
    again = ida(MODEL, PULSES[:2], intensity=PGV, rules=rules, known=part).runs
    columns = ["motion", "im", "status", "bearing displacement"]
    tables = [each.table[columns].sort_values(["motion", "im"]) for each in (whole, again)]
    assert tables[0].reset_index(drop=True).equals(tables[1].reset_index(drop=True))
    with pytest.raises(FragilityError, match="not among the motions"):
        ida(MODEL, PULSES[2:], intensity=PGV, rules=rules, known=part)
    with pytest.raises(FragilityError, match="one measure"):
        ida(MODEL, PULSES[:2], intensity=Intensity(kind="scale"), rules=rules, known=part)


def test_stripes_are_the_same_runs_by_hand() -> None:
    found = multiple_stripes(MODEL, PULSES, [0.2, 0.4, 0.6, 0.8], intensity=PGV)
    assert sorted(set(found.table["im"])) == [0.2, 0.4, 0.6, 0.8]
    own = found.table[found.table["motion"] == "pulse 1.9 s"].iloc[1]
    alone = time_histories(MODEL, PULSES[2], scales=0.4 / PGV.of(PULSES[2]))
    again = IntensityRuns.from_dataset(alone, PULSES[2], PGV)
    assert again.table["im"].tolist() == [0.4]
    for quantity in ("bearing displacement", "interface slip", "base shear"):
        assert again.table[quantity][0] == own[quantity]
    limit = LimitState.displacement(0.1)
    assert (found.exceeded(limit) == (found.demand("bearing displacement") > 0.1)).all()


def test_a_cloud_of_motions_as_they_are() -> None:
    found = cloud_analysis(MODEL, PULSES, intensity=PGV, scales=(0.5, 1.0, 1.3))
    assert found.table["scale"].tolist() == pytest.approx([0.5, 1.0, 1.3] * 4)
    limit = LimitState.displacement(0.1)
    curve = fragility_of(found, limit, method="cloud", resamples=50)
    near = fragility_of(
        ida(MODEL, PULSES, intensity=PGV, rules=HuntFill(first=0.2), limit=limit),
        limit,
        resamples=50,
    )
    assert curve.median == pytest.approx(near.median, rel=0.25)


def test_numerical_failures_count_as_neither_and_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run whose status says so is no outcome: it is warned of, and gone around."""

    def broken(*given: object, **options: object) -> object:
        data = time_histories(*given, **options)  # type: ignore[arg-type]
        fails = np.isclose(data["scale"] * PGV.of(PULSES[0]), 0.6)
        doubtful = np.isclose(data["scale"] * PGV.of(PULSES[0]), 0.3)
        status = np.where(fails, "step_too_small", data["status"])
        data["status"] = ("run", np.where(doubtful, "inaccurate", status))
        return data

    monkeypatch.setattr("frames.risk.fragility.analyses.time_histories", broken)
    rules = HuntFill(first=0.3, step=0.3, growth=0.0, runs=9)
    with (
        pytest.warns(AnalysisWarning, match="1 of 1 runs failed numerically and count as neither"),
        pytest.warns(AnalysisWarning, match="1 of 1 runs are inaccurate and count with their dem"),
    ):
        found = ida(MODEL, PULSES[0], intensity=PGV, rules=rules)
    assert found.runs.failed["im"].tolist() == [0.6]
    row = found.capacities().iloc[0]
    assert row["failed"] == 1
    assert row["upper"] > 0.6


def test_what_makes_no_sense_is_refused() -> None:
    refused(FragilityError, "levels is empty", multiple_stripes, MODEL, PULSES, [], intensity=PGV)
    refused(FragilityError, "level", multiple_stripes, MODEL, PULSES, [-1.0], intensity=PGV)
    refused(FragilityError, "scale", cloud_analysis, MODEL, PULSES, intensity=PGV, scales=[0.0])
    with pytest.raises(FragilityError, match="is set by this analysis"):
        multiple_stripes(MODEL, PULSES, [1.0], intensity=PGV, scales=[1.0])
    other = lumped_mass(BEARING, LOAD / 9.80665, name="other")
    with pytest.raises(FragilityError, match="2 structures: give one"):
        multiple_stripes([MODEL, other], PULSES, [1.0], intensity=PGV)  # type: ignore[arg-type]
    data = time_histories([MODEL, other], PULSES[0], scales=1.0)
    refused(FragilityError, "name one", IntensityRuns.from_dataset, data, PULSES[0], PGV)
    assert len(IntensityRuns.from_dataset(data, PULSES[0], PGV, model="other").table) == 1
    with pytest.raises(FragilityError, match="motion"):
        IntensityRuns.from_dataset(data, PULSES[1], PGV, model="other")
