"""Equivalent-linear analysis: numbers by hand, fixed points by another solver, each code."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from frames import Frame, MotionError, Section, shear_building
from frames.design import (
    ASCE7,
    EN1998,
    HISTORY_RULES,
    Check,
    CheckError,
    EquivalentLinear,
    FrictionPendulum,
    IsolationSystem,
    NCh2745,
    PropertyBounds,
    PropertyModificationFactors,
    Spectrum,
    Superstructure,
    equivalent_linear,
    with_property_bounds,
)
from frames.design.histories.bound_checks import BoundChecks
from frames.design.histories.eccentricity import Case
from lir_element import VelocityFriction
from tests.refusals import refused
from tests.scenes import tall_bearing

G = 9.81
BOUNDS = PropertyBounds(PropertyModificationFactors(0.7, 1.6))
# 3 x 2 bearings; the loads' centre is off the plan's.
PLACES = tuple((x, y) for x in (-6.0, 0.0, 6.0) for y in (-4.0, 4.0))
LOADS = (1.0e6, 1.2e6, 2.0e6, 2.4e6, 1.0e6, 1.4e6)
BEARING = tall_bearing()
SYSTEM = IsolationSystem(
    bearings=(BEARING,) * 6,
    positions=PLACES,
    loads=LOADS,
    plan=(14.0, 10.0),
    combinations={"maximum": (2.8e6,) * 6, "minimum": (0.9e6,) * 6},
)
ABOVE = Superstructure(
    fixed_base_period=0.6,
    storey_weights=(2.0e6, 2.0e6, 1.8e6),
    storey_heights=(3.5, 3.0, 3.0),
    R=5.0,
    storey_stiffness=(4e8, 3e8, 2e8),
    vertical_period=0.05,
)


class Asce:
    """S_M1 / T in g; table of B_M."""

    def __init__(self, s_m1: float) -> None:
        self.s_m1 = s_m1

    def real(self) -> Spectrum:
        return Spectrum.asce7(s_ms=1.5, s_m1=self.s_m1)

    def damping_factor(self, damping: float) -> float:
        table = [0.8, 1.0, 1.2, 1.5, 1.7, 1.9, 2.0]
        return float(np.interp(100.0 * damping, [2, 5, 10, 20, 30, 40, 50], table))

    def displacement(self, period: float, damping: float) -> float:
        return G * self.s_m1 * period / (4.0 * math.pi**2 * self.damping_factor(damping))


class En:
    """Type 1, ground C beyond T_C = 0.6 s: constant displacement beyond T_D = 2 s."""

    def __init__(self, plateau: float) -> None:
        self.plateau = plateau

    def real(self) -> Spectrum:
        return Spectrum.en1998(a_g=self.plateau / (2.5 * 1.15), ground_type="C")

    def acceleration(self, period: float, damping: float) -> float:
        shape = 0.6 / period if period < 2.0 else 1.2 / period**2
        return self.plateau * shape * max(math.sqrt(10.0 / (5.0 + 100.0 * damping)), 0.55)

    def displacement(self, period: float, damping: float) -> float:
        return self.acceleration(period, damping) * (period / (2.0 * math.pi)) ** 2


class NCh:
    """Displacement plateau of 200 or 300 mm times Z = 1.25 and 1.2; table of B."""

    def __init__(self, plateau: float) -> None:
        self.plateau = plateau

    def real(self) -> Spectrum:
        return Spectrum.nch2745({0.20: "I", 0.30: "II"}[self.plateau], zone=3)

    def displacement(self, _: float, damping: float) -> float:
        table = [0.65, 1.0, 1.37, 1.67, 1.94, 2.17, 2.38, 3.02]
        factor = np.interp(100.0 * damping, [2, 5, 10, 15, 20, 25, 30, 50], table)
        return 1.2 * 1.25 * self.plateau / float(factor)


def one(mu: float, radius: float = 2.5, **more: object) -> IsolationSystem:
    return IsolationSystem(
        bearings=(FrictionPendulum((radius,), (mu,)),),
        positions=((0.0, 0.0),),
        loads=(1500e3,),
        plan=(20.0, 20.0),
        gravity=G,
        **more,
    )


def nominal(system: IsolationSystem, spectrum: object, **more: object) -> EquivalentLinear:
    return analysed(system, spectrum, bounds=None, **more)


def analysed(system: IsolationSystem, spectrum: object, **more: object) -> EquivalentLinear:
    return equivalent_linear(system, spectrum.real(), **more)


def pendulum(mu: float, radius: float, d: float, g: float = G) -> tuple[float, float]:
    """Return period and damping at a displacement."""
    period = 2.0 * math.pi / math.sqrt(g * (1.0 / radius + mu / d))
    return period, 2.0 / math.pi * mu / (mu + d / radius)


def met(spectrum: Any, mu: float, radius: float, g: float = G) -> float:
    """Return the displacement that the spectrum has at its period and damping."""

    def off(d: float) -> float:
        return spectrum.displacement(*pendulum(mu, radius, d, g)) - d

    return brentq(off, 0.01, 2.0, xtol=1e-14)


@pytest.mark.parametrize(
    ("spectrum", "mu", "radius"),
    [
        *((Asce(0.9), mu, 2.5) for mu in (0.04, 0.06, 0.09)),
        (En(9.9), 0.12, 2.5),  # between T_C and T_D
        (En(9.9), 0.05, 4.0),  # beyond
        *((NCh(plateau), 0.06, 2.5) for plateau in (0.20, 0.30)),
    ],
)
def test_displacement_of_a_pendulum(spectrum: Any, mu: float, radius: float) -> None:
    found = nominal(one(mu, radius), spectrum)["nominal"]
    d = met(spectrum, mu, radius)
    assert found.displacement == pytest.approx(d, rel=1e-9)
    last = found.iterations[-1]
    assert last.found == pytest.approx(last.assumed, rel=1e-12)
    torsion = 1.1 if isinstance(spectrum, NCh) else 1.15
    if not isinstance(spectrum, En):
        assert found.total_displacement == pytest.approx(torsion * d)
    if isinstance(spectrum, NCh):
        assert found.trace.value("C_M") == pytest.approx(1.5 * spectrum.plateau)
        d = found.trace.value("D_D")  # the damping there is more than at D_M
        assert 1.2 * d < found.displacement
        assert 1.2 * d == pytest.approx(spectrum.displacement(*pendulum(mu, radius, d)))
    else:
        assert (found.period, found.damping) == pytest.approx(pendulum(mu, radius, d), rel=1e-9)
    if isinstance(spectrum, Asce):
        assert found.base_shear == pytest.approx(1500e3 * (d / radius + mu), rel=1e-9)


def tuned(mu: float, displacement: float) -> Asce:
    """Return the spectrum that gives this displacement, with a radius of 2.5 m."""
    return Asce(displacement / Asce(1.0).displacement(*pendulum(mu, 2.5, displacement)))


def test_restoring_force_at_300_mm() -> None:
    """The second half of D adds 90 kN where 37.5 are asked for; k(0.2 D) = W / R + 5 mu W / D."""
    found = nominal(one(0.06), tuned(0.06, 0.30))["nominal"]
    assert found.displacement == pytest.approx(0.30, rel=1e-10)
    values = [found.trace.value(name) for name in ("Delta_F", "Delta_F_lim", "k_02")]
    assert values == pytest.approx([90e3, 37.5e3, 600e3 + 1500e3], rel=1e-9)
    assert found.checks.of("17.2.4.4")[0].ratio == pytest.approx(37.5 / 90.0)


def test_a_joint_in_the_slider_takes_the_corners_off_the_loop() -> None:
    """R_eff = 0.95 + 0.95 m, mu = 0.05 / 0.09: beta 0.18847 at 0.3 m, not 0.19554."""
    system = replace(one(0.06), bearings=(FrictionPendulum((0.95, 0.95), (0.05, 0.09)),))

    def off(d: float) -> float:
        force = d / 1.9 + 0.07
        low, high = 0.95 * (force - 0.05), 0.95 * (force - 0.09)
        beta = 4.0 * (0.05 * low + 0.09 * high) / (2.0 * math.pi * force * d)
        return Asce(0.9).displacement(2.0 * math.pi * math.sqrt(d / (force * G)), beta) - d

    found = nominal(system, Asce(0.9))["nominal"]
    assert found.displacement == pytest.approx(brentq(off, 0.1, 1.0, xtol=1e-14), rel=1e-10)
    refused(CheckError, "below the corner", nominal, system, Asce(0.12))


def test_torsion_ratio_of_six_bearings() -> None:
    """By hand: sum x^2 + y^2 = 4 (36 + 16) + 2 * 16 = 240, about the loads' centre less 6 r^2."""
    even = replace(SYSTEM, loads=(1.5e6,) * 6)
    t = nominal(even, Asce(0.6))["nominal"].trace
    assert t.value("r_I") == pytest.approx(math.sqrt(296.0 / 12.0), rel=1e-12)
    assert t.value("P_T") == pytest.approx(math.sqrt(240.0 / 6.0) / math.sqrt(296.0 / 12.0))
    corner = 1.0 + 6.0 / (40.0 * 12.0 / 296.0) * 12.0 * 0.7 / 296.0
    assert t.values("D_Ty")[0] == pytest.approx(t.value("D_M") * max(corner, 1.15))
    # With the loads off centre, mass and stiffness move together; levers are longer to one side.
    t = nominal(SYSTEM, Asce(0.6))["nominal"].trace
    y = sum(p * place[1] for p, place in zip(LOADS, PLACES, strict=True)) / sum(LOADS)
    assert t.value("y_M") == pytest.approx(y)
    assert t.value("y_R") == pytest.approx(y)
    assert t.value("e_y") == pytest.approx(0.05 * 14.0)
    # Where the last bearing has less friction, stiffness moves away from it.
    weak = replace(SYSTEM, bearings=(*SYSTEM.bearings[:5], FrictionPendulum((2.7,), (0.02,))))
    less = nominal(weak, Asce(0.6))["nominal"].trace
    assert less.value("x_R") < t.value("x_R") - 0.1
    assert less.value("e_x") > t.value("e_x") + 0.1
    given = nominal(replace(even, eccentricity=(0.0, 1.0)), Asce(0.6))["nominal"].trace
    assert (given.value("e_x"), given.value("e_y")) == pytest.approx((0.7, 1.7))
    square = replace(even, plan=(20.0, 20.0))
    t = nominal(square, Asce(0.6), code=ASCE7(least_torsion=1.0))["nominal"].trace
    assert t.value("P_T") == 1.0
    assert t.values("D_Ty")[0] == pytest.approx(t.value("D_M") * (1.0 + 6.0 * 12.0 / 800.0))


