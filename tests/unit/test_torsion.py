"""Torsion of equivalent-linear analyses: the eccentricity is that of the masses of the model."""

from __future__ import annotations

import pytest
from numpy.testing import assert_allclose

from frames import Frame, shear_building
from frames.design import (
    ASCE7,
    EN1998,
    DesignTarget,
    IsolationSystem,
    NCh2745,
    Spectrum,
    Superstructure,
    design,
    equivalent_linear,
    prototype_tests,
)
from tests.scenes import large_bearing

BEARING = large_bearing()
ASCE = Spectrum.asce7(s_ms=1.2, s_m1=0.5)
EUROPE = Spectrum.en1998(a_g=3.0, ground_type="C")
CHILE = Spectrum.nch2745(soil="II", zone=2)


def building(share: float, **options: bool) -> Frame:
    return shear_building(
        BEARING,
        [1.5e5] * 3,
        2e8,
        storey_height=3.5,
        plan=((4, 2), (6.0, 5.0)),
        eccentricity=(share, 0.0),
        **options,
    )


def analysed(frame, spectrum, code, *, storeys=False):
    above = Superstructure.from_frame(frame, R=2.0) if storeys else None
    system = IsolationSystem.from_frame(frame, s_ms=1.2)
    return equivalent_linear(system, spectrum, bounds=None, code=code, superstructure=above)


def corners(share: float) -> tuple[float, float]:
    """Return the distance of the farthest bearings from the centre, and the eccentricity [m].

    Bearings alike under equal loads: their centre of stiffness is the middle of the plan.
    """
    return 12.0, share * 24.0


@pytest.mark.parametrize("share", [0.0, 0.03, 0.30])
def test_d_tm_by_nch2745(share: float) -> None:
    found = analysed(building(share, overturning=False), CHILE, NCh2745())["nominal"]
    far, off = corners(share)
    grows = 1.0 + far * 12.0 * (off + 0.05 * 24.0) / (24.0**2 + 10.0**2)
    assert found.total_displacement == pytest.approx(found.displacement * max(grows, 1.1))


@pytest.mark.parametrize("spectrum", [ASCE, EUROPE, CHILE])
def test_pendulums_are_as_stiff_as_they_are_loaded(spectrum: Spectrum) -> None:
    """Where loads follow the masses so does the centre of stiffness: accidental torsion is left."""
    code = {id(ASCE): ASCE7(), id(EUROPE): EN1998(), id(CHILE): NCh2745()}[id(spectrum)]
    plain, off = (analysed(building(share), spectrum, code)["nominal"] for share in (0.0, 0.1))
    assert off.trace.value("x_M") == pytest.approx(2.4, rel=1e-12)
    assert off.trace.value("x_R") == pytest.approx(2.4, rel=2e-3)
    own = off.trace.value("e_x") - plain.trace.value("e_x")
    assert 0.0 <= own < 5e-3  # what friction of tilting plates carries of the moment
    held = analysed(building(0.1, overturning=False), spectrum, code)["nominal"]
    assert held.trace.value("e_x") - plain.trace.value("e_x") == pytest.approx(2.4, rel=1e-9)
    assert "the model restrains the tilt" in held.trace["x_M"].note
    assert "the bearings' loads: 0.000 m, " in held.trace["x_M"].note
    assert off.trace["x_M"].note == "centre of mass, of the model's masses"


def test_an_eccentricity_that_is_given_counts_before_the_masses() -> None:
    frame = building(0.1, overturning=False)
    system = IsolationSystem.from_frame(frame, eccentricity=(0.5, 0.0))
    found = equivalent_linear(system, ASCE, bounds=None)["nominal"]
    assert found.trace.value("e_x") == pytest.approx(0.5 + 0.05 * 24.0)


def test_a_design_goes_by_the_same_eccentricity() -> None:
    target = DesignTarget(radii=(2.5,), frictions=(0.05,), least_pressure=1e6)
    strong = Spectrum.asce7(s_ms=1.2, s_m1=0.8)
    moved = [
        design(building(share, overturning=False), strong, bounds=None, target=target).chosen
        for share in (0.0, 0.03, 0.30)
    ]
    found = [one.analysis["nominal"] for one in moved]
    ratios = [each.total_displacement / each.displacement for each in found]
    expected = [1.0 + 12.0 * 12.0 * (share + 0.05) * 24.0 / 676.0 for share in (0.0, 0.03, 0.30)]
    p_t = [
        max((8.0 * 6.0**2 / 4.0 + 2.0 * 25.0 / 3.0 + (share * 24.0) ** 2) / (676.0 / 12.0), 1.0)
        for share in (0.0, 0.03, 0.30)
    ]
    grows = [1.0 + (factor - 1.0) / square for factor, square in zip(expected, p_t, strict=True)]
    assert_allclose(ratios, grows, rtol=1e-9)
    assert moved[0].plan_diameter < moved[1].plan_diameter < moved[2].plan_diameter


@pytest.mark.parametrize("options", [{"overturning": False}, {}])
def test_axial_loads_are_judged_where_the_model_tells_them(options: dict[str, bool]) -> None:
    frame = building(0.05, **options)
    code = ASCE7(pressure_limit=1e9, no_tension=True)
    result = analysed(frame, ASCE, code, storeys=True)
    checks = [c for c in result.checks if "uplift" in c.title or "pressure" in c.title]
    assert checks
    programme = prototype_tests(result, IsolationSystem.from_frame(frame, s_ms=1.2))
    of_loads = programme["what"].str.contains("largest load|least load")
    assert of_loads.any()
    assert programme["vertical load [N]"][~of_loads].notna().all()
    if options:
        assert all(c.title.endswith(": not evaluated") and not c.passed for c in checks)
        assert all("supports of the model restrain its tilt" in c.note for c in checks)
        assert programme["vertical load [N]"][of_loads].isna().all()
        assert programme["note"][of_loads].str.startswith("not evaluated: ").all()
    else:
        assert all(c.passed for c in checks)
        assert programme["vertical load [N]"][of_loads].notna().all()


def test_one_bearing_has_no_lever() -> None:
    system = IsolationSystem(
        bearings=(BEARING,),
        positions=((0.0, 0.0),),
        loads=(4e6,),
        plan=(10.0, 10.0),
        combinations={"most": (5e6,)},
    )
    above = Superstructure(
        fixed_base_period=0.3, storey_weights=(2e6,), storey_heights=(3.0,), R=2.0
    )
    result = equivalent_linear(system, ASCE, bounds=None, superstructure=above)
    (check,) = (c for c in result.checks if "uplift" in c.title)
    assert not check.passed
    assert check.note.startswith("one bearing has no lever against the overturning moment M_o")
