"""Programmes of tests by hand, and measured loops judged against a design."""

import math
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
import pytest

from frames.design import (
    ASCE7,
    EN1998,
    AcceptanceLimits,
    CheckError,
    Checks,
    FrictionPendulum,
    IsolationSystem,
    NCh2745,
    ProgrammeDemands,
    PropertyBounds,
    PropertyModificationFactors,
    PrototypeTest,
    Spectrum,
    acceptance_checks,
    code_named,
    equivalent_linear,
    loop_properties,
    prototype_tests,
)
from frames.design.codes.prototype_programme import PlannedTest
from frames.design.testing.expected import expected_loop, factor_range, mean_friction
from frames.design.testing.programme import OWN_SPECIMENS
from lir_element import LIRBearing, PressureDependence, VelocityFriction, cyclic_test
from tests.refusals import refused
from tests.scenes import paper_bearing

BOUNDS = PropertyBounds(
    PropertyModificationFactors(0.8, 1.25), PropertyModificationFactors(0.9, 1.2)
)
L, MU, MU_H, U_CAP = 2.25, 0.06 * 2.37 / 2.25, 0.20, 0.25


bearing = partial(paper_bearing, capacity=U_CAP, friction=0.06, interface_friction=MU_H)


def system(*bearings: LIRBearing | FrictionPendulum) -> IsolationSystem:
    return IsolationSystem(
        bearings=bearings or (bearing(),) * 4,
        loads=(450e3, 500e3, 550e3, 600e3),
        positions=((-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)),
        plan=(12.0, 12.0),
        combinations={
            "maximum": (700e3, 750e3, 800e3, 880e3),
            "minimum": (320e3, 330e3, 340e3, 350e3),
        },
    )


def programme(code: Any, spectrum: Spectrum, **demands: Any) -> tuple[Any, pd.DataFrame]:
    own = system()
    found = equivalent_linear(own, spectrum, code=code, bounds=BOUNDS)
    return found, prototype_tests(found, own, ProgrammeDemands(**demands), bounds=BOUNDS)


def asce7(**demands: Any) -> tuple[Any, pd.DataFrame]:
    return programme(ASCE7(), Spectrum.asce7(s_ms=0.9, s_m1=0.6), **demands)


def test_few_cycles_are_ten() -> None:
    _, table = programme(ASCE7(), Spectrum.asce7(s_ms=1.5, s_m1=0.6))
    many = table[table["what"] == "many cycles, 0.75 D_M"].iloc[0]
    assert many["cycles"] == 10.0


def test_sliders_in_one_piece_have_no_interface_to_test() -> None:
    kinds = system(bearing().as_dcfp(), *(FrictionPendulum((L,), (0.06,)),) * 3)
    found = equivalent_linear(kinds, Spectrum.asce7(s_ms=0.9, s_m1=0.6), bounds=BOUNDS)
    table = prototype_tests(found, kinds)
    assert list(dict.fromkeys(table["bearings"])) == ["kind 1, 1 of 4", "kind 2, 3 of 4"]
    assert not table["clause"].str.contains("proposal").any()
    beyond = table[table["displacement [m]"] > U_CAP]
    stopped = beyond["bearings"] == "kind 1, 1 of 4"  # at its rims: no formula
    assert beyond["largest force [N]"][stopped].isna().all()
    assert stopped.any()
    assert beyond["largest force [N]"][~stopped].notna().all()


def test_of_alike_displacements_the_faster_tests_are_made() -> None:
    """Beyond T_D, eta at its least, both bounds ask for one displacement: not round-off decides."""
    own, bounds = system(), PropertyBounds(PropertyModificationFactors(1.0, 1.25))
    for more in np.linspace(1.0, 1.01, 5):
        spectrum = Spectrum.en1998(3.6 * more, "B")
        found = equivalent_linear(own, spectrum, code=EN1998(), bounds=bounds)
        low, high = found["lower"], found["upper"]
        assert high.displacement == pytest.approx(low.displacement, rel=1e-12)
        assert high.period < 0.95 * low.period
        tests = prototype_tests(found, own, bounds=bounds).set_index("what")
        assert tests["period [s]"]["D3, dynamic"] == pytest.approx(high.period, rel=1e-9)