@pytest.mark.parametrize("exponent", [2.5, 3.5])
def test_unreduced_shear_above(exponent: float) -> None:
    """W_s / W = 5.8 / 9; 3.5 where sliding sets in abruptly."""
    code = ASCE7(exponent=exponent)
    t = nominal(SYSTEM, Asce(0.6), superstructure=ABOVE, code=code)["nominal"].trace
    power = 1.0 - exponent * t.value("beta_M")
    assert t.value("V_st") == pytest.approx(t.value("V_b") * (5.8 / 9.0) ** power)


def test_design_shear_is_the_largest_of_its_minima() -> None:
    found = analysed(SYSTEM, Asce(0.9), bounds=BOUNDS, superstructure=ABOVE)
    mu = BEARING.effective_friction
    for each in found.bounds.values():
        t = each.trace
        # R_I = 3/8 * 5; 12.8 at T_M with S_DS = 1, S_D1 = 0.6
        reduced = t.value("V_b") * (5.8 / 9.0) ** (1.0 - 3.5 * t.value("beta_M")) / 1.875
        fixed = max(0.6 / t.value("T_M") / 5.0, 0.044, 0.5 * 0.9 / 5.0) * 5.8e6  # S_1 as S_M1
        slides = max(1.6 * mu, 1.5 * mu) * 9.0e6
        assert each.superstructure_shear == pytest.approx(max(reduced, fixed, slides))
        assert sum(each.storey_forces[1:]) == pytest.approx(each.superstructure_shear)
        unreduced = t.value("V_b") * (5.8 / 9.0) ** (1.0 - 3.5 * t.value("beta_M"))
        assert each.storey_forces[0] == pytest.approx((t.value("V_b") - unreduced) / 1.875)
        power = 14.0 * t.value("beta_M") * 0.6
        shares = np.array([2.0, 2.0, 1.8]) * np.array([3.5, 6.5, 9.5]) ** power
        expected = each.superstructure_shear * shares / shares.sum()
        np.testing.assert_allclose(each.storey_forces[1:], expected, rtol=1e-12)
    windy = replace(ABOVE, wind_shear=5e6)
    blown = analysed(SYSTEM, Asce(0.9), bounds=BOUNDS, superstructure=windy)
    assert blown.superstructure_shear == 5e6


