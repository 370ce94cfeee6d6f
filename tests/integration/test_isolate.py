"""isolate: bearings under a model of OpenSees in one call, against putting them by hand."""

import importlib.util
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

from lir_element.opensees import (
    IsolationWarning,
    bearing_element,
    bearing_response,
    bearing_tags,
    isolate,
    isolation,
)
from tests.scenes import simple_bearing
from validation.opensees.isolators import waves
from validation.opensees.model import gravity_analysis, permanent_loads
from validation.opensees.runs import respond

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("openseespy") is None, reason="openseespy is not installed"
)

DEVICE = simple_bearing(capacity=0.15, interface_friction=0.12, axial_stiffness=1e9)
CORNERS = ((0.0, 0.0), (5.0, 0.0), (5.0, 4.0), (0.0, 4.0))
WEIGHT, FLOOR = 2e5, 3.5  # N at each corner of the floor, its height in m
YIELD = 2e7  # N/m2, of fibre columns


def table(ops, up="z", length=1.0, force=1.0, *, fibres=False, base_mass=5e3, supports=(1,) * 6):
    """Four columns under a floor, in units of `length` m and `force` N; fibre columns yield."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    mass = force / length

    def point(x, y, z):
        return [v / length for v in ((x, y, z) if up == "z" else (x, z, -y))]

    for tag, (x, y) in enumerate(CORNERS, start=1):
        ops.node(tag, *point(x, y, 0.0))
        ops.node(10 + tag, *point(x, y, FLOOR))
        ops.fix(tag, *supports)
        ops.mass(tag, *[base_mass / mass] * 3, 0.0, 0.0, 0.0)
        ops.mass(10 + tag, *[2e4 / mass] * 3, 0.0, 0.0, 0.0)
    ops.geomTransf("PDelta", 1, 1.0, 0.0, 0.0)
    ops.geomTransf("Linear", 2, *((0.0, 0.0, 1.0) if up == "z" else (0.0, 1.0, 0.0)))
    stress, second = force / length**2, length**4
    beam = (
        0.02 / length**2,
        2e11 / stress,
        8e10 / stress,
        *(v / second for v in (1e-4, 2e-4, 2e-4)),
    )
    if fibres:
        ops.uniaxialMaterial("Steel01", 1, YIELD / stress, 2e11 / stress, 0.02)
        ops.section("Fiber", 1, "-GJ", 1e7 / (force * length**2))
        ops.patch("rect", 1, 8, 8, *(v / length for v in (-0.08, -0.08, 0.08, 0.08)))
        ops.beamIntegration("Lobatto", 1, 1, 4)
    for tag in range(1, 5):
        if fibres:
            ops.element("forceBeamColumn", tag, tag, 10 + tag, 1, 1)
        else:
            ops.element("elasticBeamColumn", tag, tag, 10 + tag, *beam, 1)
        ops.element("elasticBeamColumn", 10 + tag, 10 + tag, 11 + tag % 4, *beam, 2)
    permanent_loads(ops)
    down = [0.0, 0.0, -1.0] if up == "z" else [0.0, -1.0, 0.0]
    for tag in range(11, 15):
        ops.load(tag, *(v * WEIGHT / force for v in down), 0.0, 0.0, 0.0)
    ops.rayleigh(0.0, 0.0, 0.002, 0.0)


def shake(ops, nodes, elements, *, length=1.0, up="z", duration=2.5, system="UmfPack"):
    """Loads, then a synthetic motion; displacements in m by x, y, z of a model z up."""
    gravity_analysis(ops)
    motion = waves(0.7, duration)
    if up == "y":
        x, y, z = motion.components.T
        motion = type(motion)(x, z, -y, dt=motion.dt)
    track = respond(
        ops, motion, 0.005, nodes, elements, duration=duration, system=system, length_unit=length
    )
    moved = length * track.displacement[..., :3]
    return moved if up == "z" else moved[..., [0, 2, 1]] * [1.0, -1.0, 1.0]


def by_hand(ops):
    """The same as isolate(range(1, 5), DEVICE), with coincident nodes."""
    for tag in range(1, 5):
        ops.node(100 + tag, *ops.nodeCoord(tag))
        ops.fix(100 + tag, 1, 1, 1, 1, 1, 1)
        bearing_element(100 + tag, 100 + tag, tag, DEVICE)
        for dof in (1, 2, 3, 6):
            ops.remove("sp", tag, dof)
    ops.rigidDiaphragm(3, 1, 2, 3, 4)


def test_the_same_as_by_hand_under_columns_that_yield(ops):
    nodes = [1, 13]
    table(ops, fibres=True)
    by_hand(ops)
    expected = shake(ops, nodes, [101])
    strain = ops.eleResponse(1, "section", "1", "deformation")
    table(ops, fibres=True)
    found = isolate(range(1, 5), DEVICE)
    moved = shake(ops, nodes, [found.elements[1]])
    assert found.grounds == {1: 15, 2: 16, 3: 17, 4: 18}
    assert found.elements == {1: 15, 2: 16, 3: 17, 4: 18}
    assert found.released == dict.fromkeys(range(1, 5), (1, 2, 3, 6))
    assert found.held == dict.fromkeys(range(1, 5), (4, 5))
    assert found.tied == ((1, 2, 3, 4),)
    assert found.notes == ()
    assert ops.nodeCoord(15)[2] == pytest.approx(-DEVICE.height)
    assert np.abs(expected).max() > 0.1
    assert np.abs(strain[1:3]).max() > 2.0 * YIELD / 2e11 / 0.08  # twice the curvature at yield
    # the nodes' distance enters the solver's sequence by round-off only
    assert_allclose(moved, expected, rtol=0.0, atol=1e-6)
    axial = [bearing_response(tag, "axial_force") for tag in found.elements.values()]
    assert_allclose(sum(axial), 4.0 * WEIGHT, rtol=0.2)  # the vertical motion still rings
    text = str(found)
    assert "4 bearings under nodes 1, 2, 3, 4: elements 15, 16, 17, 18" in text
    assert "released [1, 2, 3, 6], held [4, 5]" in text
    assert "constraints('Transformation')" in text


def test_y_up_in_mm_and_kn(ops):
    nodes = [2, 12]
    table(ops)
    isolate([1, 2, 3, 4], dict.fromkeys(range(1, 5), DEVICE))
    expected = shake(ops, nodes, [])
    table(ops, "y", 1e-3, 1e3)
    found = isolate(
        [1, 2, 3, 4],
        DEVICE,
        vertical="y",
        length_unit=1e-3,
        force_unit=1e3,
        tags=[71, 72, 73, 74],
        ground_tags=[81, 82, 83, 84],
    )
    assert bearing_tags() == (71, 72, 73, 74)
    assert found.held == dict.fromkeys(range(1, 5), (4, 6))
    assert_allclose(ops.nodeCoord(82), [5e3, -1e3 * DEVICE.height, 0.0], atol=1e-9)
    moved = shake(ops, nodes, [], length=1e-3, up="y")
    assert_allclose(moved, expected, rtol=0.0, atol=1e-5 * np.abs(expected).max())


def test_a_symmetric_tangent_takes_a_symmetric_system(ops):
    table(ops)
    found = isolate([1, 2, 3, 4], DEVICE)
    assert found.tangent == "consistent"
    assert "system('UmfPack')" in str(found)
    expected = shake(ops, [1, 13], [])
    table(ops)
    found = isolate([1, 2, 3, 4], DEVICE, tangent="symmetric")
    assert found.tangent == "symmetric"
    assert "any system" in str(found)
    moved = shake(ops, [1, 13], [], system="ProfileSPD")
    assert np.abs(expected).max() > 0.05
    assert_allclose(moved, expected, rtol=0.0, atol=1e-5 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("rotations", "held", "released"),
    [("kept", (4,), (1, 2, 3)), ("free", (), (1, 2, 3, 4)), ("fixed", (4, 5), (1, 2, 3))],
)
def test_rotations_of_the_base(ops, rotations, held, released):
    table(ops, supports=(1, 1, 1, 1, 0, 0))
    found = isolate([1, 2, 3, 4], DEVICE, base_rotations=rotations, base_diaphragm=False)
    assert found.held[3] == held == tuple(ops.getFixedDOFs(3))
    assert found.released[3] == released
    assert found.tied == ()
    assert not ops.getConstrainedNodes()


def test_what_holds_the_base_besides_is_told(ops):
    table(ops, base_mass=0.0)
    ops.node(50, 0.0, 0.0, 0.0)
    ops.fix(50, 1, 1, 1, 1, 1, 1)
    ops.uniaxialMaterial("Elastic", 9, 1e8)
    ops.element("zeroLength", 60, 50, 1, "-mat", 9, "-dir", 3)
    with pytest.warns(IsolationWarning) as told:
        found = isolate([1, 2, 3, 4], DEVICE)
    assert len(told) == len(found.notes) == 2
    assert "elements 60 join base nodes to supports beside the bearings" in found.notes[0]
    assert "the base nodes have no mass" in found.notes[1]
    assert found.notes[0] in str(found)


@pytest.mark.parametrize("up", ["z", "y"])
def test_columns_of_a_plane_frame_are_no_supports(ops, up):
    # all upper nodes hold the axis across the plane: their columns are not beside the bearings
    table(ops, up)
    for tag in range(11, 15):
        ops.fix(tag, 0, *((1, 0) if up == "z" else (0, 1)), 0, 0, 0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = isolate([1, 2, 3, 4], DEVICE, vertical=up)
    assert found.notes == ()
    assert {1, 2, 3, 4} <= set(ops.getEleTags())


def ghost(ops):
    ops.node(50, 0.0, 0.0, 0.0)
    ops.fix(50, 1, 1, 1, 0, 0, 0)
    ops.remove("node", 50)


def grounded(ops):
    ops.node(50, 0.0, 0.0, 0.0)
    ops.fix(50, 1, 1, 1, 1, 1, 1)
    ops.equalDOF(50, 2, 1, 2)


def moved(ops):
    ops.setNodeDisp(2, 1, 0.02, "-commit")


def flat(ops):
    ops.model("basic", "-ndm", 3, "-ndf", 3)
    ops.node(50, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("change", "options", "message"),
    [
        (None, {"base_nodes": [1, 9]}, "no node 9"),
        (None, {"base_nodes": [1, 1]}, "lists node 1 more than once"),
        (None, {"base_nodes": []}, "base_nodes is empty"),
        (None, {"bearing": {1: DEVICE}}, "node 2 is in base_nodes but not in bearing"),
        (None, {"tags": [5, 6]}, "tags has 2 different tags: give one for each of 4 nodes"),
        (None, {"tags": [1, 6, 7, 8]}, "element 1 is in the model already"),
        (None, {"ground_tags": [5, 6, 14, 8]}, "node 14 is in the model already"),
        (None, {"vertical": "x"}, "vertical = 'x': choose one of"),
        (None, {"base_rotations": "loose"}, "base_rotations = 'loose': choose one of"),
        (None, {"tangent": "secant"}, "tangent = 'secant': choose one of"),
        (None, {"level": "exact"}, "level = 'exact': choose one of"),
        (None, {"length_unit": 0.0}, "length_unit = 0 "),
        (ghost, {}, r"nodes 50 were removed, but their fix was not: .*remove\('sp', 50, dof\)"),
        (grounded, {}, r"ties base node 2 to the fixed node 50: .*remove\('mp', 2\)"),
        (lambda ops: ops.rigidDiaphragm(3, 1, 2), {}, "ties base node 2 to node 1: .*m=Fal"),
        (moved, {}, r"base node 2 has moved by 0\.02 m"),
        (flat, {"base_nodes": [50]}, "node 50 has 3 coordinates and 3 degrees of freedom"),
    ],
)
def test_what_cannot_be_is_refused_and_leaves_the_model(ops, change, options, message):
    table(ops)
    if change:
        change(ops)
    before = state_of(ops)
    with pytest.raises(ValueError, match=message):
        isolate(**({"base_nodes": [1, 2, 3, 4], "bearing": DEVICE} | options))
    assert state_of(ops) == before


def test_a_failure_in_the_middle_leaves_the_model(ops, monkeypatch):
    table(ops)
    before = state_of(ops)

    def fail_at_three(tag, i, j, *arguments, **options):
        if j == 3:
            message = "no way"
            raise RuntimeError(message)
        return bearing_element(tag, i, j, *arguments, **options)

    monkeypatch.setattr(isolation, "bearing_element", fail_at_three)
    with pytest.raises(RuntimeError, match="no way"):
        isolate([1, 2, 3, 4], DEVICE)
    assert state_of(ops) == before
    gravity_analysis(ops)  # it works on


def state_of(ops):
    return (
        ops.getNodeTags(),
        ops.getEleTags(),
        [ops.getFixedDOFs(k) for k in (1, 2, 3, 4)],
        ops.getFixedNodes(),
        ops.getConstrainedNodes(),
    )
