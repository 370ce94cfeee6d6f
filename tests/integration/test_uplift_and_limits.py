"""Uplift under every code, limits of a project beside those of codes, slip under gamma_x."""

import math
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from frames import Frame, lumped_mass, shear_building, time_histories
from frames.design import Check, CheckError, Checks, DesignLimits, history_checks, overlap_area
from frames.design.histories.suite_notes import doubted
from frames.results.bearing_geometry import rim_height
from lir_element import CoulombFriction, LIRBearing
from tests.scenes import full_sine, paper_bearing

CODES = (("ASCE 7-22", ""), ("EN 1998-1", ""), ("NCh2745", "maximum"))
RIMS = "maximum uplift over the rim height"


@pytest.fixture(scope="module")
def bearing() -> LIRBearing:
    return paper_bearing(capacity=0.2, interface_friction=0.14)


@pytest.fixture(scope="module")
def frame(bearing: LIRBearing) -> Frame:
    return shear_building(bearing, [60e3, 60e3], 60e6, base_mass=60e3)


@pytest.fixture(scope="module")
def runs(frame: Frame) -> xr.Dataset:
    """Seven runs whose bearing stays on its plates and short of its rims."""
    return time_histories(frame, [full_sine(0.8 + 0.05 * k) for k in range(7)])


@pytest.fixture(scope="module")
def alone(bearing: LIRBearing) -> Frame:
    """What the axial force of one bearing is known of: nothing that overturns."""
    return lumped_mass(bearing, 180e3)


@pytest.fixture(scope="module")
def lifted(runs: xr.Dataset) -> xr.Dataset:
    """The same with one lift-off, set by hand: 12 mm in one run, then 25.9 MN."""
    one = xr.DataArray((np.arange(7) == 2).astype(float), dims="run")
    nothing = 0.0 * runs["peak_time_lifted"]
    return runs.assign(
        peak_uplifts=3.0 * one,
        peak_time_lifted=nothing + 0.2 * one,
        peak_gap=nothing + 12e-3 * one,
        peak_axial_force=nothing + xr.where(one > 0.0, 25.9e6, runs["peak_axial_force"]),
    )


def one(checks: Checks, title: str, clause: str = "") -> Check:
    found = [c for c in checks if c.title == title and clause in c.clause]
    assert len(found) == 1, title
    return found[0]


@pytest.mark.parametrize(("code", "level"), CODES)
def test_the_widest_gap_and_the_hardest_landing_count_under_every_code(
    alone: Frame, bearing: LIRBearing, lifted: xr.Dataset, code: Any, level: str
) -> None:
    """Not their means; heights of rims by the drawing's own geometry."""
    checks = history_checks(lifted, alone, code, action_level=level)
    gap = one(checks, RIMS)
    assert gap.demand == 12e-3
    assert gap.limit == pytest.approx(rim_height(bearing), rel=1e-9)
    assert gap.passed
    assert ("17.2.4.7" in gap.clause) == (code == "ASCE 7-22")
    assert "lift off in 1 of 7 runs, 3 times; largest gap 12 mm (pulse 0.9" in gap.note
    assert "0.2 s), axial force up to 2.59e+04 kN" in gap.note
    landing = one(checks, "pressure of a landing on the sliders")
    slip = float(lifted["peak_slip"][2, 0])
    assert landing.demand == pytest.approx(25.9e6 / overlap_area(0.15, slip))
    assert (landing.limit, landing.passed) == (90e6, False)
    assert landing.clause == "no code: a proposal"


def test_a_slider_that_leaves_its_rims_is_no_pass(alone: Frame, lifted: xr.Dataset) -> None:
    wide = lifted.assign(peak_gap=10.0 * lifted["peak_gap"])
    for code, level in CODES:
        assert not one(history_checks(wide, alone, code, action_level=level), RIMS).passed
    limits = DesignLimits(rim_height=0.13, uplift_gap=0.05, axial_force=30e6)
    checks = history_checks(wide, alone, "ASCE 7-22", limits=limits)
    assert (one(checks, RIMS).limit, one(checks, RIMS).passed) == (0.13, True)
    own = one(checks, "maximum uplift")
    assert (own.demand, own.limit, own.clause) == (
        pytest.approx(0.12),
        0.05,
        "no code: limit of the project",
    )
    assert not own.passed
    landing = one(checks, "axial force with a landing")
    assert (landing.demand, landing.limit) == (25.9e6, 30e6)


def test_bearings_that_stay_down_have_no_landing(alone: Frame, runs: xr.Dataset) -> None:
    checks = history_checks(runs, alone, "ASCE 7-22")
    assert one(checks, RIMS).demand == 0.0
    assert one(checks, RIMS).note == "no bearing lifts off"
    assert not [c for c in checks if "landing" in c.title]