@pytest.mark.parametrize(
    ("spectrum", "clause", "factor", "limit"),
    [(Asce(0.9), "17.5.6", 1.875, 0.015), (En(8.0), "4.4.3.2", 0.5 * 1.5, 0.005)],
)
def test_drifts_by_hand(spectrum: Any, clause: str, factor: float, limit: float) -> None:
    """ASCE 7-22: R_I of the elastic ones. EN 1998-1: q d_e, nu = 0.5 of it at damage limitation."""
    found = analysed(SYSTEM, spectrum, bounds=BOUNDS, superstructure=ABOVE)["upper"]
    shears = np.cumsum(found.storey_forces[:0:-1])[::-1]
    drift, heights = factor * shears / [4e8, 3e8, 2e8], np.array([3.5, 3.0, 3.0])
    check, k = found.checks.of(clause)[0], int((drift / heights).argmax())
    assert check.subject == f"storey {k + 1}"
    assert check.demand == pytest.approx(drift[k], rel=1e-12)
    assert check.limit == pytest.approx(limit * heights[k], rel=1e-12)
    if isinstance(spectrum, En):  # overturning is that of the forces before they are reduced
        moment = 1.5 * float(np.array(found.storey_forces[1:]) @ [3.5, 6.5, 9.5])
        assert found.trace.value("M_o") == pytest.approx(moment, rel=1e-12)


def test_overturning_by_hand() -> None:
    code = ASCE7(pressure_limit=40e6)
    result = analysed(SYSTEM, Asce(0.9), bounds=BOUNDS, superstructure=ABOVE, code=code)
    found, t = result["upper"], result["upper"].trace
    forces = np.array(found.storey_forces[1:])
    moment = t.value("V_st") * float(forces @ [3.5, 6.5, 9.5]) / forces.sum()
    # Corner bearings: levers 6 m of 4 * 36, and 4 m of 6 * 16.
    x, y = moment * 6.0 / 144.0, moment * 4.0 / 96.0
    load = max(x + 0.3 * y, 0.3 * x + y)
    assert t.values("N_E")[0] == pytest.approx(load)
    by_title = {check.title: check for check in found.checks}
    uplift = by_title["no uplift, minimum"]
    assert (uplift.demand, uplift.limit) == (pytest.approx(load), 0.9e6)
    assert uplift.ratio == pytest.approx(load / 0.9e6)
    pressure = by_title["pressure on the slider, maximum"]
    assert pressure.demand == pytest.approx((2.8e6 + load) / (math.pi * 0.2**2))


