"""Bearings proposed for a structure: one candidate by hand, groups of sizes, what is refused."""

import itertools
import math
import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.signal import lfilter

from frames import GroundMotion, gravity, shear_building
from frames.design import (
    ASCE7,
    EN1998,
    CheckError,
    Design,
    DesignLimits,
    DesignTarget,
    IsolationSystem,
    MotionSet,
    NCh2745,
    NoCandidateError,
    Prices,
    PropertyBounds,
    PropertyModificationFactors,
    Spectrum,
    code_named,
    design,
    device_checks,
    equivalent_linear,
    pair_spectrum,
    period_range,
)
from frames.design.codes.outcome import EquivalentLinear
from frames.design.devices.capacity import engagement_checks
from frames.design.plots import design_candidates
from frames.design.sizing.candidate import grouped
from frames.design.sizing.fitting import rounded_up
from frames.design.sizing.proposal import Device
from frames.design.sizing.trial import MARGIN, OneMass, Place, tried_on_one_mass
from lir_element import DesignWarning
from tests.refusals import refused
from tests.scenes import tall_bearing

G = 9.80665
S_M1 = 0.8
BOUNDS = PropertyBounds(
    PropertyModificationFactors(0.8, 1.4), PropertyModificationFactors(0.9, 1.1)
)
PLACES = tuple((x, y) for x in (-6.0, 0.0, 6.0) for y in (-4.0, 4.0))
LOADS = (1.0e6, 1.2e6, 2.0e6, 2.4e6, 1.0e6, 1.4e6)
ANY = tall_bearing()
SYSTEM = IsolationSystem(
    bearings=(ANY,) * 6,
    positions=PLACES,
    loads=LOADS,
    plan=(14.0, 10.0),
    combinations={"maximum": tuple(1.3 * load for load in LOADS), "minimum": (0.5e6,) * 6},
)
ONE = DesignTarget(radii=(2.0,), frictions=(0.05,), least_pressure=5e6)


SPECTRUM = Spectrum.asce7(1.2, S_M1)


def displacement(length: float, mu: float) -> float:
    """D_M of a friction pendulum, by a solver of equations."""

    def gap(d: float) -> float:
        stiffness = 1.0 / length + mu / d  # over the weight
        beta = 2.0 / math.pi * mu / (d * stiffness)
        period = 2.0 * math.pi / math.sqrt(stiffness * G)
        return d - G * S_M1 * period / (4.0 * math.pi**2 * SPECTRUM.damping_factor(beta))

    return brentq(gap, 1e-3, 2.0, xtol=1e-14)


def test_a_candidate_is_what_a_calculation_by_hand_gives() -> None:
    found = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=ONE)
    bearing = found.bearings()[0]
    a, h = bearing.slider_radius, bearing.slider_height
    length = 4.0 - h
    centre = displacement(length, 0.8 * 0.05 * 4.0 / length)
    whole = found.chosen.analysis["lower"]
    assert whole.displacement == pytest.approx(centre, rel=1e-9)
    free = whole.total_displacement
    assert bearing.lateral_capacity == pytest.approx(0.75 * free)
    slip, friction = 0.25 * free, 1.4 * 0.05 * 4.0 / length
    needed = max(1.2 * friction, friction + slip / length) / 0.9
    assert 0.0 <= bearing.interface_friction - needed < 0.005
    assert math.isclose(
        bearing.interface_friction / 0.005, round(bearing.interface_friction / 0.005)
    )
    assert math.pi * a * a >= max(2.4e6 / 30e6, 1.3 * 2.4e6 / 60e6)
    assert a >= slip
    edge = 0.75 * free * 2.0 / length + a
    assert h >= 2.0 * (2.0 - math.sqrt(4.0 - edge**2)) + 0.010
    assert found.chosen.plan_diameter == pytest.approx(2.0 * (edge + 0.025))