@pytest.mark.parametrize(("own", "word"), [(0.05, "laxer"), (0.001, "not laxer")])
def test_a_limit_of_the_project_stands_beside_that_of_the_code(frame, runs, own, word):
    checks = history_checks(runs, frame, "ASCE 7-22", limits=DesignLimits(drift=own))
    code = one(checks, "storey drift ratio", "ASCE 7-22 17.6.4.4")
    project = one(checks, "storey drift ratio", "no code: limit of the project")
    assert (code.limit, project.limit) == (0.02, own)
    assert code.demand == project.demand
    assert project.note.endswith(
        f"{word} than 2 % of ASCE 7-22 17.6.4.4, which is checked separately"
    )
    assert project.standing.kind == "own"
    europe = history_checks(runs, frame, "EN 1998-1", limits=DesignLimits(drift=own))
    assert one(europe, "storey drift ratio", "EN 1998-1 4.4.3.2").limit == 0.005
    assert one(europe, "storey drift ratio", "no code: limit of the project").limit == own
    plain = history_checks(runs, frame, "ASCE 7-22", limits=DesignLimits(base_shear=1e9))
    assert one(plain, "base shear").clause == "no code: limit of the project"


@pytest.mark.parametrize(("share", "said"), [(0.75, True), (0.70, False)])
def test_displacement_says_when_its_level_may_have_more_wrong_than_its_margin(
    bearing: LIRBearing, runs: xr.Dataset, share: float, said: bool
) -> None:
    """Unlike friction: 29 % over the right value, so that 0.75 may be 0.75 / 0.71 = 1.056."""
    friction = CoulombFriction(0.03), CoulombFriction(0.16)
    unlike = replace(bearing, friction=friction, interface_friction=0.3)
    alone = lumped_mass(unlike, 180e3)
    title = "isolator displacement"
    limit = one(history_checks(runs, alone, "ASCE 7-22"), title).limit
    nothing = 0.0 * runs["peak_displacement"]
    tipped = runs.assign(peak_displacement=nothing + share * limit, peak_eccentricity=nothing + 0.4)
    check = one(history_checks(tipped, alone, "ASCE 7-22"), title)
    assert check.passed
    assert check.demand == pytest.approx(share * limit)
    words = "the displacement may be off by 29 %, more than its margin"
    assert (words in check.note) == said
    solid = tipped.assign_attrs(level="contact")
    assert words not in one(history_checks(solid, alone, "ASCE 7-22"), title).note


def test_an_error_of_the_right_value_may_hide_any_demand() -> None:
    """2.2 times the right value, or e of it: 1 / (1 - e), and from e = 1 on no bound at all."""
    check = Check(clause="x", title="slip", demand=0.01, limit=1.0, subject="A")
    assert "off by 220 %" in doubted([check], {"A": 2.2}, "slip")[0].note
    assert doubted([check], {"A": 0.98}, "slip") == [check]  # 0.01 / 0.02 = 0.5
    assert doubted([check], {"A": 0.995}, "slip")[0].note  # 0.01 / 0.005 = 2
    assert doubted([check], {"A": 0.0}, "slip") == [check]


def test_limits_have_bounds() -> None:
    for name, value, words in (
        ("rim_strength", -3e6, r"rim_strength = -3e\+06 \[N\] must be at least 1 "),
        ("interface_pressure", 60.0, r"interface_pressure = 60 \[Pa\] must be at least 100000"),
        ("eccentricity", 1.5, "eccentricity = 1.5 .* must be at least 0.01 and at most 1: give"),
        ("drift", 5.0, "drift = 5 .* below 0.2: give a pure number, or leave it out"),
        ("uplift_gap", 120.0, r"uplift_gap = 120 \[m\] .* below 0.5"),
        ("rim_engagement", 75.0, "rim_engagement = 75"),
        ("base_shear", math.inf, "base_shear = inf"),
    ):
        with pytest.raises(CheckError, match=words):
            DesignLimits(**{name: value})


def test_the_file_knows_every_limit() -> None:
    pytest.importorskip("pydantic")
    from frames.design.project.schema import Limits

    assert set(Limits.model_fields) == {f.name for f in fields(DesignLimits)}


def test_gamma_x_raises_the_slip_as_well(frame, bearing, runs):
    """Rims met at 200 mm; 190 mm of runs are 228 mm by EN 1998-1, of which 28 mm are slip."""
    moved = runs.assign(peak_displacement=0.19 + 0.0 * runs["peak_displacement"])
    checks = history_checks(moved, frame, "EN 1998-1")
    for title in ("slip over the overlap", "slip over its stable limit s*"):
        assert one(checks, title).demand == pytest.approx(1.2 * 0.19 - 0.2)
    plain = history_checks(moved, frame, "ASCE 7-22")
    assert one(plain, "slip over the overlap").demand < 0.01
    rims = one(checks, "displacement where a rim engages, over gamma_x d_bd of histories")
    assert rims.demand == pytest.approx(0.2 / 0.228)
    assert (rims.limit, rims.passed, rims.verdict) == (1.0, False, "needs agreement")
    assert rims.clause == "EN 1998-1 10.3(2), EN 15129"
    assert "agreement of the authority" in rims.note
    agreed = history_checks(moved, frame, "EN 1998-1", limits=DesignLimits(rim_engagement=0.8))
    title = "displacement where a rim engages, over gamma_x d_bd of histories"
    assert one(agreed, title, "limit of the project").passed
    assert not one(agreed, title, "EN 1998-1").passed