def test_tests_of_nch2745_by_hand() -> None:
    found, table = programme(NCh2745(), Spectrum.nch2745("III", 3))
    t = max(found.bounds.values(), key=lambda each: each.total_displacement).trace
    own = table[table["clause"] == "NCh2745 14"]
    at = own.set_index("what")["displacement [m]"]
    assert at["increments, average load, 0.25 D_D"] == pytest.approx(0.25 * t.value("D_D"))
    cycles = own.set_index("what")["cycles"]  # C_VD of 1 s, C_AD of the plateau over 2.5
    ratio = 2.0 * math.pi * 1.31 / (12.12 / 2.5)
    assert cycles["many cycles, D_TD"] == max(10, math.ceil(15.0 * ratio / t.value("B_D")))
    assert cycles["many cycles, D_TD"] > 10
    assert at["increments, least load, D_M"] == pytest.approx(t.value("D_M"))
    assert at["many cycles, D_TD"] == pytest.approx(t.value("D_TD"))
    assert at["static, least load, D_TM"] == pytest.approx(t.value("D_TM"))
    periods = own.set_index("what")["period [s]"]
    assert t.value("T_M") > 1.02 * t.value("T_D")
    for what, period in (
        ("increments, average load, 0.5 D_D", "T_D"),
        ("increments, largest load, D_D", "T_D"),
        ("many cycles, D_TD", "T_D"),
        ("increments, least load, D_M", "T_M"),
        ("maximum displacement, D_TM", "T_M"),
    ):
        assert periods[what] == pytest.approx(t.value(period)), what


@pytest.mark.parametrize(
    ("spectrum", "code", "accepted"),
    [
        (
            Spectrum.asce7(s_ms=0.9, s_m1=0.6),
            "ASCE 7-22",
            {
                "wind": "",
                "increments, least load, 0.5 D_M": "the force rises with the displacement (ASCE "
                "7-22 17.8.4 *); post-elastic stiffness and EDC of each cycle within lambda_test "
                "of the nominal ones (ASCE 7-22 17.8.4 *); post-elastic stiffness of two specimens "
                "within 15 % of their mean, cycle by cycle (ASCE 7-22 17.8.4 *)",
                "static, least load, D_TM": "the bearing stays stable (ASCE 7-22 17.8.4 *)",
                "after the impacts": "the interface does not slip; EDC as before the impacts (no "
                "code: a proposal)",
            },
        ),
        (
            Spectrum.en1998(2.4, "C"),
            "EN 1998",
            {
                "P1, benchmark": "post-elastic stiffness within 15 % of that of the design (EN "
                "15129 8.3.4 *)",
                "B, both directions": "friction within the bounds that the design counts on (EN "
                "15129 8.3.4 *); friction of each cycle within 25 % of that of the third (NTC 2018 "
                "11.9.8)",
            },
        ),
        (
            Spectrum.nch2745(soil="II", zone=3),
            "NCh2745",
            {
                "many cycles, D_TD": "the force rises with the displacement (NCh2745 14.4 *); "
                "effective stiffness changes by 20 % at most over the cycles (NCh2745 14.4 *); "
                "effective damping falls by 20 % at most over the cycles (NCh2745 14.4 *)"
            },
        ),
    ],
)
def test_each_test_says_what_is_accepted_of_it(spectrum, code, accepted):
    """20 % is of the test of many cycles alone; no rule is without a test that it is of."""
    own = system()
    found = equivalent_linear(own, spectrum, bounds=BOUNDS)
    table = prototype_tests(found, own, bounds=BOUNDS).set_index("what")["accepted if"]
    assert {name: table[name] for name in accepted} == accepted
    assert {name for name in table.index if "20 %" in table[name]} == {
        name for name in table.index if name.startswith("many cycles")
    }
    for rule in code_named(code).accepted:
        assert any(rule.holds_for(name) for name in table.index), rule
        assert rule.value in code_named(code).values.values()


