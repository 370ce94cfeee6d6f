"""The study of the best devices of a plan: they are of equal plan, and what it computes holds."""

import dataclasses
import json
import math

import numpy as np
import pandas as pd
import pytest
from scipy.stats import norm

from frames.risk import Intensity, IntensityRuns
from frames.risk.campaign.comparison import dish_diameter
from frames.risk.fragility.runs import COMPLETE, FAILURE
from lir_element import CoulombFriction, cyclic_test
from validation.measurements.yielding_runs import LIR
from validation.page import FOLDER
from validation.study import device_cost, device_numbers, device_page, device_search
from validation.study.device_figures import winner
from validation.study.device_runs import (
    COMPARED,
    REFERENCE,
    SOFT,
    Device,
    bearing_of,
    best_devices,
    frame_of,
    own_bearings,
    plain_devices,
    plan_of,
    reach_of,
    shape_of,
    soft_device,
)
from validation.study.rims_runs import KINDS, MORE
from validation.study.rims_runs import devices as rims_devices


def bearings_on(one):
    own = own_bearings()
    return [bearing_of(each, one, reach_of(one, own)) for each in own]


@pytest.fixture(scope="module")
def stored():
    return json.loads((FOLDER / f"{device_page.NAME}.json").read_text(encoding="utf-8"))


# Devices


def test_devices_of_a_plan_have_its_dish_under_the_centre():
    every = [*best_devices().values()]
    every += [each for more in COMPARED for each in plain_devices(plan_of(more)).values()]
    for one in every:
        bearings = bearings_on(one)
        assert max(dish_diameter(each) for each in bearings) == pytest.approx(one.plan)
        assert len({round(each.lateral_capacity, 9) for each in bearings}) == 1
        for own, each in zip(own_bearings(), bearings, strict=True):
            assert each.slider_radius >= own.slider_radius
            assert each.resolved()["design_load"] == own.resolved()["design_load"]
            assert each.effective_radius == pytest.approx(own.effective_radius)


def test_sliders_by_load_are_the_devices_of_the_study_of_rims():
    """Every bearing of a device with sliders by load is that of the study of rims."""
    studied = rims_devices()
    for kind in KINDS:
        one = Device(
            plan_of(MORE if kind.wider else 0.0),
            kind.plain,
            more=kind.wider_sliders * MORE if kind.wider and not kind.plain else 0.0,
            interface=kind.interface,
            strength=kind.strength,
        )
        mine = frame_of(one).bearings
        for place, link in studied[kind.name].bearings.items():
            mine_there, there = mine[place].bearing, link.bearing
            assert mine_there.is_dcfp is there.is_dcfp
            assert mine_there.rim_yield_force == there.rim_yield_force
            assert mine_there.interface_friction == there.interface_friction
            for name in ("slider_radius", "lateral_capacity"):
                assert getattr(mine_there, name) == pytest.approx(getattr(there, name), rel=1e-12)
            for name in ("rim_stiffness", "rim_overrun", "rim_damping", "slip_capacity"):
                assert mine_there.resolved()[name] == pytest.approx(there.resolved()[name])


def test_larger_small_sliders_take_nothing_from_the_way_to_the_rims():
    """A least radius up to the largest slider's own leaves plan and capacity as they are."""
    largest = device_search.sliders().largest
    plan = plan_of(REFERENCE)
    plain = bearings_on(Device(plan, True))
    equal = bearings_on(Device(plan, False, least=largest, interface=0.2))
    for one, other in zip(equal, plain, strict=True):
        assert one.slider_radius == pytest.approx(largest)
        assert one.resolved()["slip_capacity"] == pytest.approx(largest)
        assert one.lateral_capacity == pytest.approx(other.lateral_capacity)


def test_soft_rims_break_at_a_tenth_of_the_force():
    for soft, each in zip(bearings_on(soft_device()), own_bearings(), strict=True):
        options, reference = soft.resolved(), each.resolved()
        assert math.isinf(soft.rim_yield_force)
        at_break = options["rim_stiffness"] * options["rim_overrun"]
        assert at_break == pytest.approx(
            SOFT * reference["rim_stiffness"] * reference["rim_overrun"]
        )