@pytest.mark.parametrize(
    ("code", "spectrum", "words"),
    [
        (EN1998(), Spectrum.en1998(3.4, "B"), "beyond gamma_x d_bd"),
        (NCh2745(), Spectrum.nch2745(soil="III", zone=3), "beyond D_TM"),
    ],
)
def test_codes_without_a_rule_for_rims_get_rims_that_are_not_met(code, spectrum, words):
    """The proposed bearing keeps all that its code holds against rims, of whichever bound."""
    target = replace(ONE, radii=(1.5,), frictions=(0.04,))
    found = design(SYSTEM, spectrum, code=code, bounds=BOUNDS, target=target)
    bearing, t = found.bearings()[0], found.chosen.trace
    on = replace(SYSTEM, bearings=found.bearings())
    linear = equivalent_linear(on, spectrum, code=code, bounds=BOUNDS)
    allowed = {each.bound: each.allowed_displacement for each in linear.bounds.values()}
    assert {one.verdict for one in engagement_checks(bearing, allowed, code=code.name)} == {"ok"}
    of_rims = [c for c in linear.checks if c.limit == pytest.approx(bearing.lateral_capacity)]
    assert len(of_rims) >= 2
    assert max(c.ratio for c in of_rims) == pytest.approx(1.0 / 1.05, rel=1e-6)
    assert not [c for c in linear.checks.failed if c.unit == "m"]
    assert t.value("s") == pytest.approx(0.1 * max(allowed.values()), rel=1e-6)
    assert found.to_dataframe()["rims"].tolist() == [words]
    assert bearing.slip_stability > t.value("s")
    free = found.bearings("DCFP without rim contact")[0]
    assert free.lateral_capacity == pytest.approx(bearing.lateral_capacity)
    told = design(SYSTEM, spectrum, code=code, bounds=BOUNDS, target=replace(target, rim_share=0.8))
    assert told.bearings()[0].lateral_capacity == pytest.approx(0.8 * told.chosen.displacement)
    assert told.to_dataframe()["rims"].iloc[0].endswith("needs agreement")


def test_rims_that_asce_allows_to_be_met_say_so() -> None:
    found = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=ONE)
    assert found.chosen.rims == "met, ASCE 7-22 17.2.4.5 allows it from 0.6 D_TM"
    assert found.chosen.trace.value("r") == 0.75


def test_the_slider_is_the_least_that_keeps_the_checks() -> None:
    found = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=ONE)
    bearing, t = found.bearings()[0], found.chosen.trace
    limits, slip = ONE.limits, t.value("s")
    ours = device_checks(bearing, (0.5e6, 3.12e6), slip=slip, bounds=BOUNDS, limits=limits)
    assert ours.passed
    assert found.chosen.checks.passed
    height, radius = bearing.slider_height - 0.015, bearing.slider_radius - 0.015
    smaller = replace(bearing, slider_height=height, slider_radius=radius)
    theirs = device_checks(smaller, (0.5e6, 3.12e6), slip=slip, bounds=BOUNDS, limits=limits)
    assert not theirs.passed


def test_a_margin_of_the_slip_makes_sliders_and_interface_larger() -> None:
    """By hand: the slip times the margin, mu_h of it; the rims stay where they are."""
    target = replace(ONE, rim_share=0.75, least_pressure=3e6)
    plain = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=target).chosen
    wide = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=replace(target, slip_margin=2.0)).chosen
    t = wide.trace
    assert t.value("s") == pytest.approx(2.0 * 0.25 * t.value("D"), rel=1e-12)
    length = 4.0 - wide.bearings[0].slider_height
    surfaces = BOUNDS.friction.upper * 0.05 * 4.0 / length
    holds = (surfaces + t.value("s") / length) / BOUNDS.interface_factors.lower
    needed = max(holds, ONE.limits.margin * surfaces / BOUNDS.interface_factors.lower)
    friction = wide.bearings[0].interface_friction
    assert needed <= friction < needed + ONE.friction_step
    assert friction > plain.bearings[0].interface_friction
    assert wide.bearings[0].slider_radius > plain.bearings[0].slider_radius
    assert wide.bearings[0].slider_radius >= t.value("s")
    refused(CheckError, "slip_margin", replace, ONE, slip_margin=0.5)


