"""The study of the best devices of a plan: they are of equal plan, and what it computes holds."""

import math

import pytest

from frames.risk.campaign.compared_devices import dish_diameter
from validation.study.device_runs import (
    REFERENCE,
    SOFT,
    Device,
    best_devices,
    frame_of,
    own_bearings,
    plan_of,
)
from validation.study.rims_runs import KINDS, MORE
from validation.study.rims_runs import devices as rims_devices


def test_devices_of_a_plan_have_its_dish_under_the_centre():
    for device in best_devices().values():
        bearings = [link.bearing for link in frame_of(device).bearings.values()]
        assert max(dish_diameter(each) for each in bearings) == pytest.approx(device.plan)
        assert len({round(each.lateral_capacity, 9) for each in bearings}) == 1
        for own, each in zip(own_bearings(), bearings, strict=True):
            assert each.slider_radius >= own.slider_radius
            assert each.resolved()["design_load"] == own.resolved()["design_load"]


def test_sliders_by_load_are_the_devices_of_the_study_of_rims():
    """Every bearing of a device with sliders by load is that of the study of rims."""
    studied = rims_devices()
    for kind in KINDS:
        device = Device(
            plan_of(MORE if kind.wider else 0.0),
            kind.plain,
            more=kind.wider_sliders * MORE if kind.wider and not kind.plain else 0.0,
            interface=kind.interface,
            strength=kind.strength,
        )
        mine = frame_of(device).bearings
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
    largest = max(own.slider_radius for own in own_bearings())
    plan = plan_of(REFERENCE)
    plain = frame_of(Device(plan, True)).bearings
    equal = frame_of(Device(plan, False, least=largest, interface=0.2)).bearings
    for place, link in equal.items():
        assert link.bearing.slider_radius == pytest.approx(largest)
        assert link.bearing.resolved()["slip_capacity"] == pytest.approx(largest)
        capacity = plain[place].bearing.lateral_capacity
        assert link.bearing.lateral_capacity == pytest.approx(capacity)


def test_soft_rims_break_at_a_tenth_of_the_force():
    soft, own = frame_of(Device(plan_of(0.0), True, soft=True)).bearings, own_bearings()
    for link, each in zip(soft.values(), own, strict=True):
        options, reference = link.bearing.resolved(), each.resolved()
        assert math.isinf(link.bearing.rim_yield_force)
        at_break = options["rim_stiffness"] * options["rim_overrun"]
        assert at_break == pytest.approx(
            SOFT * reference["rim_stiffness"] * reference["rim_overrun"]
        )