def test_a_row_of_bearings_has_no_lever_across() -> None:
    row = replace(
        SYSTEM,
        bearings=(BEARING,) * 2,
        positions=((-5.0, 0.0), (5.0, 0.0)),
        loads=(4.5e6,) * 2,
        combinations={"minimum": (3e6, 3e6)},
    )
    t = nominal(row, Asce(0.6), superstructure=ABOVE)["nominal"].trace
    assert t.values("N_E") == pytest.approx([t.value("M_o") / 10.0] * 2)
    assert "N_Ey" not in t


def test_minima_of_time_histories() -> None:
    t = nominal(SYSTEM, Asce(0.6), superstructure=ABOVE)["nominal"].trace
    reduced = 1.0 / math.sqrt(1.0 + (0.6 / t.value("T_M")) ** 2)
    assert t.value("D_prime_M") == pytest.approx(t.value("D_M") * reduced)
    assert t.value("D_TM_dyn") == pytest.approx(0.8 * t.value("D_TM") * reduced)
    assert t.value("V_b_dyn") == pytest.approx(0.9 * t.value("V_b"))
    assert t.value("V_s_dyn") == pytest.approx(t.value("V_s"))
    code = ASCE7(history_share=0.6, irregular=True)
    less = nominal(SYSTEM, Asce(0.6), superstructure=ABOVE, code=code)["nominal"]
    assert less.trace.value("V_s_dyn") == pytest.approx(0.6 * t.value("V_s"))
    [irregular] = [c for c in less.checks if c.title == "irregular structure"]
    assert irregular.verdict == "does not apply"


def test_scope_of_checks_and_their_table() -> None:
    """What a time history leaves standing is asked of any bearing; tables do not show it."""
    code = ASCE7(pressure_limit=60e6)
    asce = nominal(SYSTEM, Asce(0.6), superstructure=ABOVE, code=code)["nominal"].checks
    titles = {scope: {c.title for c in asce if c.scope == scope} for scope in ("any", "demand")}
    assert titles["any"] == {"restoring force", "overturning of the whole structure"}
    load = "pressure on the slider"
    assert titles["demand"] == {"storey drift", f"{load}, maximum", f"{load}, minimum"}
    assert {c.title for c in asce if c.scope == "procedure"} == {
        "no restrainer contact at the total displacement",
        "effective stiffness ratio, D_M to 0.2 D_M",
        "period ratio T_M / T_fb",
        *("effective period", "effective damping", "storeys", "height"),
        *("no uplift, maximum", "no uplift, minimum"),
    }
    columns = "clause title demand limit symbol unit relation standing bound subject note void"
    assert list(asce.to_dataframe()) == f"{columns} level ratio passed verdict".split()
    assert {c.level for c in asce} == {"MCE_R"}
    refused(CheckError, "scope", replace, asce[0], scope="all")


def test_bounds_are_one_argument() -> None:
    found = analysed(SYSTEM, Asce(0.9), bounds=BOUNDS, superstructure=ABOVE)
    assert list(found.bounds) == ["lower", "upper"]
    for name in ("lower", "upper"):
        alone = nominal(with_property_bounds(SYSTEM, name, BOUNDS), Asce(0.9))["nominal"]
        assert found[name].displacement == alone.displacement
        assert {c.bound for c in found[name].checks} == {name}
    assert found.displacement == found["lower"].displacement > found["upper"].displacement
    assert found.total_displacement == found["lower"].total_displacement
    assert found.base_shear == max(found[b].base_shear for b in ("lower", "upper"))
    with pytest.raises(CheckError, match="no bound 'nominal'"):
        found["nominal"]


def test_rims_that_are_met_are_reported_at_each_bound() -> None:
    found = analysed(SYSTEM, Asce(0.9), bounds=BOUNDS)
    lower, upper = (found.checks.of("17.2.4.5", bound=b)[0] for b in ("lower", "upper"))
    assert not lower.passed
    assert upper.passed
    assert lower.ratio == pytest.approx(found["lower"].total_displacement / 0.45)
    assert f"{45.0 / found['lower'].total_displacement:.0f} % of the displacement" in lower.note
    assert upper.note == ""


def test_interface_at_its_lower_bound_holds_the_surfaces_at_their_upper_one() -> None:
    bounds = PropertyBounds(
        PropertyModificationFactors(0.7, 1.6), PropertyModificationFactors(0.5, 2.0)
    )
    mu = BEARING.effective_friction
    check = analysed(SYSTEM, Asce(0.9), bounds=bounds).general[0]
    assert check.ratio == pytest.approx(1.6 * mu / (0.5 * 0.25))
    weak = PropertyBounds(
        PropertyModificationFactors(0.7, 1.6), PropertyModificationFactors(0.4, 2.0)
    )
    assert not analysed(SYSTEM, Asce(0.9), bounds=weak).general.passed
    solid = replace(SYSTEM, bearings=(BEARING.as_dcfp(),) * 6)
    assert len(analysed(solid, Asce(0.9), bounds=bounds).general) == 0