def test_the_three_devices_share_radius_friction_and_slider() -> None:
    found = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=ONE)
    lir, plain, free = (
        found.bearings(device)[0] for device in ("LIR-DCFP", "DCFP", "DCFP without rim contact")
    )
    assert plain == lir.as_dcfp()
    assert free.is_dcfp
    assert free.lateral_capacity == pytest.approx(found.chosen.trace.value("D"))
    assert free.radius == plain.radius
    table = found.table()
    wide = table.loc["DCFP without rim contact", "plan diameter [m]"]
    way = free.rim_displacement[0] - plain.rim_displacement[0]
    assert wide - table.loc["DCFP", "plan diameter [m]"] == pytest.approx(2.0 * way)
    refused(CheckError, "device", found.bearings, "LRB")
    own = replace(SYSTEM, bearings=found.bearings("DCFP without rim contact"))
    again = equivalent_linear(own, SPECTRUM, bounds=BOUNDS)
    rims = [check for check in again.checks if check.title.startswith("no restrainer contact")]
    assert rims
    assert all(check.passed for check in rims)


def test_sizes_part_the_loads_with_the_least_area() -> None:
    largest = [1.3 * load for load in LOADS]
    for sizes in (1, 2, 3, 4):
        places, loads = grouped(SYSTEM, sizes)
        area = sum(loads[place].largest for place in places)
        ways = itertools.product(range(sizes), repeat=6)
        best = min(
            sum(
                max(n for n, other in zip(largest, way, strict=True) if other == one) for one in way
            )
            for way in ways
        )
        assert area == pytest.approx(best, rel=1e-2)
    assert len(grouped(SYSTEM, 9)[1]) == 5  # unlike loads
    assert grouped(SYSTEM, 1)[1][0][:3] == (0.5e6, 2.4e6, pytest.approx(3.12e6))
    refused(CheckError, "sizes = 0", grouped, SYSTEM, 0)


def test_sliders_of_two_sizes_have_one_height_and_interface() -> None:
    found = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=ONE, sizes=2)
    assert len(found.chosen.bearings) == 2
    for name in ("slider_height", "interface_friction", "capacity", "friction"):
        one, other = (getattr(each, name) for each in found.chosen.bearings)
        assert one == other


def test_what_is_made_least_is_least_among_those_that_keep_what_is_asked() -> None:
    target = DesignTarget(
        radii=(1.5, 2.0, 2.5), frictions=(0.04, 0.06), max_displacement=0.60, least_pressure=1e6
    )
    frames = {
        name: design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=target, least=name)
        for name in ("base shear", "displacement", "plan diameter")
    }
    symbols = {"base shear": "V_b", "displacement": "D", "plan diameter": "d_plan"}
    for name, found in frames.items():
        good = [one.trace.value(symbols[name]) for one in found.candidates if not one.lacks]
        assert 1 <= len(good) < 6
        assert found.chosen.trace.value(symbols[name]) == min(good)
        assert found.chosen.trace.value("D") <= 0.60
    assert len(frames["displacement"].to_dataframe()) == 6


@pytest.fixture(scope="module")
def twenty() -> Design:
    """Every pair of radius and friction that is tried if none is given."""
    target = DesignTarget(max_displacement=0.60, least_pressure=1e5)
    return design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=target)


