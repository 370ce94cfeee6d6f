"""The study of rims that yield: its devices are of equal plan."""

import math

import pytest

from frames.risk.campaign.comparison import dish_diameter
from validation.study.rims import OURS, PLAINS
from validation.study.rims_runs import ENDLESS, KINDS, MORE, devices


@pytest.fixture(scope="module")
def every():
    return devices()


def test_devices_are_of_equal_plan_and_load(every):
    """Under each place all devices of a plan need one dish, and refer to one load."""
    assert len(every) == len(KINDS) == len({kind.name for kind in KINDS})
    for wider in (False, True):
        own = [every[kind.name].bearings for kind in (*PLAINS[wider], *OURS[wider])]
        for place in own[0]:
            dishes = {round(dish_diameter(bearings[place].bearing), 9) for bearings in own}
            loads = {
                round(bearings[place].bearing.resolved()["design_load"], 3) for bearings in own
            }
            assert len(dishes) == len(loads) == 1
    smaller, larger = (every[PLAINS[wider][0].name].bearings for wider in (False, True))
    for place, link in smaller.items():
        assert dish_diameter(larger[place].bearing) - dish_diameter(link.bearing) == pytest.approx(
            2.0 * MORE
        )


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_rims_are_as_strong_as_they_are_called(every, kind):
    for link in every[kind.name].bearings.values():
        bearing, options = link.bearing, link.bearing.resolved()
        assert bearing.is_dcfp is kind.plain
        if kind.strength is None:
            assert math.isinf(bearing.rim_yield_force)
            assert options["rim_overrun"] == ENDLESS
        else:
            assert bearing.rim_yield_force == kind.strength * options["design_load"]
        if kind.wider and not kind.plain:
            other = every[OURS[False][0].name].bearings
            sliders = {round(each.bearing.slider_radius, 6) for each in other.values()}
            assert round(bearing.slider_radius - MORE * kind.wider_sliders, 6) in sliders