def test_each_check_can_be_followed_to_what_was_given() -> None:
    """Every line's shown formula gives its value from the numbers shown with it."""
    spectra = Asce(0.9), En(8.0), NCh(0.30)
    for spectrum in spectra:
        found = analysed(SYSTEM, spectrum, bounds=BOUNDS, superstructure=ABOVE)
        for check in found.checks:
            assert check.symbol in check.trace
            assert (check.standing.kind == "own") == check.clause.startswith("LIR-DCFP")
            for step in check.trace:
                assert set(e.symbol for e in step.entered) <= {s.symbol for s in check.trace}
                scope = {e.symbol: np.asarray(e.value) for e in step.entered}
                if step.formula and not {"min(", "max(", "above("} & set(
                    part + "(" for part in step.formula.replace("(", " ( ").split()
                ):
                    names = {"sqrt": np.sqrt, "sum": np.sum, "abs": np.abs, "pi": math.pi}
                    value = eval(step.formula, names | scope)  # noqa: S307
                    np.testing.assert_allclose(step.value, value, rtol=1e-12)
        table = str(found)
        assert "FAILS" in table or found.checks.passed
        assert found.code in repr(found)
        assert found.to_dataframe().loc["upper", "damping [-]"] == found["upper"].damping
        assert "<table>" in found._repr_html_()


def test_displacement_by_en1998() -> None:
    g, mu = 9.80665, BEARING.effective_friction
    found = nominal(SYSTEM, En(8.0), superstructure=ABOVE)["nominal"]
    assert found.displacement == pytest.approx(met(En(8.0), mu, 2.7, g), rel=1e-9)
    s_e = En(8.0).acceleration(found.period, found.damping)
    assert found.base_shear == pytest.approx(9.0e6 / g * s_e)
    forces = np.array([3.2e6, 2.0e6, 2.0e6, 1.8e6]) / g * s_e / 1.5
    np.testing.assert_allclose(found.storey_forces, forces, rtol=1e-12)
    # Torsion by hand: stiffness goes by the loads.
    p, places = np.array(LOADS), np.array(PLACES)
    x, y = (places - p @ places / p.sum()).T
    r2 = p @ (x**2 + y**2) / p.sum()
    worst = np.maximum(1.0 + 0.5 / r2 * abs(y), 1.0 + 0.7 / r2 * abs(x))
    np.testing.assert_allclose(found.displacements, found.displacement * worst, rtol=1e-12)
    allowed = 1.2 * found.displacement * worst
    np.testing.assert_allclose(found.trace.values("d_Ed"), allowed, rtol=1e-12)


def test_what_bearings_must_allow_stands_beside_the_displacement() -> None:
    """The limit of the rims is held against gamma_x d_bd: the table has that number too."""
    found = nominal(SYSTEM, En(8.0))
    one = found["nominal"]
    assert one.allowed_displacement == pytest.approx(1.2 * one.total_displacement)
    table = found.to_dataframe()
    assert table.loc["nominal", "allowed_displacement [m]"] == one.allowed_displacement
    assert "allowed displacement [mm]" in found.head()
    assert f"{1e3 * one.allowed_displacement:.0f} mm" in repr(found)
    (rims,) = (c for c in found.checks if c.title.startswith("no restrainer contact"))
    assert rims.title == "no restrainer contact at gamma_x d_bd"
    assert rims.demand == pytest.approx(one.allowed_displacement)
    asce = nominal(SYSTEM, Asce(0.6))  # where it is the same, it is not there twice
    assert "allowed_displacement [m]" not in asce.to_dataframe()
    assert "must allow" not in repr(asce)


@pytest.mark.parametrize(
    ("s_1", "r", "least"),
    [
        (0.60, 8.0, 0.5 * 0.60 / 8.0),
        (0.59, 8.0, 0.044 * 0.8),
        (None, 8.0, 0.5 * 0.7 / 8.0),
        (0.59, 1.0, None),
    ],
)
def test_least_shear_of_a_fixed_base(s_1: float | None, r: float, least: float | None) -> None:
    """ASCE 7-22 12.8: C_s = S_D1 / T_M / R, S_D1 = 2/3 S_M1, above (12.8-5) and (12.8-6).

    0.5 S_1 I_e / R counts from S_1 = 0.6 g on; S_M1 stands for an unknown S_1.
    """
    target = Spectrum.asce7(s_ms=1.2, s_m1=0.7, s_1=s_1)
    above = replace(ABOVE, R=r)
    found = equivalent_linear(SYSTEM, target, bounds=None, superstructure=above)["nominal"]
    falling = 0.7 / 1.5 / found.period / r
    assert (falling < least) if least else (falling > 0.044 * 0.8)
    assert found.trace.value("C_s") == pytest.approx(least or falling, rel=1e-12)
    assert found.trace.value("V_fixed") == pytest.approx(5.8e6 * (least or falling), rel=1e-12)
    assert target.scaled(2.0).parameters.get("S_1") == (None if s_1 is None else 2.0 * s_1)


@pytest.mark.parametrize(
    ("factor", "note"),
    [
        (1.0, "of isolated structures by 17.2.1"),
        (1.5, "as given; 17.2.1 has 1.0 for isolated structures"),
    ],
)
def test_importance_of_an_isolated_structure_is_said(factor: float, note: str) -> None:
    above = replace(ABOVE, importance=factor)
    found = nominal(SYSTEM, Asce(0.9), superstructure=above)["nominal"]
    assert found.trace["I_e"].note == note


