"""The study of buildings: members, loads and devices as stated."""

import math

import numpy as np
import pandas as pd
import pytest

from frames.risk import IntensityRuns
from frames.risk.campaign.comparison import dish_diameter
from validation.measurements.yielding_runs import LIR
from validation.study.buildings_numbers import DEFINITIONS, facts_of
from validation.study.buildings_runs import (
    BUILDINGS,
    FRAMES,
    WALLED,
    WALLS,
    Building,
    building,
    strength,
    wall_hinge,
    yield_rotations,
)
from validation.study.paired import DEVICES, FACTOR, OTHERS, devices_of, on_devices

buildings = pytest.mark.parametrize("one", BUILDINGS, ids=lambda one: one.name)
LOW = Building(3, FRAMES)


@buildings
def test_bearings_have_one_pressure_and_devices_one_plan(one):
    frame = building(one)
    own = {name: link.bearing for name, link in frame.bearings.items()}
    pressures = {
        round(b.resolved()["design_load"] / (math.pi * b.slider_radius**2), 3) for b in own.values()
    }
    assert pressures == {round(2000e3 / (math.pi * 0.15**2), 3)}
    assert {round(b.effective_radius, 9) for b in own.values()} == {2.25}
    devices = devices_of(own)
    assert list(devices) == [LIR, *OTHERS]
    widest = {round(max(dish_diameter(b) for b in each.values()), 9) for each in devices.values()}
    assert len(widest) == 1
    ways = [{round(b.rim_displacement[0], 9) for b in each.values()} for each in devices.values()]
    assert all(way == ways[0] and len(way) == 1 for way in ways)
    for name, each in devices.items():
        assert {b.is_dcfp for b in each.values()} == {name != LIR}
    sliders = {round(b.slider_radius, 9) for b in devices[LIR].values()}
    assert sliders == {round(max(b.slider_radius for b in own.values()), 9)}


@buildings
def test_bearings_carry_what_stands_on_them(one):
    """Loads, of the first design, are those of the building that is run, and sum to its weight."""
    frame = building(one)
    loads = [link.bearing.resolved()["design_load"] for link in frame.bearings.values()]
    steel = sum(
        m.section.density * m.section.area * _length(frame, m) for m in frame.members.values()
    )
    floors = (one.storeys + 1) * 144.0 * 1450.0
    assert sum(loads) == pytest.approx(9.80665 * (steel + floors), rel=1e-6)


def _length(frame, member):
    ends = [
        np.array(frame.nodes[node].position) + np.array(offset)
        for node, offset in zip((member.i, member.j), member.offsets, strict=True)
    ]
    return float(np.linalg.norm(ends[1] - ends[0]))


def test_the_strength_of_a_low_frame_by_hand():
    """Beams I 400 x 180 and columns box 300 x 16 of 345 MPa: 36 beam ends along x, 9 feet."""
    beam = 345e6 * (0.18 * 0.0135 * 0.3865 + 0.25 * 0.0086 * 0.373**2)
    column = 345e6 * 1.5 * 0.3 * 0.3 * 0.3 * (1.0 - (0.268 / 0.3) ** 3) / 6.0
    moments = 36.0 * beam + 9.0 * column
    assert strength(LOW) == pytest.approx(
        moments / (0.5 * 4 * 3.5) / facts_of(LOW)["weight"], rel=1e-6
    )


@pytest.mark.parametrize("storeys", [3, 9])
def test_walls_stand_in_the_facades_and_yield_at_their_feet(storeys):
    frame = building(Building(storeys, WALLS))
    for storey in range(1, storeys + 1):
        for (ix, iy), axis in WALLED.items():
            name = f"column-{storey}-{ix}-{iy}"
            section = frame.members[name].section
            assert section.area == pytest.approx(0.9)
            assert section.inertia_y == pytest.approx(0.5 * 0.3 * 3.0**3 / 12.0)
            assert (name in frame.hinges) is (storey == 1)
            beam = frame.members[f"beam-{axis}-floor-{storey}-{ix if axis == 'y' else 0}-"
                                 f"{iy if axis == 'x' else 0}"]  # fmt: skip
            assert _length(frame, beam) == pytest.approx(4.5)
            yields = yield_rotations(Building(storeys, WALLS))
            free = yields[f"beam-{axis}-floor-{storey}-0-1" if axis == "x" else
                          f"beam-{axis}-floor-{storey}-1-0"]  # fmt: skip
            assert yields[beam.name] == pytest.approx(0.75 * free)
    bars = 0.01 * 0.9 * 420e6
    assert wall_hinge(1e6).moment_y == pytest.approx(0.5 * 3.0 * (bars + 1e6) * 0.8)


def test_members_change_every_three_storeys_from_the_top():
    frame, yields = building(Building(9, FRAMES)), yield_rotations(Building(9, FRAMES))
    areas = [frame.members[f"column-{storey}-1-1"].section.area for storey in range(1, 10)]
    assert [round(a, 6) for a in areas] == [0.0564] * 3 + [0.0375] * 3 + [0.018176] * 3
    assert set(yields) == set(frame.hinges)
    light = yields["beam-x-floor-9-0-0"]
    assert light == yield_rotations(LOW)["beam-x-floor-3-0-0"]
    inertia = (0.18 * 0.4**3 - (0.18 - 0.0086) * 0.373**3) / 12.0
    moment = 345e6 * (0.18 * 0.0135 * 0.3865 + 0.25 * 0.0086 * 0.373**2)
    assert light == pytest.approx(moment * 6.0 / (6.0 * 2.0e11 * inertia), rel=1e-3)


def test_definitions_judge_as_they_say():
    """All is well; drift; acceleration; a bearing after ductility 10; the analysis failed."""
    table = pd.DataFrame(
        {
            "motion": list("abcde"),
            "scale": 1.0,
            "im": 1.0,
            "outcome": ["complete"] * 3 + ["bearing failure", "numerical failure"],
            "status": "",
            "message": "",
            "ductility": [1.0, 7.0, 2.0, 10.0, 20.0],
            "storey drift, mean": [0.01, 0.05, 0.01, 0.03, 0.1],
            "floor acceleration in plan, mean": [1.0, 5.0, 30.0, 5.0, 5.0],
            "maximum uplift": [0.0, 0.06, 0.0, 0.0, 0.0],
        }
    )
    units = {name: "1" for name in table.columns[6:]}
    runs = IntensityRuns(table, FACTOR, units)
    expected = {
        "ductility 9 or a bearing": [0, 0, 0, 1],
        "ductility 6 or a bearing": [0, 1, 0, 1],
        "ductility 12 or a bearing": [0, 0, 0, 1],
        "drift 4 % or a bearing": [0, 1, 0, 1],
        "ductility 9, floor acceleration 2 g or a bearing": [0, 0, 1, 1],
        "ductility 9, uplift 50 mm or a bearing": [0, 1, 0, 1],
        "a bearing alone": [0, 0, 0, 1],
        "ductility 9 alone, as far as runs went": [0, 0, 0, 1],
        "drift 4 % alone, as far as runs went": [0, 1, 0, 0],
    }
    assert list(expected) == [each.name for each in DEFINITIONS]
    for each in DEFINITIONS:
        own, limit = each.of(runs)
        over = own.exceeded(limit)
        assert over[:4].tolist() == expected[each.name], each.name
        assert math.isnan(over[4])


def test_devices_are_called_by_building_and_device():
    names = {name: frame.name for name, frame in on_devices(building(LOW)).items()}
    assert names == {name: f"3 storeys, frames, {name}" for name in DEVICES}