def test_the_pareto_set_is_what_none_beats(twenty: Design) -> None:
    found = twenty
    table = found.to_dataframe()
    numbers = ["displacement [m]", "base shear / weight [-]", "plan diameter [m]"]
    good = table[table["lacks"] == ""]
    for place, row in table.iterrows():
        others = good.drop(index=place, errors="ignore")[numbers]
        beaten = ((others <= row[numbers]).all(axis=1) & (others < row[numbers]).any(axis=1)).any()
        assert row["Pareto-optimal"] == (row["lacks"] == "" and not beaten)
    assert 2 <= len(found.pareto) < len(good) < len(table) == 20
    assert list(table.loc[table["outcome"] == "proposed", "base shear / weight [-]"]) == [
        good["base shear / weight [-]"].min()
    ]
    assert found.ranked[0] is found.chosen
    assert (table["largest ratio [-]"] > 1.0).equals(table["lacks"] != "")
    fallen = table[table["lacks"] != ""]
    assert all(row["limited by"] in row["lacks"] for _, row in fallen.iterrows())


def test_the_volume_of_bearings_is_that_of_plates_and_sliders() -> None:
    chosen = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=ONE, sizes=2).chosen
    t, found = chosen.trace, 0.0
    for bearing, number in zip(chosen.bearings, (4, 2), strict=True):
        way = t.value("U_cap") * 2.0 / (4.0 - bearing.slider_height)
        diameter = 2.0 * (way + bearing.slider_radius + 0.025)
        found += number * math.pi / 4.0 * diameter**2 * bearing.slider_height
    assert chosen.bearing_volume == pytest.approx(found)


def test_the_cost_is_that_of_the_prices(twenty: Design) -> None:
    """Each price by itself against what it is of, and the least of all candidates by them."""
    one, two = twenty.chosen.bearings[0], twenty.chosen
    of = {
        "bearing": 6.0,
        "volume": two.bearing_volume,
        "liner": 6.0 * 3.0 * math.pi * one.slider_radius**2,
        "gap": two.displacement,
    }
    for name, amount in of.items():
        priced = replace(two, prices=Prices(**{name: 700.0}))
        assert priced.cost == pytest.approx(700.0 * amount, rel=1e-12)
        assert priced.row()["cost"] == priced.cost
    assert math.isnan(two.cost)
    assert "cost" not in two.row()
    choice = replace(ONE, radii=(1.5, 2.0), frictions=(0.05, 0.06), prices=Prices(volume=1.0))
    found = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=choice, least="cost")
    good = [one for one in found.candidates if not one.lacks]
    assert found.chosen.bearing_volume == min(one.bearing_volume for one in good)
    refused(CheckError, "without prices", design, SYSTEM, SPECTRUM, bounds=None, least="cost")


def test_sliders_under_low_pressure_are_told_and_not_preferred() -> None:
    low = DesignTarget(radii=(2.0,), frictions=(0.05,), least_pressure=14e6)
    with pytest.warns(DesignWarning, match=r"have 10.6 MPa .* below least_pressure = 14 MPa"):
        chosen = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=low).chosen
    area = math.pi * chosen.bearings[0].slider_radius ** 2
    typical = sum(load**2 for load in LOADS) / sum(LOADS) / area
    assert chosen.pressures[0] == pytest.approx((1.0e6 / area, typical, 2.4e6 / area))
    assert typical < 14e6
    both = DesignTarget(radii=(1.5, 2.5), frictions=(0.04, 0.06), least_pressure=1e5)
    free = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=both)
    pressed = [one.pressures[0][1] for one in free.candidates if not one.lacks]
    assert free.chosen.pressures[0][1] < max(pressed)
    between = replace(both, least_pressure=0.999 * max(pressed))
    asked = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=between)
    assert asked.chosen.pressures[0][1] == max(pressed)
    assert asked.chosen.base_shear > free.chosen.base_shear
    assert not asked.chosen.warnings