def test_recentring_at_300_mm() -> None:
    """W = 1500 kN, R = 2.5 m, mu = 0.06, d = 0.30 m: E_S / E_H = 1, d / (mu R) = 2."""
    plateau = 0.30 / En(1.0).displacement(*pendulum(0.06, 2.5, 0.30))
    checks = nominal(one(0.06), En(plateau))["nominal"].checks
    energy, way = checks.of("EN 15129 4.3")[0], checks.of("7.7.1")[0]
    assert 0.25 * energy.demand / energy.limit == pytest.approx(1.0, rel=1e-9)
    assert 0.5 * way.demand / way.limit == pytest.approx(2.0, rel=1e-9)
    assert (energy.ratio, way.ratio) == pytest.approx((0.25, 0.25))


def test_limits_of_the_simplified_analysis_need_all_their_numbers() -> None:
    more = {"code": EN1998(simplified=True), "superstructure": ABOVE}
    refused(CheckError, "fault_distance", nominal, SYSTEM, En(8.0), **more)
    code = EN1998(simplified=True, fault_distance=12e3, property_variation=0.12)
    found = nominal(SYSTEM, En(8.0), code=code, superstructure=ABOVE)
    beyond = found.checks.of("EN 1998-1 10.9").inapplicable
    assert {"distance to the fault", "variation of properties"} <= {c.title for c in beyond}
    assert {c.verdict for c in beyond} == {"does not apply"}
    assert not {c.title for c in beyond} & {c.title for c in found.checks.failed}
    assert len(found.checks.of("10.9.3")) == 7
    stiff = next(c for c in found.checks if c.title == "vertical over effective stiffness")
    vertical = 9.0e6 / SYSTEM.gravity * (2.0 * math.pi / 0.05) ** 2  # T_v = 0.05 s
    assert stiff.demand == pytest.approx(vertical / found["nominal"].stiffness, rel=1e-12)
    assert (stiff.limit, stiff.passed) == (150.0, True)


def test_total_eccentricity_by_en1998() -> None:
    """The accidental 5 % along each side, and the actual one: 0.42 m of 14 m are 3 %."""
    for actual, passed in (((0.0, 0.0), True), ((0.42, 0.0), False)):
        system = replace(SYSTEM, eccentricity=actual)
        found = nominal(system, En(8.0))
        check = next(c for c in found.checks if c.title.startswith("total eccentricity"))
        assert check.demand == pytest.approx(0.05 + actual[0] / 14.0, rel=1e-12)
        assert (check.limit, check.passed, check.scope) == (0.075, passed, "procedure")


def test_what_earlier_events_leave_by_ntc() -> None:
    """Half of mu L of the bearing beside gamma_x times its displacement."""
    found = nominal(SYSTEM, En(8.0))["nominal"]
    check = next(c for c in found.checks if c.title == "capacity with accumulated displacement")
    left = 0.5 * BEARING.effective_friction * BEARING.effective_radius
    assert check.demand == pytest.approx(1.2 * max(found.displacements) + left, rel=1e-12)
    assert check.limit == pytest.approx(BEARING.capacity)
    assert check.clause == "NTC 2018 7.10.6.2.2"


@pytest.mark.parametrize(
    ("plateau", "factor"), [(0.30, (1.00, 0.35, 1.33)), (0.20, (0.90, 0.20, 1.00))]
)
def test_least_shear_of_nch433(plateau: float, factor: tuple[float, float, float]) -> None:
    """A_0 = 0.4 g in zone 3: 2.75 S A_0 / R (T' / T_D)^n, at least S A_0 / 6, of the floors."""
    heavy = replace(ABOVE, R=1.0)
    for above in (ABOVE, heavy):
        t = analysed(SYSTEM, NCh(plateau), bounds=None, superstructure=above)["nominal"].trace
        s, corner, n = factor
        falling = 2.75 * s * 0.4 / above.R * (corner / t.value("T_D")) ** n
        assert t.value("C_433") == pytest.approx(max(falling, s * 0.4 / 6.0), rel=1e-12)
        assert t.value("V_fixed") == pytest.approx(t.value("C_433") * 5.8e6, rel=1e-12)
        assert t.value("V_s") >= t.value("V_fixed")
    given = Spectrum.given([0.0, 1.0, 4.0], [4.0, 6.0, 1.5], code="NCh2745")
    scaled = Spectrum.nch2745("II", zone=1).scaled(4.0 / 3.0)  # Z of zone 2, of no zone
    for spectrum in (given, scaled):
        t = equivalent_linear(SYSTEM, spectrum, bounds=None, superstructure=ABOVE, code=NCh2745())
        assert t["nominal"].trace.value("V_fixed") == 0.0
        assert t["nominal"].trace["V_fixed"].note.startswith("unknown")


def test_forces_by_nch2745() -> None:
    found = analysed(SYSTEM, NCh(0.30), bounds=BOUNDS, superstructure=ABOVE)
    mu = BEARING.effective_friction
    lower = found["lower"]
    d = lower.trace.value("D_D")
    # Largest stiffness with the largest displacement.
    assert lower.base_shear == pytest.approx(9.0e6 * (d / 2.7 + 1.6 * mu))
    slides = max(1.6 * mu, 1.5 * mu) * 9.0e6
    assert lower.superstructure_shear == pytest.approx(max(0.5 * lower.base_shear, slides))
    moments = np.array([2.0 * 3.5, 2.0 * 6.5, 1.8 * 9.5])
    expected = lower.superstructure_shear * moments / moments.sum()
    np.testing.assert_allclose(lower.storey_forces[1:], expected, rtol=1e-12)
    drift = lower.checks.of("NCh2745 7.6")[0]
    assert drift.limit == pytest.approx(0.0025 * (3.5 if drift.subject == "storey 1" else 3.0))


