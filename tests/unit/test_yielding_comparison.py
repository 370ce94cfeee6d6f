"""The comparison of buildings that yield: its sections, models, and how it counts."""

import math

import numpy as np
import pytest

from frames import gravity
from validation.measurements import yielding_comparison
from validation.measurements.yielding_comparison import ends, wins, worse
from validation.measurements.yielding_runs import (
    LIR,
    MOAT,
    RIMS,
    SYSTEMS,
    WALL_STIFFNESS,
    WIDE,
    YIELD_STRESS,
    box_modulus,
    i_moduli,
    model_of,
    structures,
)


def fibres(width, depth, solid):
    """Return the plastic modulus about y of a section of fibres, (n, n) in y and z."""
    n = 1200
    y = (np.arange(n) + 0.5) / n * width - 0.5 * width
    z = (np.arange(n) + 0.5) / n * depth - 0.5 * depth
    inside = solid(*np.meshgrid(y, z))
    return float((inside * np.abs(z)[:, None]).sum() * width * depth / n**2)


def test_plastic_moduli_are_those_of_fibres():
    side, wall = 0.4, 0.025
    inner = 0.5 * side - wall
    box = fibres(side, side, lambda y, z: (abs(y) > inner) | (abs(z) > inner))
    assert box_modulus(side, wall) == pytest.approx(box, rel=3e-3)
    depth, width, flange, web = 0.55, 0.22, 0.020, 0.012

    def shape(y, z):
        return (abs(z) > 0.5 * depth - flange) | (abs(y) < 0.5 * web)

    strong, weak = i_moduli(depth, width, flange, web)
    assert strong == pytest.approx(fibres(width, depth, shape), rel=1e-2)
    turned = fibres(depth, width, lambda y, z: shape(z, y))
    assert weak == pytest.approx(turned, rel=1e-2)


@pytest.mark.parametrize("name", ["demo", "light"])
def test_columns_are_stronger_than_beams_and_all_carry_the_weight(name):
    structure = structures()[name]
    columns, beams = structure.moduli
    assert columns > 1.2 * beams
    assert structure.hinges["column"].axial == YIELD_STRESS * structure.column.area
    forces = gravity(model_of(structure, LIR)).axial_forces
    assert forces.min() > 0.0


def test_systems_differ_in_what_stops_them():
    frames = {system: model_of(structures()["demo"], system) for system in SYSTEMS}
    devices = {system: frame.bearings["bearing-0-0"].bearing for system, frame in frames.items()}
    assert math.isfinite(devices[LIR].interface_friction)
    assert math.isinf(devices[RIMS].interface_friction)
    assert devices[RIMS].lateral_capacity == devices[LIR].lateral_capacity
    assert math.isinf(devices[WIDE].lateral_capacity)
    assert [len(frame.links) for frame in frames.values()] == [0, 0, 0, 12]
    for side in ("x+", "x-", "y+", "y-"):
        walls = [link.law for name, link in frames[MOAT].links.items() if name.endswith(side)]
        assert sum(law.stiffness for law in walls) == pytest.approx(WALL_STIFFNESS)
        assert [law.gap for law in walls] == pytest.approx([devices[LIR].lateral_capacity] * 3)
    assert not model_of(structures()["demo"], RIMS, elastic=True).hinges


def row(system, drift, status="ok", **more):
    place = {"record": "one", "demand": 1.2, "structure": "demo", "elastic": False}
    return (
        place
        | {"system": system, "status": status, "drift": drift}
        | {"rotation": 0.0, "residual": 0.0, "floor": 1.0, "shear": 1.0}
        | more
    )


def test_wins_are_counted_over_runs_that_both_complete():
    mine = row(LIR, 0.01)
    for theirs, expected in ((0.02, (1, 0, 0)), (0.0101, (0, 1, 0)), (0.005, (0, 0, 1))):
        assert wins([(mine, row(RIMS, theirs))], "drift") == expected
    found = [mine, row(RIMS, 0.005), row(MOAT, 0.001, "step_too_small")]
    assert len(worse(found, RIMS, [1.2])) == 1
    assert worse(found, MOAT, [1.2]) == []
    assert worse(found, RIMS, [1.1]) == []
    assert ends(found) == "2 of 3, 1 `step_too_small`"


def test_it_is_skipped_without_records(monkeypatch, tmp_path, capsys):
    monkeypatch.setenv("LIR_RECORDS", str(tmp_path))
    yielding_comparison.main([])
    assert "skipped, LIR_RECORDS names no folder with RSN1044" in capsys.readouterr().out