def test_programmes_that_cannot_be_are_refused() -> None:
    own = system()
    found = equivalent_linear(own, Spectrum.asce7(s_ms=0.9, s_m1=0.6), bounds=BOUNDS)
    lifted = replace(own, combinations={"minimum": (-5e3, 1e5, 1e5, 1e5)})
    with pytest.raises(CheckError, match=r"least axial load.*loads=\(least, largest\)"):
        prototype_tests(found, lifted)
    refused(CheckError, "least first", ProgrammeDemands, loads=(2e5, 1e5))
    refused(CheckError, "impact_speed", ProgrammeDemands, impact_speed=-1.0)


# Measured loops ---------------------------------------------------------------------------------


def loop(
    amplitude: float = 0.2,
    cycles: int = 3,
    *,
    friction: float = MU,
    radius: float = L,
    load: float = 500e3,
    fade: float = 0.0,
    noise: float = 0.0,
    start: float = 1.0,
) -> PrototypeTest:
    """Return N d / L + mu N sign(v), the friction falling by `fade` each cycle."""
    phase = 2.0 * math.pi * np.linspace(0.0, cycles, 800 * cycles + 1)
    moved = start * amplitude * np.sin(phase)
    now = friction * (1.0 - fade) ** np.floor(phase / (2.0 * math.pi))
    force = load * (moved / radius + now * np.sign(start * np.cos(phase)))
    random = np.random.default_rng(5)
    return PrototypeTest(
        name=f"{1e3 * amplitude:g} mm",
        displacement=moved,
        force=force + noise * random.normal(size=len(force)),
        load=load,
    )


@pytest.mark.parametrize("start", [1.0, -1.0])
def test_a_bilinear_loop_by_hand(start: float) -> None:
    table = loop_properties(loop(start=start))
    n, d = 500e3, 0.2
    force = n * (d / L + MU)
    assert len(table) == 3
    assert table["force + [N]"].to_numpy() == pytest.approx(force, rel=1e-9)
    assert table["force - [N]"].to_numpy() == pytest.approx(-force, rel=1e-9)
    assert table["k_eff [N/m]"].to_numpy() == pytest.approx(force / d, rel=1e-9)
    assert table["k_d [N/m]"].to_numpy() == pytest.approx(n / L, rel=1e-9)
    assert table["E_loop [J]"].to_numpy() == pytest.approx(4.0 * MU * n * d, rel=1e-4)
    assert table["friction [-]"].to_numpy() == pytest.approx(MU, rel=1e-4)
    damping = 2.0 / math.pi * MU / (d / L + MU)
    assert table["beta_eff [-]"].to_numpy() == pytest.approx(damping, rel=1e-4)


def test_noise_does_not_decide() -> None:
    """Two per cent of the force: sample by sample it has slopes of any sign."""
    quiet, noisy = loop_properties(loop()), loop_properties(loop(noise=1500.0))
    for column in ("k_d [N/m]", "E_loop [J]", "k_eff [N/m]"):
        assert noisy[column].to_numpy() == pytest.approx(quiet[column].to_numpy(), rel=0.03)
    assert judged(loop(noise=1500.0)).passed


def test_a_cycle_that_does_not_come_back_is_none() -> None:
    full = loop()
    cut = slice(0, 1700)  # two cycles and an eighth
    part = PrototypeTest(
        name="cut", displacement=full.displacement[cut], force=full.force[cut], load=500e3
    )
    assert len(part.cycles) == 2


def judged(*tests: PrototypeTest, of: LIRBearing | None = None, **options: Any) -> Checks:
    return acceptance_checks(tests, of or bearing(), "ASCE 7-22", bounds=BOUNDS, **options)


def failing(checks: Checks) -> set[str]:
    return {check.title for check in checks.failed}


def test_the_loops_of_the_design_itself_pass() -> None:
    phase = 2.0 * math.pi * np.linspace(0.0, 3.0, 1501)
    tests = []
    for amplitude in (0.1, 0.2, 0.28):  # the last meets the rims
        path = amplitude * np.sin(phase)
        data = cyclic_test(bearing(), path, axial_load=500e3, velocity=0.3)
        force = data["bearing_force"].sel(axis="x").isel(bearing=0)
        tests.append(PrototypeTest(name=f"{amplitude}", displacement=path, force=force, load=500e3))
    found = judged(*tests)
    assert found.passed
    within = [check for check in found if check.title == "friction by the energy"]
    assert {check.subject for check in within} == {"0.1", "0.2"}
    assert within[0].demand == pytest.approx(MU, rel=0.01)