def test_bearings_of_a_frame() -> None:
    frame = shear_building(BEARING, [2e5, 2e5], 4e8, base_mass=2e5, plan=((2, 1), (6.0, 5.0)))
    frame.add_load("base-0-0", (0.0, 0.0, -3e5, 0.0, 0.0, 0.0), case="L")
    plain = IsolationSystem.from_frame(frame)
    weight = 6e5 * 9.80665
    assert plain.seismic_weight == pytest.approx(weight + 0.5 * 3e5, rel=1e-6)
    assert plain.names == tuple(frame.bearings)
    assert plain.plan == (12.0, 5.0)
    assert not plain.combinations
    full = IsolationSystem.from_frame(frame, s_ms=1.5)
    assert full.loads == plain.loads
    assert sum(full.combinations["maximum"]) == pytest.approx(1.5 * weight + 3e5, rel=1e-6)
    assert sum(full.combinations["minimum"]) == pytest.approx(0.6 * weight, rel=1e-6)
    found = analysed(full, Asce(0.6), bounds=BOUNDS)
    assert found.displacement > 0.1
    with pytest.raises(CheckError, match="average"):
        IsolationSystem.from_frame(frame, combinations={"all": {"D": 1.0, "L": 1.0}})


def test_what_does_not_fit_is_refused() -> None:
    refused(CheckError, "cannot be used with EN 1998", nominal, SYSTEM, Asce(0.9), code=EN1998())
    heavy = replace(ABOVE, storey_weights=(4e6,) * 3)
    refused(CheckError, "storeys weigh", nominal, SYSTEM, Asce(0.9), superstructure=heavy)
    refused(CheckError, "5 loads for 6 bearings", replace, SYSTEM, loads=LOADS[:5])
    refused(CheckError, "load of bearing 2", replace, SYSTEM, loads=(1e6, -1e3, *LOADS[2:]))
    refused(CheckError, "storey_heights", replace, ABOVE, storey_heights=(3.0, 3.0))
    without = replace(SYSTEM, bearings=(FrictionPendulum((2.7,), (0.06,)),) * 6)
    more = {"superstructure": ABOVE, "code": ASCE7(pressure_limit=40e6)}
    refused(CheckError, "slider_radius", nominal, without, Asce(0.9), **more)
    for error, words, spectrum in (
        (CheckError, "no equivalent-linear analysis", Spectrum.nch433()),
        (CheckError, "no S_MS and S_M1", Spectrum.given([0.1, 3.0], [9.0, 2.0], code="ASCE 7")),
        (MotionError, "finite periods", Spectrum.given([0.1, 1.5], [9.0, 5.0], code="NCh2745")),
        (TypeError, "a Spectrum", 0.9),
    ):
        refused(error, words, equivalent_linear, SYSTEM, spectrum, bounds=None)
    refused(TypeError, "an IsolationSystem", nominal, BEARING, Asce(0.9))
    assert nominal(SYSTEM, NCh(0.30), code=NCh2745(maximum=1.0)).displacement > 0.0


def test_superstructure_of_a_frame() -> None:
    """Two storeys: m = 2e5 kg, k = 4e8 N/m each; omega^2 = k / m (3 - sqrt 5) / 2."""
    frame = shear_building(
        BEARING, [2e5, 2e5], 4e8, base_mass=3e5, storey_height=3.2, plan=((2, 1), (6.0, 5.0))
    )
    frame.add_node("foot", 20.0, 0.0, 0.0)
    frame.add_node("neighbour", 20.0, 0.0, frame.levels[1].z)
    frame.fix("foot", "all")
    frame.add_member("mast", "foot", "neighbour", Section.box(2.0, 2.0, 0.2))
    frame.add_mass("neighbour", 7e4)  # stands on the ground
    above = Superstructure.from_frame(frame, R=5.0, wind_shear=1e5)
    assert above.storey_weights == pytest.approx((2e5 * 9.80665,) * 2)
    assert above.storey_heights == pytest.approx((3.2, 3.2))
    omega = math.sqrt(4e8 / 2e5 * (3.0 - math.sqrt(5.0)) / 2.0)
    assert above.fixed_base_period == pytest.approx(2.0 * math.pi / omega, rel=1e-6)
    assert (above.R, above.wind_shear) == (5.0, 1e5)
    system = IsolationSystem.from_frame(frame)
    assert "6 bearings of effective radius 2.7 m under 6865 kN" in repr(system)
    found = analysed(system, Asce(0.6), bounds=BOUNDS, superstructure=above)
    assert len(found["upper"].storey_forces) == 3
    refused(CheckError, "1 levels", Superstructure.from_frame, _without_floors(frame), R=5.0)


def _without_floors(frame: Frame) -> Frame:
    found = frame.copy()
    for level in frame.levels[1:]:
        found.remove("level", level.name)
    return found