def test_candidates_are_drawn_by_what_limits_them(twenty: Design) -> None:
    found = twenty
    figure = design_candidates(found, target=DesignTarget(max_displacement=0.5))
    left, right = figure.axes
    points = [tuple(mark.get_offsets()[0]) for mark in left.collections]
    for one in found.candidates:
        assert (100.0 * one.base_shear, 1e3 * one.displacement) in points
    named = [text.get_text() for text in left.texts]
    assert named == [f"R {one.radius:g} m, μ {one.friction.f_max:g}" for one in found.pareto]
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "limited by: restoring force" in words
    assert left.lines[0].get_ydata()[0] == right.lines[0].get_ydata()[0] == 500.0
    refused(CheckError, "candidates is empty", design_candidates, ())


def test_trials_do_not_warn_of_what_the_checks_hold() -> None:
    target = DesignTarget(radii=(1.0,), frictions=(0.05,), rim_share=0.9)
    with warnings.catch_warnings():
        warnings.simplefilter("error", DesignWarning)
        found = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=target)
    with pytest.warns(DesignWarning, match="slip_stability"):
        replace(found.bearings()[0])


def test_what_none_keeps_is_told() -> None:
    tight = DesignTarget(radii=(2.0,), frictions=(0.05,), max_displacement=0.1)
    words = r"displacement 0\.\d+ m exceeds 0\.1 m\. Raise max_displacement, or"
    with pytest.raises(NoCandidateError, match=words) as told:
        design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=tight)
    assert [one.governing.what for one in told.value.candidates] == ["displacement"]
    assert told.value.candidates[0].governing.ratio == pytest.approx(
        told.value.candidates[0].displacement / 0.1
    )
    weak = DesignTarget(radii=(2.0,), frictions=(0.05,), limits=DesignLimits(rim_strength=100e3))
    with pytest.raises(CheckError, match="interface slips before the rim breaks"):
        design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=weak)
    for wrong in (
        {"rim_share": 2.0},
        {"rim_share": 0.0},
        {"free_margin": 0.9},
        {"radii": ()},
        {"pressure": -1.0},
        {"max_base_shear": 0.0},
    ):
        with pytest.raises(CheckError):
            DesignTarget(**wrong)


def test_plates_too_deep_are_a_reason_and_no_failure() -> None:
    steep = DesignTarget(radii=(0.3, 2.0), frictions=(0.05,), rim_share=0.9)
    found = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=steep)
    assert "too large for their depth" in found.candidates[0].lacks[0]
    assert found.chosen.radius == 2.0


def test_a_building_stands_on_what_is_proposed() -> None:
    frame = shear_building(ANY, 200e3, 4e8, storeys=3, plan=((2, 1), (6.0, 8.0)), base_mass=200e3)
    found = design(frame, SPECTRUM, bounds=BOUNDS, target=ONE, code=ASCE7())
    isolated = found.isolated(frame)
    assert isolated.name == "shear building, LIR-DCFP"
    state = gravity(isolated)
    assert float(state.axial_forces.sum()) == pytest.approx(800e3 * G, rel=1e-6)
    with pytest.raises(CheckError, match="1 bearings, the design 6"):
        design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=ONE).isolated(
            shear_building(ANY, 200e3, 4e8)
        )


def test_rounding_goes_up_and_forgives_round_off() -> None:
    assert rounded_up(0.1251, 0.005) == 0.13
    assert rounded_up(0.125 + 1e-12, 0.005) == 0.125


def test_a_device_that_cannot_be_made_leaves_the_others() -> None:
    """Plates that are to go as far as D without rims overlap, those of the proposal do not."""
    deep = Spectrum.asce7(s_ms=2.0, s_m1=1.5, s_1=0.75)
    light = replace(SYSTEM, loads=(8e5,) * 6, combinations={})
    found = design(light, deep, bounds=BOUNDS, target=replace(ONE, least_pressure=1e6))
    free: Device = "DCFP without rim contact"
    with pytest.raises(CheckError, match=rf"the {free} of 1\d+ mm cannot be made: slider_height"):
        found.bearings(free)
    table = found.table()
    assert table.loc["LIR-DCFP", "capacity [m]"] == found.bearings()[0].lateral_capacity
    assert math.isnan(table.loc[free, "capacity [m]"])
    assert "the rise of both concave surfaces" in str(found)