def test_plates_do_not_touch_and_no_slider_is_higher_than_that_asks():
    own = own_bearings()[0]
    for more in COMPARED:
        plan = plan_of(more)
        radius, height = shape_of(plan, own)
        rise = 2.0 * (radius - math.sqrt(radius**2 - 0.25 * plan**2))
        assert rise < height
        assert 2.0 * radius - height == pytest.approx(own.effective_radius)
        assert height == own.slider_height or rise > height - 0.015


# The search


def test_bounds_of_the_interface_are_those_of_slip_and_of_tipping():
    """At kappa = 1 the whole slip holds, by the bearing's own limit; at 2 the resultant is at a."""
    for share in (0.0, 0.5, 1.0, 2.0):
        least = device_search.least_of(share)
        for kappa in (1.0, 2.0):
            one = device_search.device_at(plan_of(REFERENCE), share, kappa)
            smallest = min(bearings_on(one), key=lambda each: each.slider_radius)
            assert smallest.slider_radius == pytest.approx(least)
            radius, friction = smallest.radii[0], smallest.friction.f_max
            arm = (radius - 0.5 * smallest.slider_height) * one.interface - friction * radius
            if kappa == 1.0:
                assert smallest.slip_stability == pytest.approx(least)
            else:
                assert arm == pytest.approx(least)


def test_the_largest_sliders_have_the_least_pressure_in_the_mean():
    loads = np.array([each.resolved()["design_load"] for each in own_bearings()])
    pressures = loads / (math.pi * device_search.sliders().most ** 2)
    assert np.average(pressures, weights=loads) == pytest.approx(10e6)


def test_the_work_by_hand_is_that_of_a_push_on_the_rig():
    """A bearing of the level `pendulum` pushed to its rims, and on by its slip, takes that work."""
    one = device_search.device_at(plan_of(0.0), 1.0, 2.0)
    corner = min(bearings_on(one), key=lambda each: each.resolved()["design_load"])
    parts = device_search.energies(one)
    friction = CoulombFriction(corner.friction.f_max)
    law = {"friction": friction, "interface_friction": one.interface}
    pushed = dataclasses.replace(corner, **law)
    slip = 0.5 * corner.slider_radius
    load = corner.resolved()["design_load"]
    ends = [0.0, corner.lateral_capacity, corner.lateral_capacity + slip]
    path = np.concatenate([np.linspace(ends[0], ends[1], 200), np.linspace(ends[1], ends[2], 100)])
    data = cyclic_test(pushed, path, load)
    force = np.abs(data["bearing_force"].isel(bearing=0).sel(axis="x").to_numpy())
    to_rims = path <= ends[1]
    assert np.trapezoid(force[to_rims], path[to_rims]) / load == pytest.approx(
        parts["sliding"], rel=0.03
    )
    beyond = np.trapezoid(force[~to_rims], path[~to_rims]) / load
    assert beyond == pytest.approx(0.5 * parts["slip"], rel=0.05)


@pytest.mark.parametrize("median", [1.9, 2.6, 3.4])
def test_the_median_of_a_known_curve_is_found_again(median):
    shares = norm.cdf(np.log(np.array(device_search.STRIPES) / median) / device_search.DISPERSION)
    assert device_search.median_of(shares) == pytest.approx(median)


def test_proposals_find_the_top_of_a_surface_that_is_known():
    """Medians that fall off from a ridge of sliders and kappa, over the trend of the work."""
    rows = []
    for plan, share, kappa in device_search.first_points():
        one = device_search.device_at(plan, share, kappa)
        work = device_search.work_of(one)
        off = 0.8 * abs(share - 0.4) + 0.8 * abs(kappa - 1.2)
        rows.append({"plan": plan, "sliders": share, "kappa": kappa, "work": work})
        rows[-1]["median"] = 8.0 * work**0.5 * math.exp(-off)
    (found,) = device_search.proposals(rows, [plan_of(REFERENCE)])
    assert found[1] < 1.0
    assert found[2] < 1.6


# Comparison