def test_axial_loads_of_nch2745_are_those_of_the_maximum_level() -> None:
    """W (D_M / L + mu) of the pendulum at D_M, over the centre of mass of forces by w h."""
    found = nominal(SYSTEM, NCh(0.30), code=NCh2745(pressure_limit=60e6), superstructure=ABOVE)
    result = found["nominal"]
    t, weight = result.trace, sum(LOADS)
    shear = weight * (t.value("D_M") / BEARING.effective_radius + BEARING.effective_friction)
    w, h = np.array(ABOVE.storey_weights), np.array([3.5, 6.5, 9.5])
    assert t.value("M_o") == pytest.approx(shear * (w * h**2).sum() / (w * h).sum())
    assert shear > 1.05 * t.value("V_b")
    levels = {c.title: c.level for c in result.checks}
    assert levels["pressure on the slider, maximum"] == levels["no uplift, minimum"] == "maximum"
    assert levels["no restrainer contact at the total displacement"] == "maximum"
    assert levels["storey drift"] == levels["restoring force"] == "design"


@pytest.mark.parametrize(
    ("spectrum", "level"), [(Asce(0.9), "MCE_R"), (En(8.0), "design"), (NCh(0.30), "maximum")]
)
def test_overturning_of_the_whole_structure(spectrum: object, level: str) -> None:
    """The weight of 9 MN about bearings 4 m off along y, the centre of mass by the loads."""
    found = analysed(SYSTEM, spectrum, bounds=BOUNDS, superstructure=ABOVE)
    for each in found.bounds.values():
        (check,) = (c for c in each.checks if c.title == "overturning of the whole structure")
        centre = 4.0 * (1.2e6 - 1.0e6 + 2.4e6 - 2.0e6 + 1.4e6 - 1.0e6) / 9.0e6
        assert check.limit == pytest.approx(9.0e6 * (4.0 - centre), rel=1e-12)
        assert check.demand == each.trace.value("M_o")
        assert (check.scope, check.level, check.passed) == ("any", level, True)


def test_a_slender_structure_overturns_and_a_row_is_not_judged() -> None:
    tall = replace(ABOVE, storey_heights=(60.0, 60.0, 60.0))
    found = nominal(SYSTEM, Asce(0.9), superstructure=tall)
    assert "overturning of the whole structure" in {c.title for c in found.checks.failed}
    row = replace(
        SYSTEM,
        bearings=(BEARING,) * 3,
        positions=((-6.0, 0.0), (0.0, 0.0), (6.0, 0.0)),
        loads=(3.0e6,) * 3,
        combinations={},
    )
    found = nominal(row, Asce(0.9), superstructure=ABOVE)
    assert not [c for c in found.checks if c.title.startswith("overturning")]


def test_wind_that_slides_and_service_that_meets_rims() -> None:
    """Friction of low speed, 0.02 on R = 1.5 m of L = 2.7 m, at 0.7 of it, under 9 MN."""
    slow = replace(BEARING, friction=VelocityFriction(0.06, 0.02, 50.0))
    system = replace(SYSTEM, bearings=(slow,) * 6)
    holds = 0.7 * 0.02 * 3.0 / 2.7 * 9.0e6
    for spectrum, clause in ((Asce(0.9), "ASCE 7-22 17.2.4.2"), (En(8.0), "no code")):
        for share, passed in ((0.99, True), (1.01, False)):
            above = replace(ABOVE, wind_shear=share * holds, service_displacement=0.46 * share)
            found = analysed(system, spectrum, bounds=BOUNDS, superstructure=above)
            by_title = {c.title: c for c in found.checks}
            wind = by_title["sliding under wind"]
            assert wind.limit == pytest.approx(holds, rel=1e-12)
            assert (wind.passed, wind.bound, wind.scope) == (passed, "lower", "any")
            assert wind.clause.startswith(clause)
            rims = by_title["no restrainer contact in service"]
            assert rims.demand == pytest.approx(0.46 * share)
            assert rims.limit == pytest.approx(0.45)
            assert not rims.passed
    calm = analysed(system, Asce(0.9), bounds=BOUNDS, superstructure=ABOVE)
    assert not [c for c in calm.checks if "wind" in c.title or "service" in c.title]


def test_drifts_that_ask_for_p_delta_say_so() -> None:
    """ASCE 7-22 17.6.4.4: from 0.010 / R_I on, R_I = 3/8 of 5 here."""
    known = analysed(SYSTEM, Asce(0.9), bounds=BOUNDS, superstructure=ABOVE)
    least = 0.010 / 1.875
    for drift, members, said in ((0.99, {}, ""), (1.01, {}, "springs do not"), (2, {1: 1}, "have")):
        case = Case(None, HISTORY_RULES["ASCE 7-22"], bound="lower")
        frame = SimpleNamespace(members=members)
        made = BoundChecks(case=case, frame=frame, limits=None, equivalent=known, level=None)
        check = Check(clause="ASCE 7-22 17.6.4.4", title="drift", demand=drift * least, limit=0.02)
        note = made._gravity(check)
        assert said in note
        assert bool(note) == bool(said)
        assert not note or note.startswith("above 0.533 % P-Delta must be in the analysis")
