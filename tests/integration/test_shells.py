"""Walls and slabs of OpenSees' shells on bearings: periods, and what each bearing carries."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, gravity, modes
from tests.scenes import small_bearing, solve_linear

pytest.importorskip("openseespy")

SIDE, G = 1.5, 9.80665
WALL = {(0.0, 0.0), (0.0, 1.5), (0.0, 3.0), (6.0, 0.0)}  # its panels: x, and y where they begin


BEARING = small_bearing()


def eccentric_box(ops):
    """Build a base slab and a roof between unlike walls; return tags by place and the corners."""
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for section, thickness in ((1, 0.5), (2, 0.2)):
        ops.section("ElasticMembranePlateSection", section, 31e9, 0.2, thickness, 2500.0)
    places = {}

    def shell(section, corners):
        for corner in corners:
            if corner not in places:
                places[corner] = len(places) + 1
                ops.node(places[corner], *corner)
        tag = len(ops.getEleTags()) + 1
        ops.element("ShellMITC4", tag, *(places[c] for c in corners), section)

    for y in (0.0, 1.5, 3.0):
        for z, section in ((0.0, 1), (3.0, 2)):
            for x in (0.0, 1.5, 3.0, 4.5):
                plan = ((x, y), (x + SIDE, y), (x + SIDE, y + SIDE), (x, y + SIDE))
                shell(section, [(*place, z) for place in plan])
        for x in (0.0, 6.0):
            for z in (0.0, 1.5) if (x, y) in WALL else ():
                face = ((y, z), (y + SIDE, z), (y + SIDE, z + SIDE), (y, z + SIDE))
                shell(2, [(x, *place) for place in face])
    corners = [places[x, y, 0.0] for x in (0.0, 6.0) for y in (0.0, 4.5)]
    for tag in corners:
        ops.fix(tag, 1, 1, 1, 0, 0, 0)
    return places, corners


def reactions_under_weight(ops, places, corners):
    """Return the vertical reactions at the corners, each node loaded by its own mass."""
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    weight = dict.fromkeys(places.values(), 0.0)
    for tag in ops.getEleTags():
        nodes = ops.eleNodes(tag)
        in_base = all(ops.nodeCoord(node)[2] <= 0.0 for node in nodes)
        thickness = 0.5 if in_base else 0.2
        for node in nodes:
            weight[node] += 0.25 * thickness * SIDE**2 * 2500.0 * G
    for node, force in weight.items():
        ops.load(node, 0.0, 0.0, -force, 0.0, 0.0, 0.0)
    solve_linear(ops, numberer="RCM")
    ops.reactions()
    return np.array([ops.nodeReaction(tag)[2] for tag in corners])


def test_a_box_of_shells(ops):
    places, corners = eccentric_box(ops)
    theirs = 2.0 * np.pi / np.sqrt(ops.eigen(4))
    taken = Frame.from_opensees(
        corners, BEARING, gravity=G, base_rotations="free", base_diaphragm=False
    )
    found = modes(taken, 4, bearings="fixed").periods
    # fixed base are springs of their axial stiffness, 2e5 times that of the slab
    assert_allclose(found, theirs, rtol=2e-5)
    assert theirs[0] / theirs[1] > 1.05
    state = gravity(taken)
    ours = state.axial_forces
    reactions = reactions_under_weight(ops, places, corners)
    assert np.ptp(reactions) > 0.1 * reactions.mean()
    # four supports of a stiff slab: those of OpenSees do not give, bearings settle by 0.03 mm
    assert_allclose(ours.sum(), reactions.sum(), rtol=1e-6)
    assert_allclose(ours, reactions, rtol=2e-2)