def test_who_is_ahead_counts_failures_as_infinite_and_leaves_unknown_runs_out():
    inf, nan = math.inf, math.nan
    own = np.array([[1.0, 1.0], [2.0, inf], [3.0, inf], [nan, inf]])
    other = np.array([[2.0, inf], [3.0, inf], [4.0, inf], [0.0, 9.0]])
    samples = np.tile(np.arange(4), (5, 1))
    first, second = device_numbers.ahead(own, other, samples, "median")
    assert first == [2.0, 3.0, 1.0, 0.0]
    assert second == [None, None, 0.0, 0.0]
    assert winner(first) == "LIR"
    assert winner(second) == ""
    assert winner([0.4, 0.1, 0.05, 0.92]) == "DCFP"


def test_a_slider_beyond_its_dish_is_a_failure():
    own = own_bearings()[0]
    plan = plan_of(0.0)  # 250 mm of way
    table = pd.DataFrame(
        {
            "motion": ["a", "b"],
            "scale": 1.0,
            "im": 1.0,
            "outcome": COMPLETE,
            "status": "ok",
            "message": "",
            device_numbers.DISPLACEMENT: [own.lateral_capacity - 1e-6, own.lateral_capacity + 1e-6],
        }
    )
    runs = IntensityRuns(table, Intensity(kind="PGA"), {device_numbers.DISPLACEMENT: "m"})
    found = device_numbers.free_of(runs, plan).table
    assert found["outcome"].tolist() == [COMPLETE, FAILURE]
    assert table["outcome"].tolist() == [COMPLETE, COMPLETE]


# Cost


def test_cost_of_a_bearing_by_hand():
    """A bearing of the plan of 569 mm in the centre, with rims of 1 W."""
    bearing = max(bearings_on(Device(plan_of(0.0), True)), key=lambda each: each.slider_radius)
    parts = device_cost.parts_of(bearing, 1.0, device_cost.PRICES)
    a, dish, radius = bearing.slider_radius, 0.568685, 1.185
    width = 2071993.0 / (2.0 * a * 207e6)
    depth = radius - (radius**2 - dish**2 / 4.0) ** 0.5
    plate = math.pi / 4.0 * (dish + 2.0 * width) ** 2 * (depth + 0.03) * 7850.0
    assert parts["plates"] == pytest.approx(2.0 * plate, rel=1e-4)
    assert parts["sliders"] == pytest.approx(1.5 * 7850.0 * math.pi * a**2 * 0.12)
    assert parts["liners"] == pytest.approx(500.0 * 2.0 * math.pi * a**2)
    assert parts["rims"] == pytest.approx(
        2.0 * 1.5 * 7850.0 * math.pi * (dish + width) * width * 0.025, rel=1e-4
    )
    assert parts["overlays"] == pytest.approx(250.0 * 4.0 * math.pi * radius * depth, rel=1e-4)
    assert device_cost.rim_width(bearing, None) == pytest.approx(4.0 * width, rel=1e-4)


def test_a_third_face_is_paid_by_the_lir_dcfp_alone():
    plan = plan_of(0.0)
    plain = bearings_on(Device(plan, True))[0]
    lir = bearings_on(Device(plan, False, interface=0.13))[0]
    first, second = (device_cost.parts_of(b, 1.0, device_cost.PRICES) for b in (plain, lir))
    area = math.pi * plain.slider_radius**2
    assert second["liners"] - first["liners"] == pytest.approx(500.0 * area)
    assert second["overlays"] - first["overlays"] == pytest.approx(250.0 * area)
    assert second["plates"] == pytest.approx(first["plates"])


def test_margins_at_equal_cost_are_interpolated_within_both():
    found = device_cost.at_equal_cost({1.0: 5.0, 3.0: 7.0, 9.0: 8.0}, {2.0: 4.0, 4.0: 6.0})
    assert found == [(3.0, 7.0, 5.0)]
    assert device_cost.repriced({"plates": 10.0, "rims": 2.0}, {"plates": 0.5}) == 7.0


# The page


def test_the_device_that_other_parts_take_is_that_of_the_page(stored):
    (found,) = (
        plan["devices"][LIR]["device"]
        for plan in stored["plans"]
        if plan["plan"] == pytest.approx(plan_of(REFERENCE), rel=1e-5)
    )
    taken = best_devices()[LIR]
    assert taken.least == pytest.approx(found["least"], rel=1e-3)
    assert 0.0 <= found["interface"] - taken.interface < 0.01
    assert taken.strength == found["strength"]