@pytest.mark.parametrize(
    ("changed", "title"),
    [
        ({"friction": 0.75 * MU}, "friction by the energy"),
        ({"friction": 1.3 * MU}, "friction by the energy"),
        ({"radius": 0.8 * L}, "post-elastic stiffness over N / L"),
        ({"radius": 1.2 * L}, "post-elastic stiffness over N / L"),
        ({"radius": -20.0 * L}, "slope of loading"),
        ({"fade": 0.15}, "energy dissipated per cycle (EDC), off the set's mean"),
        ({"fade": 0.05, "cycles": 10}, "effective damping: drop over the cycles"),
    ],
)
def test_each_check_fails_by_what_it_is_for(changed: dict[str, Any], title: str) -> None:
    assert title not in failing(judged(loop()))
    assert title in failing(judged(loop(**changed)))


def test_nominal_friction_goes_by_pressure_and_corners() -> None:
    law = PressureDependence(rate=1e-8, reference_pressure=20e6)
    own = bearing(pressure_dependence=law)
    factor = math.exp(-1e-8 * (500e3 / (math.pi * 0.15**2) - 20e6))
    of_energy = [c for c in judged(loop(), of=own) if c.title == "friction by the energy"]
    assert of_energy[0].limit == pytest.approx(0.8 * factor * MU)
    system_of_one = IsolationSystem(
        bearings=(own,), loads=(500e3,), positions=((0.0, 0.0),), plan=(5.0, 5.0)
    )
    found = equivalent_linear(system_of_one, Spectrum.asce7(s_ms=0.9, s_m1=0.4), bounds=BOUNDS)
    table = prototype_tests(found, system_of_one, bounds=BOUNDS).set_index("what")
    row = table.loc["increments, average load, 0.25 D_M"]
    force = 500e3 * (row["displacement [m]"] / L + 1.25 * factor * MU)
    assert row["largest force [N]"] == pytest.approx(force)
    two = FrictionPendulum((1.0, 1.25), (0.04, 0.08))
    corner = 4.0 * 1.0 * 1.25 * 0.04**2 / L
    checks = acceptance_checks([loop()], two, "EN 1998", bounds=BOUNDS)
    low = next(c for c in checks if c.title == "friction by the energy")
    whole = (0.04 * 1.0 + 0.08 * 1.25) / L
    assert low.limit == pytest.approx(0.8 * (whole - corner / (4.0 * 0.2)), rel=1e-9)


def of_specimen(specimen: str, **changed: float) -> PrototypeTest:
    return replace(loop(**changed), specimen=specimen)


@pytest.mark.parametrize(
    ("code", "title", "limit"),
    [
        ("ASCE 7-22", "post-elastic stiffness of specimens, off their mean", 0.15),
        ("NCh2745", "effective stiffness of specimens, off the least of them", 0.10),
    ],
)
def test_specimens_are_held_against_one_another(code: str, title: str, limit: float) -> None:
    """N / L and N / (c L): off their mean by (1 - 1/c) / (1 + 1/c); of k_eff by its formula."""
    for c in (1.05, 1.6):
        pair = of_specimen("A"), of_specimen("B", radius=c * L)
        checks = {k.title: k for k in acceptance_checks(pair, bearing(), code, bounds=BOUNDS)}
        by_mean = (1.0 - 1.0 / c) / (1.0 + 1.0 / c)
        by_least = (0.2 / L + MU) / (0.2 / (c * L) + MU) - 1.0
        expected = by_mean if code == "ASCE 7-22" else by_least
        check = checks[title]
        assert check.demand == pytest.approx(expected, rel=1e-3)
        assert (check.limit, check.passed) == (limit, expected <= limit)
        assert check.subject.startswith("200 mm, ")
        assert check.clause.startswith(code)
    faded = of_specimen("A", fade=0.2)
    longer = of_specimen("B", fade=0.2, cycles=5)
    uneven = acceptance_checks((faded, longer), bearing(), code, bounds=BOUNDS)
    assert (
        next(k for k in uneven if k.title == title).demand < 1e-3
    )  # of as many cycles as both have
    alone = acceptance_checks([of_specimen("A")], bearing(), code, bounds=BOUNDS)
    assert title not in {check.title for check in alone}
    europe = acceptance_checks(pair, bearing(), "EN 1998", bounds=BOUNDS)
    assert title not in {check.title for check in europe}