def test_pairs_of_which_no_bearing_can_be_made_leave_the_others() -> None:
    """No slider fits a bowl of its own size."""
    target = replace(ONE, radii=(0.1, 2.0), frictions=(0.05,))
    found = design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=target)
    assert [one.radius for one in found.candidates] == [2.0]
    assert [one[:2] for one in found.impossible] == [(0.1, 0.05)]
    assert "does not fit a concave surface of radius 0.1 m" in found.impossible[0].reason
    table = found.to_dataframe()
    assert list(table["outcome"]) == ["proposed", "cannot be made"]
    with pytest.raises(NoCandidateError, match=r"none of 1 pairs.*use a smaller slider") as none:
        design(SYSTEM, SPECTRUM, bounds=BOUNDS, target=replace(target, radii=(0.1,)))
    assert len(none.value.impossible) == 1


def of_long_period(seed: int) -> GroundMotion:
    """Return noise of 20 s of which periods below some 3 s are filtered out."""
    draw = np.random.default_rng(seed)
    k = math.exp(-2.0 * math.pi * 0.02 / 0.5)
    envelope = np.sin(np.linspace(0.0, math.pi, 1001)) ** 2
    both = [envelope * lfilter([1 - k], [1, -k], draw.normal(0.0, 4.0, 1001)) for _ in "xy"]
    x, y = (each - each.mean() for each in both)
    return GroundMotion(x=x, y=y, dt=0.02)


@pytest.mark.meant("few|factor|g of")
def test_a_proposal_is_sized_on_one_mass_by_the_motions() -> None:
    """Motions that exceed the target at T_M take the bearing of the formula beyond its rims."""
    code, target = code_named("NCh2745"), Spectrum.nch2745(soil="III", zone=3)
    given = MotionSet({str(seed): of_long_period(seed) for seed in (1, 2, 3)})

    def scaled(linear: EquivalentLinear) -> MotionSet:
        return given.scaled_to(target, rule=code.name, periods=period_range(linear), least=3)

    one = replace(ONE, radii=(1.5,), frictions=(0.04,))
    found = design(SYSTEM, target, bounds=BOUNDS, target=one, code="NCh2745")
    how = OneMass(scaled, target, code.histories, BOUNDS, ("lower",))
    trial = tried_on_one_mass(found, found.chosen, how)
    period, mean, asked = trial.excess
    assert period == found.chosen.analysis.bounds["lower"].period
    each = scaled(found.chosen.analysis).values()
    level = [pair_spectrum(one, [period], 0.05, "SRSS")[0] for one in each]
    assert mean == pytest.approx(np.mean(level) / target.acceleration(period), rel=1e-12)
    assert mean > 1.3 * asked
    assert trial.passed
    assert not trial.sized.lacks
    t, before = trial.sized.trace, found.chosen.trace
    assert t.value("D_EL") == pytest.approx(before.value("D"), rel=1e-6)
    assert t.value("D") >= trial.free > 1.2 * before.value("D")
    assert set(trial.failed) == {
        Place(level, factor, "lower") for level in ("design", "maximum") for factor in (1.0, MARGIN)
    }
    narrow = replace(one, max_displacement=1.1 * before.value("D"))
    found = design(SYSTEM, target, bounds=BOUNDS, target=narrow, code="NCh2745")
    kept = tried_on_one_mass(found, found.chosen, how)
    assert kept.failures(1.0) > 0
    assert kept.sized is found.chosen
    assert "displacement" in kept.larger_lacks[0]
    assert kept.outcome == "fails"
    assert f"{mean:.2f} times the target at {period:.2f} s" in str(kept)