@pytest.mark.parametrize("fade", [0.1, 0.15])
def test_cycles_are_held_against_the_third(fade: float) -> None:
    """The first cycle's friction over the third's is 1 / (1 - fade)^2."""
    title = "friction of each cycle, off that of the third"
    checks = acceptance_checks([loop(fade=fade)], bearing(), "EN 1998", bounds=BOUNDS)
    check = next(k for k in checks if k.title == title)
    expected = (1.0 - fade) ** -2 - 1.0
    assert check.demand == pytest.approx(expected, rel=1e-2)
    assert (check.limit, check.passed) == (0.25, expected <= 0.25)
    assert check.subject == "200 mm, cycle 1"
    two = acceptance_checks([loop(cycles=2)], bearing(), "EN 1998", bounds=BOUNDS)
    assert title not in {k.title for k in two}
    assert title not in {k.title for k in judged(loop(fade=fade))}


def test_drop_and_spread_by_hand() -> None:
    three = AcceptanceLimits(many_cycles=3)
    found = {check.title: check for check in judged(loop(fade=0.1), limits=three)}
    energy = 0.9 ** np.arange(3)
    spread = abs(energy / energy.mean() - 1.0).max()
    assert found["energy dissipated per cycle (EDC), off the set's mean"].demand == pytest.approx(
        spread, rel=1e-2
    )
    force = 0.2 / L + MU * energy
    stiffness = found["effective stiffness: drop over the cycles"].demand
    assert stiffness == pytest.approx(1.0 - force[-1] / force[0], rel=1e-3)


def test_a_drop_is_of_the_test_of_many_cycles_alone() -> None:
    """Three cycles that fall by 40 % have no check of it; the interface alone has."""
    assert not [check for check in judged(loop(fade=0.3)) if "drop" in check.title]
    many = [check for check in judged(loop(cycles=10)) if "drop" in check.title]
    assert [check.passed for check in many] == [True, True]
    assert [check for check in judged(interface(MU_H)) if "drop" in check.title]
    refused(CheckError, "many_cycles = 1", AcceptanceLimits, many_cycles=1)


def test_specimens_of_one_set_are_judged_together() -> None:
    """Two bearings 20 % apart: each is steady, the set is not."""
    one, two = loop(friction=0.85 * MU), loop(friction=1.25 * MU)
    assert judged(one).passed
    both = judged(one, two)
    assert failing(both) == {"energy dissipated per cycle (EDC), off the set's mean"}


def test_cycles_of_unlike_displacement_are_refused() -> None:
    one, two = loop(0.1), loop(0.2)
    both = PrototypeTest(
        name="steps",
        displacement=np.append(one.displacement, two.displacement),
        force=np.append(one.force, two.force),
        load=500e3,
    )
    assert len(both.cycles) == 6
    refused(CheckError, r"cycles from 100 to 200 mm", judged, both)


def interface(friction: float) -> PrototypeTest:
    phase = 2.0 * math.pi * np.linspace(0.0, 3.0, 2401)
    return PrototypeTest(
        name="alone",
        displacement=0.05 * np.sin(phase),
        load=300e3,
        kind="interface",
        force=300e3 * friction * np.sign(np.cos(phase)),
    )


def test_the_interface_alone_goes_by_its_own_bounds() -> None:
    assert judged(interface(1.15 * MU_H)).passed
    assert failing(judged(interface(1.25 * MU_H))) == {"friction of the interface"}
    assert failing(judged(interface(0.85 * MU_H))) == {"friction of the interface"}
    assert all(check.clause == "no code: a proposal" for check in judged(interface(MU_H)))
    refused(CheckError, "has none", judged, interface(MU_H), of=bearing().as_dcfp())


def test_limits_are_the_engineers() -> None:
    tight = judged(loop(fade=0.03), limits=AcceptanceLimits(spread=0.02, drop=0.01))
    assert {"energy dissipated per cycle (EDC), off the set's mean"} <= failing(tight)
    assert judged(loop(fade=0.03)).passed
    refused(CheckError, "around 1", AcceptanceLimits, stiffness=(1.1, 1.2))


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"force": np.zeros(3)}, r"displacement \(5,\) and force \(3,\)"),
        ({"force": [0.0, 1.0, math.nan, 0.0, 0.0]}, "force is nan at sample 2"),
        ({"load": -5e3}, "compression as positive"),
        ({"load": np.ones(4)}, r"load \(4,\)"),
        ({}, "samples in a part of a half cycle"),
        ({"displacement": [0.0, 1.0, 2.0, 1.0, 0.5]}, "no full cycle about zero"),
        ({"kind": "slider"}, "kind = 'slider'"),
    ],
)
def test_loops_that_cannot_be_judged_are_refused(changed: dict[str, Any], message: str) -> None:
    given: dict[str, Any] = {
        "name": "short",
        "displacement": [0.0, 1.0, 0.0, -1.0, 0.0],
        "force": np.ones(5),
        "load": 1e5,
    }
    refused(CheckError, message, PrototypeTest, **given | changed)


UNLIKE = LIRBearing(
    radius=(2.5, 2.0),
    slider_height=0.3,
    slider_radius=0.2,
    rims=(0.2, 0.2),
    friction=(0.05, 0.08),
    interface_friction=0.15,
)


@pytest.mark.parametrize(("own", "d"), [(bearing(), 0.2), (bearing(), 0.3), (UNLIKE, 0.2)])
def test_loops_expected_are_those_of_the_rig(own, d):
    """Below the rims, beyond them, and of unlike surfaces: by the element on the rig."""
    load = 1e6
    path = np.concatenate([np.linspace(0.0, d, 200), np.linspace(d, -d, 400)[1:]])
    path = np.concatenate([path, np.linspace(-d, d, 400)[1:]])
    force = cyclic_test(own, path, axial_load=load)["bearing_force"].sel(axis="x").to_numpy()[:, 0]
    energy = np.trapezoid(force[199:], path[199:])
    found = expected_loop(PlannedTest("", d, load, 3.0, 0.02, "", ""), own)
    assert found.energy == pytest.approx(energy, rel=4e-3)  # small angles
    assert found.stiffness == pytest.approx(force[199] / d, rel=8e-3)
    assert found.friction == pytest.approx(energy / (4.0 * load * d), rel=4e-3)


def test_friction_of_a_loop_is_the_mean_of_its_path():
    law = VelocityFriction(f_max=0.08, f_min=0.03, rate=20.0)
    x = np.sin(np.linspace(0.0, 0.5 * np.pi, 20001))
    at = [law.at_speed(0.1 * math.sqrt(1.0 - one**2)) for one in 0.5 * (x[1:] + x[:-1])]
    assert mean_friction(law, 0.1) == pytest.approx(np.sum(at * np.diff(x)), rel=1e-6)


def test_factors_of_tests_and_of_the_production():
    factors = PropertyModificationFactors.asce7(
        test=(0.9, 1.2), spec=(0.95, 1.05), full_scale_tests=True
    )
    assert factor_range(factors, "test") == (0.9, 1.2)
    assert factor_range(factors, "spec") == (0.95, 1.05)
    assert factor_range(PropertyModificationFactors(0.8, 1.3), "test") == (0.8, 1.3)
    each = code_named("EN 1998").factors(specification=(0.9, 1.1), ageing=(1.0, 1.2))
    assert factor_range(each, "test") == (each.lower, each.upper)


def test_no_clause_of_en_15129_has_a_number_of_specimens():
    known = {name: code_named(name).values for name in ("ASCE 7-22", "NCh2745", "EN 1998")}
    assert [name for name in known if "number of specimens" in known[name]] == [
        "ASCE 7-22",
        "NCh2745",
    ]
    assert OWN_SPECIMENS.clause.startswith("no code")
